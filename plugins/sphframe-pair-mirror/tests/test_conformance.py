from sphframe_pair_mirror import PairMirror

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([PairMirror()])
def test_has_its_traits(treatment, check):
    check(treatment)
