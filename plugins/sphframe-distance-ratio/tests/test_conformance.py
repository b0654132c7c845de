import pytest
from sphframe_distance_ratio import DistanceRatio

from sphframe import FixedGhosts, WallContext, create
from sphframe.kernels import compiled_kernel
from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([DistanceRatio()])
def test_has_its_traits(treatment, check):
    check(treatment)


@pytest.mark.parametrize("balanced", [True, False])
def test_ghosts_have_the_velocities_of_fixed_ghosts_in_the_continuity(balanced):
    """Those that belong to the mirror lift are corrected for all ghosts together."""
    kernel = compiled_kernel(create("kernels", "gaussian"), 2)
    context = WallContext(kernel, 2, create("interpolators", "improved-shepard"), balanced_lift=balanced)
    assert DistanceRatio().parts(context).conjugate == FixedGhosts().parts(context).conjugate == (not balanced)
