from sphframe_hashemi import Hashemi

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([Hashemi()])
def test_has_its_traits(treatment, check):
    check(treatment)
