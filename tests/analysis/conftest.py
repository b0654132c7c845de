from pathlib import Path

import pytest
import xarray as xr

import sphframe


@pytest.fixture(scope="session")
def tank(tmp_path_factory: pytest.TempPathFactory) -> xr.Dataset:
    """A few steps of still water."""
    folder: Path = tmp_path_factory.mktemp("analysis")
    case = {"particle_spacing": 0.025, "until": 0.02, "frame_interval": 0.005, "courant_number": 0.3}
    return sphframe.run("hydrostatic-tank", output=folder / "tank.nc", threads=1, **case).dataset


@pytest.fixture(scope="session")
def tank_3d(tmp_path_factory: pytest.TempPathFactory) -> xr.Dataset:
    folder: Path = tmp_path_factory.mktemp("analysis")
    case = {"dimension": 3, "particle_spacing": 0.025, "until": 0.01, "frame_interval": 0.005, "courant_number": 0.3}
    return sphframe.run("hydrostatic-tank", output=folder / "tank.nc", threads=1, **case).dataset
