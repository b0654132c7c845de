from sphframe_adami import Adami

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([Adami()])
def test_keeps_its_promises(method, check):
    check(method)
