from sphframe_mls import LinearMLS, QuadraticMLS

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([LinearMLS(), QuadraticMLS()])
def test_has_its_traits(method, check):
    check(method)
