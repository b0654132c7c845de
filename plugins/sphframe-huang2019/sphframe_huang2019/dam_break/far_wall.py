"""Pressures of the particles near the far wall during the plateau."""

import math
from typing import Any

import numpy as np
import xarray as xr
from scipy.spatial import cKDTree

from sphframe.analysis import pressure_scale, time_scale

__all__ = ["mean_profile", "roughness", "wall_and_depth"]


def wall_and_depth(dataset: xr.Dataset) -> tuple[float, float]:
    """Return the abscissa of the far wall and the depth H of the water at the start, m."""
    return float(dataset["outline_node"].isel(space=0).max()), float(dataset.attrs["depth"])


def roughness(dataset: xr.Dataset) -> float:
    """Return how rough the pressure is in the far lower corner, over rho g H; NaN without frames of the plateau.

    It is the RMS difference of the pressures of particles from the planes that fit the pressures of their neighbours
    within 2.5 spacings (least squares), within 0.5 H of the corner, in about four frames of the plateau.
    """
    right, height = wall_and_depth(dataset)
    spacing = float(dataset.attrs["particle_spacing"])
    frames = _plateau(dataset)
    residuals = []
    for k in range(0, frames.sizes["time"], max(1, frames.sizes["time"] // 4)):
        x, p = frames["position"][k].values, frames["pressure"][k].values
        near = (x[:, 0] > right - 0.5 * height) & (x[:, 1] < 0.5 * height)
        x, p = x[near], p[near]
        for i, members in enumerate(cKDTree(x).query_ball_point(x, 2.5 * spacing)):
            if len(members) >= 12:  # a particle within the water, not spray
                offsets = x[members] - x[i]
                plane = np.linalg.lstsq(np.column_stack([np.ones(len(members)), offsets]), p[members], rcond=None)[0]
                residuals.append(p[i] - plane[0])
    return float(np.sqrt(np.mean(np.square(residuals))) / pressure_scale(dataset)) if residuals else math.nan


def mean_profile(dataset: xr.Dataset) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Return heights over H, and mean pressures over rho g H of the particles within two spacings of the wall."""
    right, height = wall_and_depth(dataset)
    spacing = float(dataset.attrs["particle_spacing"])
    frames = _plateau(dataset)
    x, p = frames["position"].values.reshape(-1, 2), frames["pressure"].values.reshape(-1)
    beside = x[:, 0] > right - 2.0 * spacing
    edges = np.arange(0.0, 0.6, max(0.02, spacing / height))
    bins = np.digitize(x[beside, 1] / height, edges) - 1
    means = [p[beside][bins == k].mean() if (bins == k).any() else math.nan for k in range(len(edges) - 1)]
    return 0.5 * (edges[1:] + edges[:-1]), np.array(means) / pressure_scale(dataset)


def _plateau(dataset: xr.Dataset) -> xr.Dataset:
    scale = time_scale(dataset)
    return dataset[["position", "pressure"]].sel(time=slice(3.2 * scale, 4.8 * scale))
