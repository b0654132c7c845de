from sphframe_sfdi import SFDI

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([SFDI(), SFDI(form="printed")])
def test_keeps_its_promises(method, check):
    check(method)
