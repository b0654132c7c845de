from types import SimpleNamespace

import numpy as np
import pytest
from sphframe_semi_analytical import SemiAnalytical

from sphframe import Edge, FluidSide, Interpolated, WallContext, WallPoint, WallSide, create
from sphframe.kernels import compiled_kernel
from sphframe.testing import parametrize_with_checks, wall_residuals

CONSTANTS = SimpleNamespace(spacing=0.1, viscosity=4.0, friction=1.0)
NOTHING = dict.fromkeys(WallSide._fields, 0.0)


@parametrize_with_checks([SemiAnalytical()])
def test_has_its_traits(treatment, check):
    check(treatment)


def parts(*, no_slip=False):
    return SemiAnalytical().parts(
        WallContext(compiled_kernel(create("kernels", "gaussian"), 2), 2, None, no_slip=no_slip)
    )


def test_the_pressure_of_a_segment_is_hydrostatic():
    b, zero, velocity = np.array([200.0, -9810.0]), np.zeros(2), np.empty(2)
    offset = np.array([0.02, 0.13])  # of the mean position of the fluid from the segment
    fluid = Interpolated(0, 5, 1.0, 500.0 + b @ offset, False, offset, zero)
    wall = WallPoint(np.array([0.0, -1.0]), 0.0, 0.0, zero, np.eye(2), np.array([0.1, 0.2]), b, 0.0, zero, 0)
    assert parts().assign(fluid, wall, None, velocity, velocity.copy()) == (pytest.approx(500.0, rel=1e-14), 1.0)
    assert velocity.tolist() == [0.1, 0.2]


def test_pressure_and_velocity_on_the_wall_enter_with_the_gradient_of_gamma():
    wall = WallSide(**{**NOTHING, "pressure": 300.0, "nx": 0.6, "ny": -0.8, "wall_u": 0.1, "wall_v": 0.2})
    edge, u = Edge(0.05, -0.03, 0.06, 0.01, 2.5, 0.2), np.array([0.4, -0.3])
    gradient = -np.array([0.6, -0.8]) * 2.5
    found = parts().surface(FluidSide(200.0, 1000.0, *u, 0.0), wall, edge, CONSTANTS)
    assert found[:2] == pytest.approx((500.0 * gradient).tolist(), rel=1e-14)
    assert found[2] == pytest.approx(-(np.array([0.1, 0.2]) - u) @ gradient, rel=1e-14)
    rubbed = parts(no_slip=True).surface(FluidSide(200.0, 1000.0, *u, 0.0), wall, edge, CONSTANTS)
    along = np.array([0.8, 0.6])
    expected = -2.0 * 1.0 * 2.5 * ((u - [0.1, 0.2]) @ along) / 0.05 * along
    assert np.subtract(rubbed[:2], found[:2]) == pytest.approx(expected, rel=1e-12)


def test_errors_at_a_straight_wall():
    found = wall_residuals(SemiAnalytical())
    assert found.uniform == pytest.approx((-0.0196, 0.0113), abs=2e-4)
    assert found.normal == pytest.approx((0.97, 1.01), abs=5e-3)
    wendland = wall_residuals(SemiAnalytical(), "wendland-c2", 2.0)
    assert wendland.uniform == pytest.approx((-0.0128, 0.0045), abs=2e-4)
    assert wendland.normal == pytest.approx((0.98, 1.00), abs=5e-3)
