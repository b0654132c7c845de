"""Analysis: scales for dimensionless quantities of a run, and its state of rest."""

import json
import math
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from sphframe.arrays import Array


def pressure_scale(dataset: xr.Dataset) -> float:
    """rho0 g H in Pa, with H the still water depth of the case."""
    return float(dataset.attrs["reference_density"] * dataset.attrs["gravity"] * dataset.attrs["depth"])


def time_scale(dataset: xr.Dataset) -> float:
    """sqrt(H/g) in s; 1 s without gravity."""
    gravity = float(dataset.attrs["gravity"])
    return math.sqrt(dataset.attrs["depth"] / gravity) if gravity > 0.0 else 1.0


def dimensional(series: xr.DataArray, dataset: xr.Dataset) -> xr.DataArray:
    """Return a series p/(rho0 g H) over t sqrt(g/H) in Pa over s, at the scales of a run."""
    (dim,) = series.dims
    times = series[dim].values * time_scale(dataset)
    return xr.DataArray(series.values * pressure_scale(dataset), {dim: times}, [dim], name=series.name)


def rest_pressure(dataset: xr.Dataset, height: ArrayLike) -> Array:
    """Pressure at rest in Pa at ``height`` (m) above the bed: rho0 c0^2 (exp(g (H - y)/c0^2) - 1), at least 0.

    It is exact for the linear equation of state. For Tait's equation the relative error is of the
    order of (g H / c0^2)^2, 6e-6 at c0 = 20 sqrt(g H).
    """
    attributes = dataset.attrs
    c2 = attributes["sound_speed"] ** 2
    below = np.maximum(attributes["depth"] - np.asarray(height, dtype=np.float64), 0.0)
    return np.asarray(attributes["reference_density"] * c2 * np.expm1(attributes["gravity"] * below / c2))


def case_of(dataset: xr.Dataset) -> dict[str, Any]:
    """Return the parameters of the case that was run, by name."""
    parameters: dict[str, Any] = json.loads(dataset.attrs["case_parameters"])
    return parameters


def wall_method(case: dict[str, Any]) -> str:
    """Return how the walls of a case, by its parameters, are treated, in words."""
    treatment = case["wall_treatment"]["name"]
    if treatment == "fixed-ghosts":
        return f"{case['interpolator']['name']}, {case['hydrostatic_lift']} lift"
    return f"{treatment} walls"
