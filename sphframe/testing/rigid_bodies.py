"""Testing: rigid bodies, one check function per property."""

import math
from collections.abc import Callable

import numpy as np

from sphframe.interfaces import Motion, RigidBody
from sphframe.testing.evaluation import title
from sphframe.testing.proof import require


def check_motion(body: RigidBody) -> None:
    """The motion has three finite generalised coordinates, the same ones for the same arguments, which it leaves alone.

    At first a body is where it was drawn.
    """
    for time in (0.0, 0.3, 2.7):
        given = [np.full(3, 1e-3), np.full(3, 2e-3), np.full(3, 3.0)]
        body.motion(time, *given)
        for name, array, number in zip(("position", "velocity", "load"), given, (1e-3, 2e-3, 3.0), strict=True):
            require(
                bool(np.all(array == number)),
                f"{title(body)}: motion writes to the {name} that it receives: return new arrays",
            )
        first, second = (body.motion(time, np.zeros(3), np.zeros(3), np.zeros(3)) for _ in range(2))
        require(isinstance(first, Motion), f"{title(body)}: motion returned {first!r:.80}; expected a sphframe.Motion")
        for name, a, b in zip(first._fields, first, second, strict=True):
            require(
                np.shape(a) == (3,) and bool(np.all(np.isfinite(a))),
                f"{title(body)}: the {name} at {time} s is {a!r}; it must be three finite numbers",
            )
            require(
                np.array_equal(a, b),
                f"{title(body)}: the {name} at {time} s differs between two calls with the same arguments; keep no"
                f" state",
            )


def check_start(body: RigidBody) -> None:
    """A prescribed body is not displaced at time 0."""
    at_start = body.motion(0.0, np.zeros(3), np.zeros(3), np.zeros(3)).position
    require(
        bool(np.all(np.abs(at_start) < 1e-9)),
        f"{title(body)}: at 0 s it is displaced by {np.asarray(at_start).tolist()}; walls are drawn where"
        " they are at 0 s, so that the displacement must begin with zero",
    )


def check_damping(body: RigidBody) -> None:
    """What the acceleration owes to the velocity takes energy from a dynamic body: a damper does not push."""
    if not body.needs_load:
        return
    here, load = np.full(3, 1e-3), np.array([1e6, 0.0, 0.0])
    rest = body.motion(0.0, here, np.zeros(3), load).acceleration
    for velocity in np.concatenate([np.eye(3), -np.eye(3)]) * 0.1:
        added = body.motion(0.0, here, velocity, load).acceleration - rest
        require(
            float(added @ velocity) <= 1e-12 * (1.0 + float(np.max(np.abs(rest)))),
            f"{title(body)}: the velocity {velocity.tolist()} adds the acceleration {added.tolist()}, along with it",
        )


def check_derivatives(body: RigidBody) -> None:
    """The velocity and the acceleration of a prescribed motion are the derivatives of position and velocity."""
    given, moving = np.array([0.01, -0.02, 0.03]), np.array([0.1, 0.2, -0.1])
    kept = body.motion(0.5, given, moving, np.zeros(3))
    if np.array_equal(kept.position, given) or not _is_prescribed(body):
        return
    step = 1e-5
    for time in (0.11, 0.37, 1.3, 2.9, *np.random.default_rng(4).uniform(3.0, 60.0, 20).tolist()):
        before, now, after = (body.motion(t, given, moving, np.zeros(3)) for t in (time - step, time, time + step))
        for name, low, high, rate in (
            ("velocity", before.position, after.position, now.velocity),
            ("acceleration", before.velocity, after.velocity, now.acceleration),
        ):
            slope = (high - low) / (2.0 * step)
            require(
                bool(np.allclose(slope, rate, rtol=1e-4, atol=1e-4 * (1.0 + float(np.max(np.abs(rate)))))),
                f"{title(body)}: at {time} s the {name} is {rate.tolist()}, but differences give {slope.tolist()}",
            )


def check_momentum(body: RigidBody) -> None:
    """The acceleration of a dynamic body away from its stops is affine in the load: force = mass times acceleration."""
    if not body.needs_load:
        return
    position, velocity = np.full(3, 1e-3), np.zeros(3)
    loads = [np.array([1e6 + 1e3 * k, 1e3 * k, 10.0 * k]) for k in range(3)]
    a0, a1, a2 = (body.motion(0.0, position, velocity, load).acceleration for load in loads)
    require(
        bool(np.allclose(a2 - a1, a1 - a0, rtol=1e-6, atol=1e-12 * float(np.max(np.abs(a0)) + 1.0))),
        f"{title(body)}: equal load increments change the acceleration by {(a1 - a0).tolist()} and then by"
        f" {(a2 - a1).tolist()}: force = mass times acceleration",
    )


def check_spring_period(body: RigidBody) -> None:
    """A body with ``mass`` and ``stiffness`` along x oscillates with period 2 pi sqrt(m/k) under a constant load."""
    mass, stiffness = getattr(body, "mass", None), getattr(body, "stiffness", None)
    if not (body.needs_load and mass and stiffness):
        return
    period = 2.0 * math.pi * math.sqrt(mass / stiffness)
    load = np.array([1e3 * stiffness + 1e6, 0.0, 0.0])
    near, far = (body.motion(0.0, np.array([x, 0.0, 0.0]), np.zeros(3), load).acceleration[0] for x in (1.0, 2.0))
    measured = 2.0 * math.pi / math.sqrt(max(near - far, 1e-300))
    require(
        math.isclose(measured, period, rel_tol=1e-6),
        f"{title(body)}: the acceleration decreases by {near - far:.6g} m/s^2 per metre, a period of {measured:.6g} s"
        f" instead of 2 pi sqrt(m/k) = {period:.6g} s",
    )


def check_stop(body: RigidBody) -> None:
    """A body whose position a stop has limited does not move further into the stop."""
    if not body.needs_load:
        return
    for direction in (-1.0, 1.0):
        position, velocity = np.array([10.0 * direction, 0.0, 0.0]), np.array([direction, 0.0, 0.0])
        motion = body.motion(0.0, position, velocity, np.zeros(3))
        if motion.position[0] != position[0]:
            require(
                motion.velocity[0] * direction <= 0.0,
                f"{title(body)}: at its stop x = {motion.position[0]:g} the velocity is {motion.velocity[0]:g}, further"
                f" into the stop",
            )


def _is_prescribed(body: RigidBody) -> bool:
    """Whether the motion is independent of the position and velocity that are passed to it."""
    one, other = (body.motion(0.5, np.full(3, x), np.full(3, x), np.zeros(3)) for x in (0.0, 0.01))
    return bool(np.array_equal(one.position, other.position))


CHECKS: dict[str, Callable[[RigidBody], None]] = {
    "motion": check_motion,
    "start": check_start,
    "derivatives": check_derivatives,
    "momentum": check_momentum,
    "damping": check_damping,
    "spring_period": check_spring_period,
    "stop": check_stop,
}
"""the checks of a rigid body, by the name of the property"""
