"""Open boundaries of a channel: inflow at a given profile, and outflow."""

from typing import Any

import numba
import numpy as np
import pytest

from sphframe import InputError, SimulationError
from sphframe.cases import Custom
from sphframe.cases.checks import check_case
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe.simulation.simulation import Simulation

N, LENGTH, NU = 16, 2.0, 0.05


def channel(**parameters: Any) -> Custom:
    beyond = ((-0.5, LENGTH + 0.5), (0.0, 1.0))
    return Custom(
        **{
            "particle_spacing": 1.0 / N, "until": 1.0, "gravity": 0.0, "sound_speed": 10.0, "depth": 1.0,
            "open_boundaries": {"velocity": 1.0},
            "walls": [
                PolygonWall(name=name, points=[(beyond[0][0], y), (beyond[0][1], y)])
                for name, y in zip(("bed", "lid"), beyond[1], strict=True)
            ],
            "fluid": [PolygonRegion(points=[(0, 0), (LENGTH, 0), (LENGTH, 1), (0, 1)])],
            **parameters,
        }
    )  # fmt: skip


def viscous(**parameters: Any) -> Custom:
    return channel(
        **{
            "open_boundaries": {"velocity": 1.0, "profile": "parabola"}, "kinematic_viscosity": NU, "slip": "no",
            "artificial_viscosity": 0.0, "tension": "free", **parameters,
        }
    )  # fmt: skip


def run(simulation: Simulation, until: float) -> Simulation:
    while simulation.time < until:
        simulation.advance()
    return simulation


def inner(simulation: Simulation) -> Any:
    """Rows of the particles between the planes."""
    rows, open_ends = simulation.system.rows[: simulation.fluid_count], simulation.system.channel
    assert open_ends is not None
    return rows[~open_ends.in_zone(rows)]


def test_a_uniform_stream_stays_to_round_off_and_its_mass_is_balanced() -> None:
    simulation = Simulation(channel(), threads=1)
    start = simulation.system.rows[: simulation.fluid_count, simulation.columns.mass].sum()
    run(simulation, 0.6)
    rows, open_ends = inner(simulation), simulation.system.channel
    assert open_ends is not None
    assert np.abs(rows[:, 2] - 1.0).max() < 1e-12
    assert np.abs(rows[:, 3]).max() < 1e-12
    assert np.abs(rows[:, simulation.columns.pressure]).max() < 1e-7
    entered, left = open_ends.passed
    assert entered == left == pytest.approx(1000.0 * 0.6, abs=1000.0 / N)
    assert simulation.system.rows[: simulation.fluid_count, 7].sum() == pytest.approx(start + entered - left, rel=1e-12)
    assert len(np.unique(simulation.system.ids)) == simulation.fluid_count


def test_poiseuille_flow_passes_unchanged() -> None:
    simulation = run(Simulation(viscous(until=2.0), threads=1), 2.0)
    rows = inner(simulation)
    error = rows[:, 2] - 4.0 * rows[:, 1] * (1.0 - rows[:, 1])
    assert np.sqrt(np.square(error).mean()) < 0.01
    assert np.abs(error).max() < 0.015, "0.0104 is that of a periodic channel at this spacing"
    middle = np.abs(rows[:, 0] - 0.5 * LENGTH) < 0.4
    slope = np.polyfit(rows[middle, 0], rows[middle, 5], 1)[0]
    assert slope == pytest.approx(-8.0 * 1000.0 * NU, rel=0.05)
    entered, left = simulation.system.channel.passed  # type: ignore[union-attr]
    assert entered == pytest.approx(1000.0 * 2.0 / 3.0 * 2.0, rel=0.04)
    assert left == pytest.approx(entered, rel=0.04)


def test_a_sound_wave_leaves() -> None:
    simulation = Simulation(channel(), threads=1)
    rows, columns = simulation.system.rows[: simulation.fluid_count], simulation.columns
    push = 0.05 * np.exp(-(((rows[:, 0] - 1.0) / 0.2) ** 2))
    rows[:, columns.u] += push
    rows[:, columns.density] += 1000.0 * push / 10.0
    before = np.sqrt(np.square(inner(simulation)[:, 2] - 1.0).mean())
    after = np.sqrt(np.square(inner(run(simulation, 0.99))[:, 2] - 1.0).mean())
    assert after < 0.2 * before, "with the gradient of pressure at the inflow as it is, the wave grows"


