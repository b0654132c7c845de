"""The pressure on the far wall of the dam break."""

import numpy as np
import xarray as xr

from sphframe.analysis import pressure_scale, running_mean, time_scale

PLATEAU = slice(3.2, 4.8)
"""times of the plateau of the pressure, over sqrt(H/g)"""
WINDOW = 0.1
"""width of the running mean, which removes acoustic waves, over sqrt(H/g)"""


def wall_pressure(dataset: xr.Dataset) -> xr.DataArray:
    """Return the running mean of P1 over rho g H, over t sqrt(g/H)."""
    p1 = dataset["probe_pressure"].sel(probe="P1").values / pressure_scale(dataset)
    return running_mean(dataset["probe_time"].values / time_scale(dataset), p1, WINDOW, 0.01)


def pressure_beside_wall(dataset: xr.Dataset, height: float) -> float:
    """Return the mean p/(rho g H) in the plateau, within 3 spacings of the far wall and 2 of ``height`` H."""
    spacing, depth, scale = float(dataset.attrs["particle_spacing"]), float(dataset.attrs["depth"]), time_scale(dataset)
    frames = dataset[["position", "pressure"]].sel(time=slice(PLATEAU.start * scale, PLATEAU.stop * scale))
    distance = float(dataset["outline_node"].isel(space=0).max()) - frames["position"].isel(space=0)
    above = np.abs(frames["position"].isel(space=-1) - height * depth)
    beside = frames["pressure"].where((distance < 3.0 * spacing) & (above < 2.0 * spacing))
    return float(beside.mean("particle").mean() / pressure_scale(dataset))
