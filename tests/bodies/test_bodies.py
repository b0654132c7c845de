import math

import numpy as np
import pytest
from numpy.typing import NDArray

from sphframe.bodies import Free, Prescribed, SpringMass
from sphframe.bodies.body_forces import ForceSeries
from sphframe.errors import InputError
from sphframe.interfaces import RigidBody
from sphframe.registry import create
from sphframe.testing import checks_of

Array = NDArray[np.float64]
NOTHING = np.zeros(3)


def at(body: RigidBody, time: float) -> tuple[float, float, float]:
    motion = body.motion(time, NOTHING, NOTHING, NOTHING)
    return float(motion.position[0]), float(motion.velocity[0]), float(motion.acceleration[0])


def bodies() -> list[RigidBody]:
    return [SpringMass(mass=250.0, stiffness=10.0, threshold=215.8), Free(mass=40.0, inertia=1.2)]


def test_every_body_keeps_the_promises_of_its_interface() -> None:
    for body in bodies():
        for check in checks_of(body):
            check(body)


def test_a_body_that_the_water_moves_says_so() -> None:
    for body in bodies():
        pushed = body.motion(0.0, NOTHING, NOTHING, np.full(3, 1e4)).acceleration
        assert body.needs_load, body
        assert np.any(pushed != body.motion(0.0, NOTHING, NOTHING, NOTHING).acceleration)


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        ("spring-mass", {"mass": 0.0, "stiffness": 1.0}, "mass = 0.0 must be positive"),
        ("spring-mass", {"mass": 1.0, "stiffness": -1.0}, "stiffness = -1.0 must not be negative"),
        ("free", {"mass": 1.0, "inertia": 0.0}, "inertia = 0.0 must be positive"),
        ("free", {"mass": 1.0, "density": 500.0}, "mass = 1.0 and density = 500.0 are both given"),
    ],
)
def test_bad_options_are_refused(name: str, options: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        create("rigid_bodies", name, **options)


def swing(body: RigidBody, load: float, until: float, step: float) -> tuple[Array, Array]:
    """Kick-drift-kick, as the integrator does it."""
    x, u = np.zeros(3), np.zeros(3)
    given = np.array([load, 0.0, 0.0])
    times = np.arange(0.0, until, step)
    positions = []
    for time in times:
        motion = body.motion(time, x, u, given)
        half = motion.velocity + 0.5 * step * motion.acceleration
        motion = body.motion(time + step, motion.position + step * half, half, given)
        x, u = motion.position, motion.velocity + 0.5 * step * motion.acceleration
        positions.append(x[0])
    return times + step, np.array(positions)


def test_spring_wall_swings_with_its_period_about_its_load() -> None:
    wall = SpringMass(mass=2.0, stiffness=50.0, threshold=3.0)
    t, x = swing(wall, 8.0, 0.95 * 2.0 * math.pi * math.sqrt(2.0 / 50.0), 1e-4)
    omega = math.sqrt(50.0 / 2.0)
    assert x == pytest.approx(0.1 * (1.0 - np.cos(omega * t)), abs=1e-6)


def test_a_wall_without_a_spring_is_accelerated_evenly() -> None:
    t, x = swing(SpringMass(mass=2.0, stiffness=0.0), 3.0, 0.5, 0.01)
    assert x == pytest.approx(0.5 * 1.5 * t**2)


def test_a_series_of_accelerations_is_linear_within_its_table_and_nothing_outside() -> None:
    force = ForceSeries(table=((1.0, 2.0, -4.0), (3.0, 6.0, 4.0)))
    times = np.array([0.0, 0.99, 1.0, 1.5, 2.0, 3.0, 3.01, 9.0])
    expected = [[2.0 + 2.0 * (t - 1.0), -4.0 + 4.0 * (t - 1.0)] if 1.0 <= t <= 3.0 else [0.0, 0.0] for t in times]
    assert [force.acceleration(t).tolist() for t in times] == expected


def test_a_prescribed_body_turns_about_the_origin_by_default() -> None:
    assert not np.any(Prescribed(lambda time: (NOTHING, NOTHING, NOTHING)).centre)


def test_spring_wall_stands_still_below_its_threshold_and_stops_dead_at_its_stop() -> None:
    wall = SpringMass(mass=2.0, stiffness=50.0, threshold=3.0)
    still = wall.motion(0.0, NOTHING, NOTHING, np.array([2.999, 0.0, 0.0]))
    assert not np.any(still.acceleration)
    stopped = wall.motion(0.0, np.array([-1e-3, 0, 0]), np.array([-0.4, 0, 0]), NOTHING)
    assert not np.any([stopped.position, stopped.velocity, stopped.acceleration])
    released = wall.motion(0.0, NOTHING, np.array([0.4, 0, 0]), np.array([5.0, 0, 0]))
    assert released.velocity[0] == 0.4
    assert released.acceleration[0] == pytest.approx(1.0)


def test_free_body_follows_newton_and_falls() -> None:
    body = Free(mass=4.0, inertia=0.5, centre=(1.0, 2.0))
    motion = body.motion(0.0, np.array([1.0, 2, 3]), np.array([4.0, 5, 6]), np.array([8.0, 4 * 9.81, 2.0]))
    assert motion.acceleration == pytest.approx([2.0, 0.0, 4.0])
    assert np.array_equal(motion.position, [1, 2, 3])
