from sphframe_shepard import ImprovedShepard, Shepard

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([ImprovedShepard(), Shepard()])
def test_has_its_traits(method, check):
    check(method)
