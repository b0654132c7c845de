"""Studies: the error by which a comparison judges its runs, and in words what it is."""

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from sphframe.analysis import pressure_scale, rest_pressure, running_mean


class ErrorMeasure(NamedTuple):
    """How the error of a run is measured.

    Attributes
    ----------
    meaning
        what it is, in words.
    units
        1 or Pa.
    of
        function of a run that was completed, of its summary, and of the run of the same method at the finest spacing;
        returns the error, NaN where there is nothing to compare with.
    """

    meaning: str
    units: str
    of: Callable[[xr.Dataset, Mapping[str, Any], xr.Dataset], float]


def error_measure(
    first: xr.Dataset, figures: Mapping[str, Any], reference: xr.DataArray | None, probe: str | None
) -> ErrorMeasure:
    """Return how the errors of runs of one case are measured.

    The error is that from ``reference`` if it is given; else the first of the errors of a case with an exact solution;
    else the difference of the pressures at the probes from the state of rest, for ``hydrostatic-tank``, or from the
    run at the finest spacing.

    Parameters
    ----------
    first, figures
        one of the runs, and its :func:`sphframe.analysis.summary`.
    reference
        series of p/(rho g H) over t sqrt(g/H), or None.
    probe
        the probe to compare with it; None if the case has no probe.
    """
    units, over = ("1", " over rho g H") if pressure_scale(first) else ("Pa", "")
    pressures = f"RMS difference of probe pressures{over} from the"
    if reference is not None:
        return ErrorMeasure(
            f"{pressures} reference series",
            units,
            lambda run, *_: (
                math.nan if probe is None else float(run.sph.error("probe_pressure", reference, probe=probe)["rms"])
            ),
        )
    if "errors" in figures:
        name = next(iter(figures["errors"]), "error")
        return ErrorMeasure(f"difference from the exact solution: {name}", "1", _from_exact)
    if probe is None:
        return ErrorMeasure("not known: the case has neither probes nor an exact solution", "1", lambda *_: math.nan)
    if first.attrs["case_name"] == "hydrostatic-tank":
        return ErrorMeasure(f"{pressures} state of rest", units, _from_rest)
    return ErrorMeasure(f"{pressures} finest spacing of the same method", units, _from_finest)


def _from_exact(_: xr.Dataset, figures: Mapping[str, Any], __: xr.Dataset) -> float:
    return float(next(iter(figures.get("errors", {}).values()), math.nan))


def _from_rest(run: xr.Dataset, *_: object) -> float:
    """Return the difference over the second half of the run."""
    late = run["probe_pressure"].values[run["probe_time"].values >= 0.5 * float(run["probe_time"][-1])]
    difference = late - rest_pressure(run, run["probe_y"].values)
    return float(np.sqrt(np.mean(difference**2))) / (pressure_scale(run) or 1.0)


def _from_finest(run: xr.Dataset, _: Mapping[str, Any], finest: xr.Dataset) -> float:
    """Return the difference of running means over a hundredth of the run; NaN for the run at the finest spacing."""
    if run is finest or finest.attrs["completed"] != "yes":
        return math.nan
    t, window = run["probe_time"].values, 0.01 * float(run["probe_time"][-1])
    squares = []
    for own, other in zip(run["probe_pressure"].values.T, finest["probe_pressure"].values.T, strict=True):
        one = running_mean(t, own, window, 0.2 * window)
        two = running_mean(finest["probe_time"].values, other, window, 0.2 * window)
        squares.append(np.mean((one.values - np.interp(one["t"], two["t"], two)) ** 2))
    return float(np.sqrt(np.mean(squares))) / (pressure_scale(run) or 1.0)
