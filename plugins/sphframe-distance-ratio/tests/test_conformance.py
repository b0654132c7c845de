from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sphframe_distance_ratio import DistanceRatio

from sphframe import FixedGhosts, FluidSide, Separation, WallContext, WallSide, create
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


def seen(distance, behind, slope, along, angle, **options):
    """Velocity for the viscosity, less that of the wall, of a pair at the two distances in a shear flow, (2,).

    The tangent and the slope give the flow; the wall moves at (0.3, -0.2) m/s, and its normal points to ``angle``."""
    n = np.array([np.cos(angle), np.sin(angle)])
    t, wall_velocity = np.array([-n[1], n[0]]), np.array([0.3, -0.2])
    x = (distance + behind) * n + along * t
    wall = WallSide(40.0, 7.0, 8.0, 0.0, 0.0, 0.0, 0.0, n[0], n[1], 0.0, behind, 0.3, -0.2, 0.0, 0.0, 0.0, 0.0)
    method = create("interpolators", "improved-shepard")
    parts = DistanceRatio(**options).parts(WallContext(None, 2, method, no_slip=True))
    velocity = wall_velocity + slope * distance * t
    found = parts.seen(
        FluidSide(60.0, 1000.0, *velocity, 0.0), wall, Separation(*x, 0.0, x @ x), SimpleNamespace(spacing=0.1)
    )
    assert (found.pressure_sum, found.u, found.v) == (100.0, 7.0, 8.0) or "continuity" in options
    return np.array([found.viscous_u, found.viscous_v]) - wall_velocity, t, np.array([found.u, found.v]) - wall_velocity


@given(
    distance=st.floats(0.025, 0.4), behind=st.floats(0.01, 0.4), slope=st.floats(-9.0, 9.0),
    along=st.floats(-0.4, 0.4), angle=st.floats(0.0, 6.3),
)  # fmt: skip
def test_a_shear_flow_is_continued_through_the_wall(distance, behind, slope, along, angle):
    """u_w + slope d t before the wall is u_w - slope d_G t behind it, wherever along the wall."""
    found, t, _ = seen(distance, behind, slope, along, angle)
    assert found == pytest.approx(-slope * behind * t, abs=1e-11)
    found, t, continuity = seen(distance, behind, slope, along, angle, cap=1.5, continuity="ratio")
    assert found == pytest.approx(-slope * min(behind, 1.5 * distance) * t, abs=1e-11)
    assert continuity.tolist() == found.tolist()


def test_a_particle_on_the_wall_counts_as_a_quarter_of_a_spacing_before_it():
    found, t, _ = seen(0.01, 0.05, 2.0, 0.0, 0.4)
    assert found == pytest.approx(-2.0 * 0.01 * 0.05 / 0.025 * t, abs=1e-12)