def test_the_inflow_follows_its_table_and_its_ramp() -> None:
    given = {"table": [(0.0, 0.2), (0.5, 0.4), (1.0, 0.2)], "ramp": 0.2, "pressure": 50.0}
    simulation = run(Simulation(channel(open_boundaries=given), threads=1), 0.1)
    rows, ends = simulation.system.rows[: simulation.fluid_count], simulation.system.channel.ends  # type: ignore[union-attr]
    zone = rows[rows[:, 0] < ends.inflow]
    expected = 0.5 * np.interp(zone[:, 1], [0.0, 0.5, 1.0], [0.2, 0.4, 0.2])
    np.testing.assert_allclose(zone[:, 2], expected, rtol=0.02)
    with pytest.raises(InputError, match="velocity of the inflow, or a table"):
        channel(open_boundaries={"profile": "parabola"})
    with pytest.raises(InputError, match="each above the one before"):
        channel(open_boundaries={"table": [(1.0, 0.2), (0.0, 0.2)]})


@pytest.mark.parametrize("threads", [1, pytest.param(2, marks=pytest.mark.long)])
def test_the_same_bits_with_threads_and_after_a_restart(threads: int) -> None:
    case, states = channel(open_boundaries={"velocity": 1.0, "profile": "parabola"}), []
    for count in sorted({1, min(threads, numba.config.NUMBA_NUM_THREADS)}):  # type: ignore[attr-defined]
        simulation = run(Simulation(case, threads=count), 0.12)
        saved = simulation.state()
        states.append(run(simulation, 0.2).state())
    assert all(array.dtype.kind in "iuf" for array in saved.values()), "a checkpoint holds numbers alone"
    other = Simulation(case, threads=1)
    other.restore(saved)
    states.append(run(other, 0.2).state())
    assert other.system.channel is not None
    assert other.system.channel.passed[0] > 0.0
    for state in states[1:]:
        for name, array in states[0].items():
            if name != "clocks":
                assert np.array_equal(array, state[name]), name


def test_pressure_and_volume_in_the_zones_are_those_of_the_density_to_the_bit() -> None:
    """Else a sample that follows a restart, for which both are computed again, has other bits."""
    simulation = run(Simulation(viscous(), threads=1), 0.12)
    before = simulation.system.rows.copy()
    simulation.system.update_pressure()
    assert np.array_equal(simulation.system.rows, before)


def test_more_particles_than_there_is_room_for_are_refused() -> None:
    simulation = Simulation(channel(), threads=1)
    assert simulation.system.channel is not None
    simulation.system.channel.capacity = simulation.fluid_count - 1
    with pytest.raises(SimulationError, match=r"more than \d+ particles are in the channel"):
        run(simulation, 0.2)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"periodic": ("x",), "domain": ((0, -1), (LENGTH, 2))}, "cannot be together with periodic"),
        ({"gravity": 9.81}, "cannot be together with gravity"),
        ({"guards": {"domain": "remove"}}, "cannot be together with guards.domain"),
        ({"particle_spacing": 1.0 / 16.4}, "spacings wide"),
        ({"fluid": [PolygonRegion(points=[(0, 0), (1.2, 0), (1.2, 1), (0, 1)])]}, "too short for two zones"),
        ({"fluid": [PolygonRegion(points=[(0, 0), (2, 0), (2, 0.5), (0, 0.5)])]}, "inflow zone, .* has no wall above"),
        ({"fluid": [PolygonRegion(points=[(0, 0), (2, 0), (2, 0.5), (0, 1)])]}, "outflow zone, .* is not full"),
        (
            {"walls": [*channel().walls, PolygonWall(name="plate", points=[(0.2, 0.5), (0.8, 0.5)])]},
            "inflow zone, .* is crossed by a wall",
        ),
        ({"domain": ((0, -1), (LENGTH, 2))}, "must reach a spacing beyond both ends"),
    ],
)
def test_what_cannot_be_done_is_refused(parameters: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        check_case(channel(**parameters))
