"""Each variable of the file holds its own quantity: all that a simulation says is different, and is in its place."""

from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr

from sphframe.interfaces import Fields, Motion, WallLoad
from sphframe.output import NetCDFWriter, open_dataset

PARTICLES, GHOSTS = 50, 20


def numbered(shape: tuple[int, ...], first: float) -> Any:
    """Numbers that are found nowhere else."""
    return first + np.arange(np.prod(shape), dtype=np.float64).reshape(shape) / 1024.0


def test_every_variable_holds_its_own_quantity(tmp_path: Path, fake: ModuleType) -> None:
    run = fake.FakeSimulation()
    fluid = Fields(*(numbered((PARTICLES, *size), 10.0 * k) for k, size in enumerate([(2,), (2,), (), ()], start=1)))
    ghosts = Fields(*(numbered((GHOSTS, *size), 10.0 * k) for k, size in enumerate([(2,), (2,), (), ()], start=5)))
    motion = Motion(*numbered((3, 3), 100.0))
    loads = {wall: WallLoad(*numbered((2, 2), start), *numbered((2, 1), start + 5.0))
             for wall, start in (("tank", 110.0), ("paddle", 120.0))}  # fmt: skip
    energies = dict(zip(("kinetic", "potential", "internal"), numbered((3,), 130.0), strict=True))
    place = SimpleNamespace(
        position=numbered((GHOSTS, 2), 140.0), mirror=numbered((GHOSTS, 2), 150.0), body=np.arange(GHOSTS) % 2 - 1
    )
    masses, readings = numbered((PARTICLES,), 160.0), (numbered((2,), 170.0), np.array([True, False]))
    run.time, run.step, run.time_step, run.wall_clock, run.processor_time = 0.0, 7, 180.0, 181.0, 182.0
    run.removed_count, run.densities_outside, run.ghosts = 3, 4, place
    answers = {
        "fields": fluid, "ghost_fields": ghosts, "body_motions": {"paddle": motion}, "wall_loads": loads,
        "energies": energies, "masses": masses, "probe_readings": readings,
        "gauge_readings": (np.array([190.0]), np.array([189.0])),
        "diagnostics": {"front_position": 191.0}, "status_counts": np.arange(4) + 200, "particles_outside": 6,
    }  # fmt: skip
    for name, answer in answers.items():
        setattr(run, name, lambda answer=answer: answer)
    writer = NetCDFWriter(tmp_path / "run.nc")
    writer.sphframe_run_started(simulation=run)
    writer.sphframe_probes_due(simulation=run)
    writer.sphframe_frame_due(simulation=run)
    writer.sphframe_run_finished(simulation=run)
    expected: dict[str, Any] = {
        **{name: getattr(fluid, name) for name in ("position", "velocity", "density", "pressure")},
        "ghost_pressure": ghosts.pressure, "ghost_position": place.position, "ghost_mirror_position": place.mirror,
        "ghost_body": place.body, "particle_mass": masses, "mass": masses.sum(), "particles_outside": 6, "time": 0.0,
        "body_position": motion.position[:2], "body_velocity": motion.velocity[:2],
        "body_acceleration": motion.acceleration[:2], "body_angle": motion.position[2],
        "body_angular_velocity": motion.velocity[2], "body_angular_acceleration": motion.acceleration[2],
        **{f"wall_{name}": [np.squeeze(getattr(load, name)) for load in loads.values()] for name in WallLoad._fields},
        **{f"{name}_energy": value for name, value in energies.items()}, "total_energy": sum(energies.values()),
        "probe_pressure": readings[0], "probe_wet": readings[1], "gauge_elevation": 190.0, "gauge_depth": 189.0,
        "front_position": 191.0,
        "interpolation_status": np.arange(4) + 200, "particles_removed": 3, "densities_outside": 4, "step": 7,
        "time_step": 180.0, "wall_clock": 181.0, "processor_time": 182.0, "probe_time": 0.0, "wall_body": [-1, 0],
        "probe_body": [-1, -1], "gauge_body": -1, "probe_x": [0.0, 0.0], "probe_y": [0.0, 0.1], "gauge_x": 0.5,
        "probe_radius": [0.0, 0.0], "body_centre": [0.0, 0.0], "wall_reference": [[0.0, 0.0], [0.0, 0.0]],
        "outline_node": [[0, 1], [0, 0], [1, 0], [1, 0], [1, 1]], "outline_node_count": [3, 2], "outline_wall": [0, 1],
    }  # fmt: skip
    with open_dataset(tmp_path / "run.nc") as dataset:
        numbers = {str(name) for name, values in dataset.variables.items() if values.dtype.kind in "fib"}
        assert numbers - expected.keys() <= {"run_status"}, "a variable is not checked here"
        for name, value in expected.items():
            assert_holds(dataset, name, value)


def assert_holds(dataset: xr.Dataset, name: str, value: Any) -> None:
    """Compare a variable with what it should hold."""
    assert np.squeeze(dataset[name].values) == pytest.approx(np.squeeze(np.asarray(value, dtype=float))), name
