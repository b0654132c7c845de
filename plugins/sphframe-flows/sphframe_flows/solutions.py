"""What the exact solutions have in common."""

import cmath
import math
from typing import Any

import numpy as np
import xarray as xr
from scipy.optimize import curve_fit
from scipy.spatial import cKDTree

from sphframe import Array


def variable(dim: str, values: Any, unit: str, long_name: str) -> tuple[str, Any, dict[str, str]]:
    """Return a one-dimensional variable of a dataset."""
    return dim, np.asarray(values, dtype=np.float64), {"units": unit, "long_name": long_name}


def sample_times(dataset: xr.Dataset) -> tuple[str, Any, dict[str, str]]:
    """Return the times of the samples of a run, as a coordinate."""
    return variable("probe_time", dataset["probe_time"].values, "s", "time")


def late_mean(values: xr.DataArray) -> float:
    """Return the mean over the last fifth of a series."""
    return float(values[4 * len(values) // 5 :].mean())


def mean_velocity(dataset: xr.Dataset, points: Array, frames: int) -> Array:
    """Return the velocity (k, dim), m/s, at ``points`` (k, dim), averaged over the last ``frames`` of a run.

    At each frame it is the value of a linear least-squares fit to the particles within three spacings, weighted by
    (1 - r / 3 dx)^2.
    """
    reach = 3.0 * float(dataset.attrs["particle_spacing"])
    total = np.zeros_like(points)
    for index in range(-frames, 0):
        frame = dataset[["position", "velocity"]].isel(time=index)
        position, velocity = frame["position"].values, frame["velocity"].values
        kept = np.isfinite(position[:, 0])
        position, velocity = position[kept], velocity[kept]
        for k, near in enumerate(cKDTree(position).query_ball_point(points, reach)):
            away = position[near] - points[k]
            weight = (1.0 - np.linalg.norm(away, axis=1) / reach)[:, None]
            basis = weight * np.column_stack([np.ones(len(near)), away])
            total[k] += np.linalg.lstsq(basis, weight * velocity[near], rcond=None)[0][0]
    return total / frames


def fitted_oscillation(time: Array, values: Array, frequency: float, damping: float) -> tuple[float, float]:
    """Return angular frequency and damping, rad/s and 1/s, of A exp(-d t) cos(w t + phi) fitted to ``values``.

    ``frequency`` and ``damping`` are where the fit starts.
    """

    def model(t: Array, size: float, w: float, d: float, phase: float) -> Array:
        return size * np.exp(-d * t) * np.cos(w * t + phase)

    start = (float(np.abs(values).max()), frequency, damping, 0.0)
    found, _ = curve_fit(model, time, values, p0=start, maxfev=20_000)
    return float(abs(found[1])), float(found[2])


def viscous_wave(wavenumber: float, depth: float, gravity: float, viscosity: float) -> complex:
    """Return the growth rate s of a standing wave on a viscous fluid above a free-slip bed: exp(s t), Im s > 0.

    It is the root near that of an inviscid fluid, i sqrt(g k tanh kh), of the linearised Navier-Stokes equations, with
    m^2 = k^2 + s / nu::

        s^2 cosh(kh) / k + g [sinh(kh) + b sinh(mh)] + 2 nu s [k cosh(kh) + b m cosh(mh)] = 0
        b = -2 k^2 sinh(kh) / [(m^2 + k^2) sinh(mh)]

    from vanishing tangential and normal stress at the surface.

    Source: H. Lamb, Hydrodynamics, 6th ed., Cambridge (1932), sections 348 and 349, with a bed.

    Examples
    --------
    >>> rate = viscous_wave(math.pi, 1.0, 1.0, 1.0 / 500.0)
    >>> round(rate.imag, 5), round(-rate.real, 5)
    (1.76623, 0.03652)
    """
    k, h, g, nu = wavenumber, depth, gravity, viscosity
    s = 1j * math.sqrt(g * k * math.tanh(k * h))
    if nu == 0.0:
        return s

    def residual(s: complex) -> complex:
        m = cmath.sqrt(k * k + s / nu)
        b_sinh = -2.0 * k * k * math.sinh(k * h) / (m * m + k * k)
        stress = k * math.cosh(k * h) + b_sinh * m / cmath.tanh(m * h)
        return s * s * math.cosh(k * h) / k + g * (math.sinh(k * h) + b_sinh) + 2.0 * nu * s * stress

    s, other = s - 2.0 * nu * k * k, s
    for _ in range(100):  # the secant method
        one, two = residual(s), residual(other)
        if one == two:
            break
        s, other = s - one * (s - other) / (one - two), s
        if abs(s - other) < 1e-14 * abs(s):
            break
    return s
