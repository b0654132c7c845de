from sphframe_mdbc import MDBC

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([MDBC()])
def test_has_its_traits(method, check):
    check(method)
