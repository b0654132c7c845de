from types import SimpleNamespace

import numpy as np
import pytest
from sphframe_dynamic import Dynamic

from sphframe import Neighbours, WallContext, WallPoint, create
from sphframe.kernels import compiled_kernel
from sphframe.testing import parametrize_with_checks

RHO0, C0, H, DX = 1000.0, 20.0, 1.3, 1.0
CONSTANTS = SimpleNamespace(reference_density=RHO0, sound_speed=C0, smoothing_length=H)


@parametrize_with_checks([Dynamic(diffusion=0.1)])
def test_has_its_traits(treatment, check):
    check(treatment)


def parts(diffusion=0.0):
    kernel = compiled_kernel(create("kernels", "gaussian"), 2)
    pressure = create("equations_of_state", "linear").pressure_function()
    return Dynamic(diffusion=diffusion).parts(WallContext(kernel, 2, None, pressure=pressure))


def around(velocity, density):
    """The fluid above a wall particle half a spacing below the wall, with W'(r)/r of a plain Gaussian."""
    x, y = np.meshgrid(np.arange(-3.0, 4.0), np.arange(1.0, 4.0))
    offsets = np.stack([x.ravel(), y.ravel()], axis=1)
    r = np.hypot(*offsets.T)
    slopes = -2.0 / (np.pi * H**4) * np.exp(-((r / H) ** 2))
    n = len(r)
    return Neighbours(offsets, r, slopes, np.full(n, DX**2), np.zeros(n), density(offsets), velocity(offsets))


def wall(state, velocity=(0.0, 0.0), force=(0.0, 0.0)):
    zero = np.zeros(2)
    return WallPoint(
        np.array([0.0, -1.0]), 0.5, 0.5, zero, np.eye(2), np.array(velocity), np.array(force), state, zero, 0
    )


def at_rest(x):
    return np.zeros_like(x)


def uniform(x):
    return np.full(len(x), 1003.0)


def test_nothing_changes_while_fluid_and_wall_move_together():
    near = around(lambda x: np.tile([0.3, -0.2], (len(x), 1)), uniform)
    assert parts().rate(near, wall(1002.0, velocity=(0.3, -0.2)), CONSTANTS) == 0.0
    assert parts().rate(around(at_rest, uniform), wall(1002.0), CONSTANTS) == 0.0


def test_fluid_that_approaches_raises_the_density_by_the_sum_over_its_particles():
    near = around(lambda x: np.tile([0.0, -0.5], (len(x), 1)), uniform)
    # -rho sum (u_j - u_w).grad_G W V_j with grad_G W = 2/h^2 W (x_j - x_G)
    w = np.exp(-((near.distances / H) ** 2)) / (np.pi * H**2)
    expected = 1002.0 * np.sum(0.5 * 2.0 / H**2 * w * near.offsets[:, 1])
    assert expected > 0.0
    assert parts().rate(near, wall(1002.0), CONSTANTS) == pytest.approx(expected, rel=1e-13)
    leaving = around(lambda x: np.tile([0.0, 0.5], (len(x), 1)), uniform)
    assert parts().rate(leaving, wall(1002.0), CONSTANTS) == pytest.approx(-expected, rel=1e-13)


def test_the_density_does_not_fall_below_that_at_rest():
    leaving = around(lambda x: np.tile([0.0, 0.5], (len(x), 1)), uniform)
    assert parts().rate(leaving, wall(RHO0), CONSTANTS) == 0.0
    velocity = np.empty(2)
    assert parts().assign(None, wall(990.0), CONSTANTS, velocity, velocity) == (0.0, 1.0)


def test_pressure_and_volume_follow_from_the_density():
    velocity = np.empty(2)
    found = parts().assign(None, wall(1010.0, velocity=(1.0, 2.0)), CONSTANTS, velocity, velocity)
    assert found == pytest.approx((C0**2 * 10.0, 1000.0 / 1010.0), rel=1e-14)
    assert velocity.tolist() == [1.0, 2.0]


def test_diffusion_relaxes_the_density_to_that_of_still_water():
    # rho = rho0 + b.x/c0^2 + 3 around the wall particle: no rate for its own value, and towards it for any other
    force = np.array([100.0, -9810.0])
    near = around(at_rest, lambda x: RHO0 + 3.0 + x @ force / C0**2)
    rates = [parts(0.1).rate(near, wall(RHO0 + 3.0 + excess, force=force), CONSTANTS) for excess in (0.0, 1.0, -1.0)]
    assert rates[0] == pytest.approx(0.0, abs=1e-9)
    # -delta h c0 2 (rho_G - rho) sum (-W'/r) V
    expected = 0.1 * H * C0 * 2.0 * np.sum(near.slopes * near.volumes)
    assert rates[1:] == pytest.approx([expected, -expected], rel=1e-9)


def test_options_are_checked():
    with pytest.raises(ValueError, match="diffusion must be 0 or a positive number"):
        Dynamic(diffusion=-1.0)
