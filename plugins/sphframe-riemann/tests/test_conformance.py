from types import SimpleNamespace

import numpy as np
import pytest
from sphframe_riemann import Riemann

from sphframe import FluidSide, Separation, WallSide
from sphframe.testing import parametrize_with_checks, wall_residuals

CONSTANTS = SimpleNamespace(reference_density=1000.0, sound_speed=20.0)


@parametrize_with_checks([Riemann()])
def test_has_its_traits(treatment, check):
    check(treatment)


def pair(velocity=(0.0, 0.0), wall_velocity=(0.0, 0.0), force=(0.0, 0.0), normal=(0.0, -1.0), limiter=3.0):
    """What a particle of 500 Pa sees of a wall particle at (0.3, -0.4) from it."""
    nothing = dict.fromkeys(WallSide._fields, 0.0)
    wall = WallSide(
        **{**nothing, "nx": normal[0], "ny": normal[1], "wall_u": wall_velocity[0], "wall_v": wall_velocity[1],
           "bx": force[0], "by": force[1]}
    )  # fmt: skip
    seen = Riemann(limiter=limiter).parts(SimpleNamespace(no_slip=True)).seen
    return seen(FluidSide(500.0, 1000.0, *velocity, 0.0), wall, Separation(0.3, -0.4, 0.0, 0.25), CONSTANTS)


def test_the_pressure_of_a_pair_is_hydrostatic_in_any_direction():
    rho0, f = 1000.0, np.array([2.0, -9.81])
    expected = 500.0 + (500.0 + rho0 * f @ [0.3, -0.4])
    assert pair(force=rho0 * f).pressure_sum == pytest.approx(expected, rel=1e-14)


def test_only_particles_that_approach_the_wall_lose_energy():
    assert pair(velocity=(5.0, 0.2)).pressure_sum == 1000.0
    assert pair(velocity=(5.0, 0.0)).pressure_sum == 1000.0
    jump = 2.0 * 0.1
    expected = 1000.0 + 1000.0 * 20.0 * jump * (3.0 * jump / 20.0)
    assert pair(velocity=(5.0, -0.1)).pressure_sum == pytest.approx(expected, rel=1e-14)
    assert pair(wall_velocity=(0.0, 0.1)).pressure_sum == pytest.approx(expected, rel=1e-14)
    assert pair(velocity=(0.0, -10.0)).pressure_sum == pytest.approx(1000.0 + 1000.0 * 20.0 * 20.0, rel=1e-14)
    assert pair(velocity=(0.0, -10.0), limiter=0.0).pressure_sum == 1000.0


def test_the_velocity_is_reflected_about_that_of_the_wall():
    seen = pair(velocity=(0.7, -0.2), wall_velocity=(0.1, 0.3))
    assert seen[1:] == pytest.approx((-0.5, 0.8, 0.0, -0.5, 0.8, 0.0), abs=1e-15)


def test_errors_at_a_straight_wall():
    found = wall_residuals(Riemann())
    assert found.normal == pytest.approx((0.89, 1.10), abs=5e-3)
    wendland = wall_residuals(Riemann(), "wendland-c2", 2.0)
    assert wendland.normal == pytest.approx((0.84, 1.12), abs=5e-3)


def test_options_are_checked():
    with pytest.raises(ValueError, match="limiter must be 0 or a positive number"):
        Riemann(limiter=-1.0)
