"""What fluid, walls and bodies exchange adds up: momentum, angular momentum, energy."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from sphframe import Simulation
from sphframe.cases import Custom
from sphframe.geometry import BoxRegion, BoxWall, PolygonWall

from .scenes import DX, random_scene

pytestmark = pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
Array = NDArray[np.float64]
SEEDS = st.integers(0, 10**6)


def moments(arm: Array, force: Array) -> Array:
    """Arm x force, (n, 1) in the plane."""
    return np.cross(arm, force) if arm.shape[1] == 3 else (arm[:, :1] * force[:, 1:] - arm[:, 1:] * force[:, :1])


def assert_balance(*parts: Array) -> None:
    """Check that the rows of all parts together add up to nothing."""
    every = np.vstack(parts)
    assert np.abs(every.sum(axis=0)).max() < 1e-11 * np.abs(every).sum(axis=0).max()


@settings(max_examples=4)
@given(SEEDS, st.sampled_from(["box", "moving", "at rest", "space"]))
def test_walls_take_what_the_fluid_loses(seed: int, walls: str) -> None:
    dim = 3 if walls == "space" else 2
    run, plain = random_scene(seed, dim, "box" if dim == 3 else walls)
    run.advance()
    system, columns = run.system, run.columns
    system.fill_ghosts()
    system.evaluate_acceleration(run.time)
    system.update_loads()
    rows = system.rows[: run.fluid_count]
    x, m = rows[:, columns.position], rows[:, columns.mass, None]
    origin, gradient = plain.force(run.time)
    forces = m * (system.rates[:, columns.velocity] - origin - x @ gradient.T)
    loads = system.loads
    assert_balance(forces, loads[:, :dim])
    assert_balance(moments(x, forces), loads[:, dim:], moments(system.references(), loads[:, :dim]))


@settings(max_examples=3)
@given(SEEDS, st.sampled_from([2, 3]))
def test_a_blob_keeps_its_energy_without_viscosity_and_diffusion(seed: int, dim: int) -> None:
    run, plain = random_scene(seed, dim)
    system, columns, n = run.system, run.columns, run.fluid_count
    rows = system.rows[:n]
    rows[:, columns.position] += 5.0 - rows[:, columns.position].mean(axis=0)
    system.parameters = system.parameters._replace(diffusion=0.0, viscosity=0.0)
    system.find_neighbours()
    system.evaluate(0.0)
    origin, gradient = plain.force(0.0)
    accelerations = system.rates[:, columns.velocity] - origin - rows[:, columns.position] @ gradient.T
    kinetic = rows[:, columns.mass, None] * rows[:, columns.velocity] * accelerations
    volume, pressure, density = (rows[:, c] for c in (columns.volume, columns.pressure, columns.density))
    compression = (volume * pressure / density * system.rates[:, columns.density])[:, None]
    assert np.abs(compression).max() > 1.0
    assert_balance(kinetic.sum(axis=1, keepdims=True), compression)


def totals(run: Simulation, mass: float, inertia: float) -> tuple[Array, Array]:
    """Momentum and angular momentum about the origin, of each particle and of the body."""
    rows, columns, body = run.system.rows[: run.fluid_count], run.columns, run.system.bodies
    place = run.boundary.centres + body.position[:, :2]
    momentum = np.vstack([rows[:, columns.mass, None] * rows[:, columns.velocity], mass * body.velocity[:, :2]])
    spin = moments(np.vstack([rows[:, columns.position], place]), momentum)
    spin[-1] += inertia * body.velocity[:, 2]
    return momentum, spin


@settings(max_examples=3)
@given(SEEDS)
def test_a_tank_that_floats_in_space_and_its_water_keep_their_momentum(seed: int) -> None:
    random = np.random.default_rng(seed)
    body: dict[str, Any] = {
        "name": "free", "mass": 900.0, "inertia": 70.0, "centre": (0.4, 0.1), "gravity": 0.0,
        "initial_velocity": tuple(random.normal(size=3)),
    }  # fmt: skip
    case = Custom(
        particle_spacing=DX, walls=[BoxWall(name="tank", lower=(0.0, 0.0), upper=(0.6, 0.6), body="tank")],
        fluid=[BoxRegion(lower=(0.0, 0.0), upper=(0.6, 0.6))], bodies={"tank": body}, gravity=0.0, sound_speed=20.0,
        until=1.0, time_step=1e-3, jitter=0.15, seed=seed, domain=((-9.0, -9.0), (9.0, 9.0)),
    )  # fmt: skip
    run = Simulation(case, threads=1)
    rows = run.system.rows[: run.fluid_count]
    rows[:, run.columns.velocity] = 0.5 * random.normal(size=(len(rows), 2))
    rows[:, run.columns.density] = 1000.0 + 2.0 * random.normal(size=len(rows))
    run.system.evaluate(0.0)
    before = totals(run, 900.0, 70.0)
    start = run.system.bodies.velocity.copy()
    for _ in range(5):
        run.advance()
    assert np.all(np.abs(run.system.bodies.velocity - start) > 1e-6), "nothing has been exchanged"
    for one, other in zip(before, totals(run, 900.0, 70.0), strict=True):
        assert_balance(other, -one)


def missing_work(spacing: float) -> float:
    """The energy that a piston's work on water without dissipation does not account for, over its largest value."""
    stroke, omega, energy, work, before = 0.01, 10.0 * np.pi, [], [0.0], 0.0

    def motion(time: float) -> tuple[Array, Array, Array]:
        along = np.array([-0.5 * stroke, 0.0, 0.0])
        cos, sin = np.cos(omega * time), np.sin(omega * time)
        return along * (1.0 - cos), along * omega * sin, along * omega**2 * cos

    case = Custom(
        particle_spacing=spacing, fluid=[BoxRegion(lower=(0.0, 0.0), upper=(1.0, 0.6))],
        walls=[PolygonWall(name="tank", points=[(1.3, 0.6), (0.0, 0.6), (0.0, 0.0), (1.3, 0.0)]),
               PolygonWall(name="piston", points=[(1.0, 0.0), (1.0, 0.6)], body="piston")],
        bodies={"piston": {"name": "prescribed", "function": motion}}, gravity=0.0, sound_speed=20.0, until=1.0,
        time_step=2e-4, artificial_viscosity=0.0, density_diffusion=0.0, domain=((-1.0, -1.0), (2.0, 2.0)),
    )  # fmt: skip
    run = Simulation(case, threads=1)
    start = sum(run.energies().values())
    while run.time < 0.2:
        run.advance()
        power = -run.wall_forces()["piston"][0][0] * motion(run.time)[1][0]
        work.append(work[-1] + 0.5 * 2e-4 * (power + before))
        energy.append(sum(run.energies().values()) - start)
        before = power
    return float(np.abs(np.subtract(energy, work[1:])).max() / max(energy))


def test_the_water_has_the_energy_of_the_pistons_work() -> None:
    coarse, fine = missing_work(0.1), missing_work(0.05)
    assert fine < 0.6 * coarse < 0.6 * 0.03
