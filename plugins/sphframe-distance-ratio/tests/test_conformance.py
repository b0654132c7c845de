from sphframe_distance_ratio import DistanceRatio

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([DistanceRatio()])
def test_has_its_traits(treatment, check):
    check(treatment)
