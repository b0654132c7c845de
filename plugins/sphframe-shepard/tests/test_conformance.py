from sphframe_shepard import ImprovedShepard, Shepard

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([ImprovedShepard(), Shepard()])
def test_keeps_its_promises(method, check):
    check(method)
