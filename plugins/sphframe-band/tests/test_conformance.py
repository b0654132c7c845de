from sphframe_band import Band

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([Band()])
def test_has_its_traits(treatment, check):
    check(treatment)
