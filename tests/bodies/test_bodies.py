import math
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from sphframe.bodies import DisplacementSeries, Free, SpringMass
from sphframe.errors import InputError
from sphframe.interfaces import RigidBody
from sphframe.registry import create
from sphframe.testing import checks_of

Array = NDArray[np.float64]
NOTHING = np.zeros(3)


def at(body: RigidBody, time: float) -> tuple[float, float, float]:
    motion = body.motion(time, NOTHING, NOTHING, NOTHING)
    return float(motion.position[0]), float(motion.velocity[0]), float(motion.acceleration[0])


def series_file(folder: Path, text: str | None = None) -> Path:
    path = folder / "series.csv"
    if text is None:
        lines = [f"{t:.4f},{0.3 + 0.1 * (10 * s**3 - 15 * s**4 + 6 * s**5):.9f}" for t, s in rising()]
        text = "\n".join(["# time (s), x (m)", *lines])
    path.write_text(text)
    return path


def rising() -> list[tuple[float, float]]:
    return [(2.0 * s, s) for s in np.linspace(0.0, 1.0, 41)]


def bodies(folder: Path) -> list[RigidBody]:
    return [
        DisplacementSeries(series_file(folder)),
        SpringMass(mass=250.0, stiffness=10.0, threshold=215.8),
        Free(mass=40.0, inertia=1.2),
    ]


def test_every_body_keeps_the_promises_of_its_interface(tmp_path: Path) -> None:
    for body in bodies(tmp_path):
        for check in checks_of(body):
            check(body)


def test_series_goes_through_its_points_and_rests_outside(tmp_path: Path) -> None:
    body = DisplacementSeries(series_file(tmp_path))
    for time, s in rising():
        x, u, _ = at(body, time)
        assert x == pytest.approx(0.1 * (10 * s**3 - 15 * s**4 + 6 * s**5), abs=1e-8)
        assert u == pytest.approx(0.05 * (30 * s**2 - 60 * s**3 + 30 * s**4), abs=1e-5)
    assert at(body, 5.0) == pytest.approx((0.1, 0.0, 0.0))
    assert at(body, 0.0) == (0.0, 0.0, 0.0)


def test_series_may_turn_and_rise(tmp_path: Path) -> None:
    lines = "\n".join(f"{t} {0.1 * t} {0.2 * t**2} {0.3 * t**3}" for t in range(8))
    body = DisplacementSeries(series_file(tmp_path, lines), centre=(1.0, 2.0))
    motion = body.motion(3.0, NOTHING, NOTHING, NOTHING)
    assert motion.position == pytest.approx([0.3, 1.8, 8.1])
    assert body.centre == (1.0, 2.0)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0,0\n1,1", "2 lines; a smooth motion needs 6 or more"),
        ("time,x\n" + "1,2\n" * 9, "could not convert.*put '#' before"),
        ("1\n" * 9, r"columns; expected time and 1 to 3"),
        ("0,0\n0,1\n1,2\n2,2\n3,2\n4,2", "must increase"),
        ("0,0\n1,nan\n2,2\n3,2\n4,2\n5,2", "not finite"),
        ("0,0\n1,1,1\n", r"columns \[2, 3\]|lines of"),
    ],
)
def test_bad_series_are_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        DisplacementSeries(series_file(tmp_path, text))


def test_missing_series_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot read the displacement series"):
        DisplacementSeries(tmp_path / "absent.csv")


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        ("spring-mass", {"mass": 0.0, "stiffness": 1.0}, "mass = 0.0 must be positive"),
        ("spring-mass", {"mass": 1.0, "stiffness": -1.0}, "stiffness = -1.0 must not be negative"),
        ("free", {"mass": 1.0, "inertia": 0.0}, "inertia = 0.0 must be positive"),
        ("free", {"mass": 1.0, "inertia": 1.0, "centre": [0, 0, 0]}, "point of the plane"),
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
