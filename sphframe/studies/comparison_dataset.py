"""Studies: the results of several methods at several resolutions, gathered into one dataset."""

import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from sphframe.analysis import convergence_order, pressure_scale, summary
from sphframe.arrays import Array
from sphframe.errors import InputError
from sphframe.studies.comparison_error import error_measure
from sphframe.studies.series import fallback_share

_SAMPLES = 2001
"""number of times at which the dataset holds the pressures at the probes"""
_OVER = ("interpolator", "particle_spacing")
_NUMBERS = {
    "cost": {"units": "us", "long_name": "processor time per particle and step, without compilation"},
    "processor_time": {"units": "s", "long_name": "processor time of the run, compilation included"},
    "wall_clock": {"units": "s", "long_name": "wall-clock time of the run, output included"},
    "waited": {"units": "1", "long_name": "1 for a run that had to wait for processors or the disk"},
    "steps": {"units": "1", "long_name": "time steps"},
    "particles": {"units": "1", "long_name": "fluid particles"},
    "energy_excess": {"units": "1", "long_name": "largest total energy over the first, -1"},
    "fallback": {"units": "%", "long_name": "wet ghosts that used the fallback"},
    "completed": {"units": "1", "long_name": "1 for a run that reached its end"},
}
"""what the dataset holds of each run, beside its error and its pressures"""


def comparison_dataset(
    runs: Mapping[tuple[str, float], xr.Dataset], reference: xr.DataArray | None, probe: str | None
) -> xr.Dataset:
    """Return errors, costs, orders and pressures at the probes over (interpolator, particle_spacing).

    Parameters
    ----------
    runs
        by method and particle spacing (m), each method with the same spacings, the finest last.
    reference
        series of p/(rho g H) over t sqrt(g/H), or None.
    probe
        the probe to compare with it; by default the first.

    Raises
    ------
    InputError
        the case has no probe of this name.
    """
    methods, spacings = list(dict.fromkeys(m for m, _ in runs)), list(dict.fromkeys(s for _, s in runs))
    first = next(iter(runs.values()))
    probes = [str(name) for name in first["probe"].values] if "probe_pressure" in first else []
    if probe is not None and probe not in probes:
        raise InputError(f"the case has no probe {probe!r}; it has {', '.join(probes) or 'none'}")
    compared = probe or next(iter(probes), None)

    def table(value: Callable[[str, float], Any]) -> NDArray[Any]:
        return np.array([[value(method, spacing) for spacing in spacings] for method in methods])

    figures = {key: summary(run) for key, run in runs.items()}
    measure = error_measure(first, figures[methods[0], spacings[0]], reference, compared)

    def error_of(method: str, spacing: float) -> float:
        run, finest = runs[method, spacing], runs[method, spacings[-1]]
        return measure.of(run, figures[method, spacing], finest) if run.attrs["completed"] == "yes" else math.nan

    error = table(error_of)
    numbers = {key: _numbers(run, figures[key]) for key, run in runs.items()}
    times = _common_times(runs.values())
    pressure = table(lambda m, s: _pressures(runs[m, s], times, len(probes)))
    order = [_order(spacings, row) for row in error]
    return xr.Dataset(
        {
            "error": (_OVER, error, {"units": measure.units, "long_name": measure.meaning}),
            "order": ("interpolator", order, {"units": "1", "long_name": "observed order of convergence"}),
            **{
                name: (_OVER, table(lambda m, s, name=name: numbers[m, s][name]), attributes)  # type: ignore[misc]
                for name, attributes in _NUMBERS.items()
            },
            "probe_pressure": (
                (*_OVER, "probe", "probe_time"), pressure, {"units": "Pa", "long_name": "pressure at the probe"}
            ),
        },
        coords={
            "interpolator": methods,
            "particle_spacing": ("particle_spacing", spacings, {"units": "m", "long_name": "particle spacing"}),
            "probe": probes,
            "probe_time": ("probe_time", times, {"units": "s", "long_name": "time"}),
        },
        attrs={
            "title": str(first.attrs["title"]),
            "case_name": str(first.attrs["case_name"]),
            "pressure_scale": pressure_scale(first),
        },
    )  # fmt: skip


def _numbers(run: xr.Dataset, figures: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the dataset holds of one run, with the key ``figures`` of its summary; NaN for what is not known."""
    known = {name: value for name, value in figures.items() if value is not None}
    numbers: dict[str, Any] = {name: float(known.get(name, math.nan)) for name in _NUMBERS if name != "completed"}
    numbers["cost"] = 1e6 * _time_per_step(run) / numbers["particles"]
    numbers["fallback"] = fallback_share(run)
    numbers["completed"] = np.int8(run.attrs["completed"] == "yes")
    return numbers


def _time_per_step(run: xr.Dataset) -> float:
    """Return the processor time of a step, s: the median between samples, which leaves compilation out."""
    steps, times = np.diff(run["step"].values), np.diff(run["processor_time"].values)
    return float(np.median(times[steps > 0] / steps[steps > 0])) if (steps > 0).any() else math.nan


def _common_times(runs: Iterable[xr.Dataset]) -> Array:
    """Return evenly spaced times from zero to the last sample of any run, s."""
    return np.linspace(0.0, max(float(run["probe_time"][-1]) for run in runs if run.sizes["probe_time"]), _SAMPLES)


def _pressures(run: xr.Dataset, times: Array, probes: int) -> Array:
    """Return the pressures at the probes, (probes, times), NaN after the end of the run."""
    if not probes:
        return np.zeros((0, len(times)))
    t, pressures = run["probe_time"].values, run["probe_pressure"].values
    return np.array([np.interp(times, t, pressures[:, k], right=math.nan) for k in range(probes)])


def _order(spacings: list[float], errors: Array) -> float:
    """Return the observed order, NaN for fewer than two errors that are known and not zero."""
    known = np.isfinite(errors) & (errors > 0.0)
    return convergence_order(np.array(spacings)[known], errors[known]) if known.sum() > 1 else math.nan
