"""Seawalls that stand, lean and spring, with water in the flume: forces, run-up, and the motion of the wall."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sphframe_waves import SolitaryWaveFixedWall, SolitaryWaveMovableWall

from sphframe import Simulation, load_case, run


@pytest.mark.parametrize(
    ("method", "angle"),
    [
        ("improved-shepard", 120.0),
        pytest.param("mls-linear", 90.0, marks=pytest.mark.long),
        pytest.param("improved-shepard", 90.0, marks=pytest.mark.long),
        pytest.param("mls-linear", 120.0, marks=pytest.mark.long),
    ],
)
def test_hydrostatic_force_by_both_methods(method: str, angle: float) -> None:
    case = SolitaryWaveFixedWall(tank_length=0.8, wall_angle=angle, wave_height=1e-6, until=1.0, interpolator=method)
    simulation = Simulation(case, threads=1)
    exact = 0.5 * 9810.0 * 0.25**2
    forces = []
    while simulation.time < 0.25:
        simulation.advance()
        if simulation.time > 0.05:
            walls = simulation.wall_forces()
            forces.append([abs(force[0]) / exact for name in ("paddle", "tank") for force in walls[name]])
    assert np.mean(forces, axis=0) == pytest.approx(1.0, abs=0.01)
    assert simulation.particles_outside() == 0


def test_spring_wall_waits_for_its_threshold_then_gives_way() -> None:
    common: dict[str, Any] = {"tank_length": 1.0, "wave_height": 0.08, "particle_spacing": 0.025}
    simulation = Simulation(SolitaryWaveMovableWall(**common), threads=1)
    threshold = 1.1 * 0.5 * 9810.0 * 0.2**2
    work, before, seen = 0.0, (0.0, 0.0), False
    while simulation.time < 1.9:
        simulation.advance()
        force = simulation.wall_forces()["seawall"][0][0]
        motion = simulation.body_motions()["seawall"]
        x, u = motion.position[0], motion.velocity[0]
        power = max(force - threshold, 0.0) * u
        work += 0.5 * (power + before[1]) * (simulation.time - before[0])
        before = (simulation.time, power)
        seen = seen or force > threshold
        assert x >= 0.0
        assert seen or x == 0.0
    energy = 0.5 * 250.0 * u * u + 0.5 * 10.0 * x * x
    assert x > 0.05
    assert work == pytest.approx(energy, rel=0.02)
    assert simulation.particles_outside() == 0


def test_run_up_of_still_water_is_zero_on_any_wall() -> None:
    for angle in (60.0, 90.0, 120.0):
        case = SolitaryWaveFixedWall(tank_length=1.0, wall_angle=angle)
        simulation = Simulation(case, threads=1)
        assert simulation.diagnostics()["run_up"] == pytest.approx(0.0, abs=0.5 * case.particle_spacing)


def test_run_up_follows_water_added_at_the_wall() -> None:
    case = SolitaryWaveFixedWall(tank_length=1.0)
    measure = case.scene().diagnostics[0].function
    simulation = Simulation(case, threads=1)
    fields = simulation.fields()
    raised = fields._replace(position=fields.position + np.array([0.0, 0.0333]))
    assert measure(raised) == pytest.approx(0.0333, abs=1e-4)
    assert measure(fields._replace(position=fields.position - np.array([9.0, 0.0]))) == -0.25


def test_paddle_force_is_recorded_apart_from_the_bed() -> None:
    case = SolitaryWaveMovableWall(tank_length=0.8, wave_height=1e-6)
    simulation = Simulation(case, threads=1)
    forces = simulation.wall_forces()
    weight = simulation.masses().sum() * 9.81
    assert forces["bed"][0][1] == pytest.approx(-weight, rel=2e-3)
    assert forces["bed"][0][0] == pytest.approx(0.0, abs=1e-6 * weight)
    assert forces["paddle"][0][0] == pytest.approx(-forces["seawall"][0][0], rel=1e-3)


@pytest.mark.filterwarnings("ignore:particle_spacing .* particles over the depth")
@pytest.mark.parametrize("case", [SolitaryWaveFixedWall, SolitaryWaveMovableWall])
def test_a_run_can_be_repeated_from_its_output(case: type, tmp_path: Path) -> None:
    given = case(tank_length=0.8, particle_spacing=0.04, until=0.01)
    output = tmp_path / "run.nc"
    with run(given, output=output, threads=1).dataset as dataset:
        assert dataset.attrs["case_name"] in ("solitary-wave-fixed-wall", "solitary-wave-movable-wall")
    again = load_case(output)
    assert type(again) is case
    assert again == given
