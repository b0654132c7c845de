from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sphframe_adami import Adami, AdamiWalls

from sphframe import OK, Interpolated, WallPoint
from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([Adami()])
def test_has_its_traits(method, check):
    check(method)


@pytest.mark.long
@parametrize_with_checks([AdamiWalls()])
def test_walls_have_their_traits(treatment, check):
    check(treatment)


def assigned(weights, offsets, pressures, velocities, wall_velocity, force):
    """What a wall particle at the origin is assigned: pressure, velocity, and velocity for the viscosity."""
    count, dim = offsets.shape
    velocity, viscous = np.full((2, dim), np.nan)
    fluid = Interpolated(OK, count, weights.sum(), weights @ pressures, False, weights @ offsets, weights @ velocities)
    wall = WallPoint(np.eye(dim)[0], 0.1, 0.0, np.zeros(dim), np.eye(dim), wall_velocity, force, 0.0, np.zeros(dim), 0)
    pressure, share = (
        AdamiWalls().parts(SimpleNamespace(dim=dim, no_slip=True)).assign(fluid, wall, None, velocity, viscous)
    )
    assert share == 1.0
    return pressure, velocity, viscous


@given(seed=st.integers(0, 2**32 - 1), dim=st.sampled_from([2, 3]))
def test_pressure_and_velocities_at_a_wall_particle(seed, dim):
    """Exact for water at rest in a cloud of any shape, and for water that moves with the wall."""
    random = np.random.default_rng(seed)
    offsets, force = random.normal(size=(7, dim)), 1e4 * random.normal(size=dim)
    velocities, wall_velocity = random.normal(size=(7, dim)), random.normal(size=dim)
    distances, volumes = np.linalg.norm(offsets, axis=1), random.uniform(0.5, 2.0, 7)
    kernel_values, weights = np.exp(-(distances**2)), np.empty(7)
    method = Adami().point_weights(None, dim)
    assert method(offsets, distances, kernel_values, volumes, 9.0, np.zeros(dim), weights) == OK
    assert weights == pytest.approx(kernel_values * volumes / (kernel_values @ volumes), rel=1e-13)
    pressure, velocity, viscous = assigned(weights, offsets, 700.0 + offsets @ force, velocities, wall_velocity, force)
    assert pressure == pytest.approx(700.0, abs=1e-9)
    assert velocity.tolist() == wall_velocity.tolist()
    assert viscous == pytest.approx(2.0 * wall_velocity - weights @ velocities, abs=1e-13)
    moving = np.tile(wall_velocity, (7, 1))
    assert assigned(weights, offsets, 0.0 * distances, moving, wall_velocity, force)[2] == pytest.approx(
        wall_velocity, abs=1e-13
    )
