"""What the three studies of solitary waves read from a run."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from sphframe.analysis import pressure_scale, time_scale

Array = NDArray[np.float64]

FLUME = "solitary-wave-fixed-wall"


def crests(dataset: xr.Dataset) -> tuple[Array, Array, Array]:
    """Return the places of the gauges, m, the times at which the incident crest passes them, s, and its heights there.

    Heights are above still water, m. They and the times are those of the vertex of a parabola through the samples
    around the highest one, which removes the noise of single particles.
    """
    t = dataset["probe_time"].values
    times, heights = [], []
    for elevation in (dataset["gauge_elevation"] - dataset.attrs["depth"]).values.T:
        wet = np.isfinite(elevation)  # a gauge is dry after the paddle has passed it
        peak = t[wet][np.argmax(elevation[wet])]
        near = wet & (np.abs(t - peak) < 0.6 * time_scale(dataset))
        a, b, c = np.polyfit(t[near] - peak, elevation[near], 2)
        times.append(peak - b / (2.0 * a))
        heights.append(c - b * b / (4.0 * a))
    return dataset["gauge_x"].values, np.array(times), np.array(heights)


def seawall_force(dataset: xr.Dataset, by: str = "wall_force") -> xr.DataArray:
    """Horizontal force on the seawall over rho g d^2 / 2."""
    wall = "seawall" if "seawall" in dataset["wall"].values else "tank"
    still = 0.5 * dataset.attrs["depth"] * pressure_scale(dataset)
    return dataset[by].sel(wall=wall, space="x") / still
