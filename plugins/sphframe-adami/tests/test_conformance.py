from sphframe_adami import Adami

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([Adami()])
def test_has_its_traits(method, check):
    check(method)
