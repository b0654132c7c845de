"""Small runs of the flows, beside their exact solutions."""

from pathlib import Path
from typing import Any

import pytest
from matplotlib.figure import Figure

from sphframe import InputError, run
from sphframe.analysis import summary

COARSE: dict[str, tuple[dict[str, Any], dict[str, float]]] = {
    "rotating-bucket": ({"particle_spacing": 0.03, "until": 0.4}, {"surface": 0.5}),
    "hydrostatic-wedge": (
        {"particle_spacing": 0.04, "until": 0.4, "tank_length": 1.2},
        {"pressure": 0.02, "downward_force": 0.02, "horizontal_force": 0.03, "kinetic_energy": 1e-4},
    ),
    "stokes-plate": ({"particle_spacing": 0.1, "until": 0.8, "kinematic_viscosity": 0.2}, {"velocity": 0.05}),
    "oscillating-cylinder": ({"particle_spacing": 0.02, "until": 1.5}, {"added_mass_inner": 0.06}),
    "poiseuille": ({"particle_spacing": 0.0625, "until": 6.0}, {"velocity": 0.012, "start_up": 0.012, "stress": 1e-3}),
    "couette": ({"particle_spacing": 0.0625, "until": 5.0}, {"velocity": 0.01}),
    "cylinder-array": ({"particle_spacing": 1.0 / 30.0}, {"drag_factor": 0.02, "force": 0.02}),
    "tilted-tank": ({"particle_spacing": 0.06, "until": 0.3}, {"pressure": 0.02, "weight": 0.01, "thrust": 0.01}),
    "circular-sill": (
        {"particle_spacing": 0.05, "until": 0.3},
        {"pressure": 0.02, "downward_force": 0.02, "horizontal_force": 0.02},
    ),
    "submerged-box": ({"particle_spacing": 0.05, "until": 0.3}, {"pressure": 0.02, "buoyancy": 0.02, "moment": 0.01}),
    "two-basins": ({"particle_spacing": 0.05, "until": 0.3}, {"pressure": 0.02, "plate_force": 0.02}),
    "column-impact": ({"particle_spacing": 0.04}, {"plateau": 0.03, "suction": 0.02}),
    "ceiling-release": ({"particle_spacing": 0.04}, {"fall": 1e-9, "force": 1e-9, "shape": 1e-9}),
    "drum": ({"particle_spacing": 0.05, "slip": "no"}, {"velocity": 0.05, "angular_momentum": 0.12}),
    "accelerated-tank": ({"particle_spacing": 0.03, "until": 0.3}, {"pressure": 0.02, "velocity": 0.01}),
    "dam-break-impact": ({"particle_spacing": 0.03}, {"pressure": 0.3, "P4": 0.25}),
    "oblique-jet": ({"length": 0.8}, {"force": 0.05, "split": 0.03}),
    "cylinder-in-channel": (
        {"channel_length": 0.6, "until": 1.2},
        {"drag": 0.05, "lift": 0.03, "pressure_difference": 0.5},
    ),
    "standing-wave": (
        {"particle_spacing": 1.0 / 30.0, "kinematic_viscosity": 0.00626},
        {"frequency": 0.015, "damping": 0.05},
    ),
    "moving-square": ({"particle_spacing": 0.125, "until": 1.2}, {"start": 0.12, "drag": 0.4}),
    "taylor-green": ({"until": 0.5}, {"last_kinetic_energy": 0.03, "velocity": 0.05, "largest_hole": 0.2}),
}
"""parameters of short runs, and limits of their errors"""


LONG = {
    "couette", "cylinder-in-channel", "dam-break-impact", "drum", "moving-square", "oblique-jet", "standing-wave",
    "taylor-green", "two-basins",
}  # fmt: skip
"""runs of many steps, or compiled with options of their own"""


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] * (name in LONG)) for name in COARSE])
def test_coarse_runs_agree_with_their_solutions(name: str, tmp_path: Path) -> None:
    parameters, limits = COARSE[name]
    result = run(name, output=tmp_path / "flow.nc", threads=1, guards={"filling": "report"}, **parameters)
    dataset = result.dataset
    found = summary(dataset)["errors"]
    for error, limit in limits.items():
        assert found[error] < limit, found
    exact, measured = dataset.sph.exact, dataset.sph.measured
    assert set(exact.data_vars) <= set(measured.data_vars)
    assert isinstance(dataset.sph.plot(tmp_path / "flow.png"), Figure)
    if name == "rotating-bucket":
        for wrong in ({"angular_speed": 9.0}, {"particle_spacing": 0.2}):
            with pytest.raises(InputError):
                run(name, output=tmp_path / "wrong.nc", threads=1, **wrong)
