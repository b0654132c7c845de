"""What is assigned to a ghost is what the formulas say, for each lift, velocity, dimension and evaluation point."""

from itertools import product
from typing import Any

import numpy as np
import pytest

from sphframe import create
from sphframe.boundary.fixed_ghosts import FixedGhosts
from sphframe.interfaces import Interpolated, WallContext, WallPoint
from sphframe.interfaces.traits import OK
from sphframe.kernels import compiled_kernel
from sphframe.kernels.gaussian import RenormalisedGaussian


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("method", ["improved-shepard", "adami"])
def test_pressure_and_velocity_of_a_ghost(dim: int, method: str) -> None:
    random = np.random.default_rng(dim)
    kernel, interpolator = compiled_kernel(RenormalisedGaussian(), dim), create("interpolators", method)
    at_ghost = interpolator.traits.evaluation_point.at_ghost
    for balanced, corrected, extrapolated, neighbours in product([True, False], [True, False], [True, False], [0, 7]):
        context: dict[str, Any] = {
            "kernel": kernel, "dim": dim, "interpolator": interpolator, "no_slip": False, "balanced_lift": balanced,
            "corrected_velocity": corrected, "velocity_interpolator": None, "pressure": None,
        }  # fmt: skip
        assign = FixedGhosts().parts(WallContext(**context)).assign
        assert assign is not None
        total = 1.0 if neighbours else 0.0
        offset, velocity, lift, wall_u, force = random.normal(size=(5, dim)) * [[total], [total], [1], [1], [1]]
        normal = random.normal(size=dim)
        normal /= np.linalg.norm(normal)
        offset -= (offset @ normal + total * 0.2) * normal  # the fluid's mean is 0.2 m further from the wall
        reflection = random.normal(size=(dim, dim))
        fluid = Interpolated(OK, neighbours, total, 3.0 * total, extrapolated, offset, velocity)
        wall = WallPoint(normal, 0.4, 0.3, lift, reflection, wall_u, force, 0.0, np.zeros(2), 0)
        found = np.empty(dim)
        pressure, share = assign(fluid, wall, None, found, np.empty(dim))
        lifted = 3.0 * total
        if neighbours and not extrapolated:
            lifted += force @ (lift - offset) if balanced or at_ghost else force @ lift
        s = 0.4 / (0.3 + 0.2) if balanced and corrected and neighbours and not at_ghost else 1.0
        mixed = 0.5 * (1.0 - s) * np.eye(dim) + 0.5 * (1.0 + s) * reflection
        expected = wall_u + (mixed @ (velocity - wall_u) if neighbours else 0.0)
        assert (pressure, share) == (pytest.approx(lifted, rel=1e-13), 1.0), (balanced, corrected, neighbours)
        assert found == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("no_slip", [True, False])
def test_ghosts_may_slip_in_the_continuity_alone(no_slip: bool) -> None:
    """Normal velocity reversed for the continuity, all for the viscosity, as far as the ghost is behind the wall."""
    kernel, interpolator = compiled_kernel(RenormalisedGaussian(), 2), create("interpolators", "improved-shepard")
    parts = FixedGhosts(continuity="free-slip").parts(WallContext(kernel, 2, interpolator, no_slip=no_slip))
    assert parts.assign is not None
    assert parts.own_viscous_velocity == no_slip
    normal, wall_u, relative = np.array([0.0, -1.0]), np.array([0.3, -0.2]), np.array([1.5, 0.4])
    offset = np.array([0.1, 0.2])  # the fluid's mean is 0.2 m further from the wall than the evaluation point
    for neighbours in (0, 7):
        fluid = Interpolated(OK, neighbours, 1.0, 3.0, False, offset, wall_u + relative)
        wall = WallPoint(
            normal, 0.4, 0.3, np.array([0.0, -0.7]), np.diag([1.0, -1.0]), wall_u, np.zeros(2), 0.0, np.zeros(2), 0
        )
        found, viscous = np.full((2, 2), np.nan)
        parts.assign(fluid, wall, None, found, viscous)
        s = 0.4 / (0.3 + 0.2) if neighbours else 0.0
        slips = 1.5 if neighbours else 0.0
        assert found - wall_u == pytest.approx([slips, -s * 0.4])
        if no_slip:
            assert viscous - wall_u == pytest.approx(-s * relative)
