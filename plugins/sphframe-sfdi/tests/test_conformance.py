from sphframe_sfdi import SFDI

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([SFDI(), SFDI(form="printed")])
def test_has_its_traits(method, check):
    check(method)
