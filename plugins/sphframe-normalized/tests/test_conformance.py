from sphframe_normalized import Normalized

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([Normalized()])
def test_has_its_traits(method, check):
    check(method)
