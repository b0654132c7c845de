"""Pressures at the sensor: computed, measured and published series, read by the same rules."""

import math
from collections.abc import Mapping

import numpy as np
import xarray as xr

from sphframe import InputError
from sphframe.analysis import pressure_scale, running_mean, series_error, time_scale
from sphframe.studies import Cell, Reference, Table
from sphframe_huang2019.dam_break.runs import BEST, VARIANTS, label
from sphframe_huang2019.variants import PAPER

__all__ = [
    "EXPERIMENTS",
    "SENSORS",
    "events",
    "goal",
    "measured_series",
    "rms_difference",
    "sensor_pressure",
    "sensor_tables",
]

EXPERIMENTS = {"buchner2002_P1": "Buchner, digitisation 1", "buchner2002_P1_second": "Buchner, digitisation 2"}
SIMULATION = "marrone2011_P1_simulation"
SENSORS = {"P1": "as in the experiment, 0.267 H", "P1-shifted": "shifted by Greco, 0.192 H"}
WINDOW = 0.1
"""width of the running mean that takes out acoustic waves, over sqrt(H/g)"""
COMPARED = slice(2.4, 6.0)
"""t sqrt(g/H) of the comparison with the experiment"""


def measured_series(reference: Reference) -> dict[str, xr.DataArray]:
    """Return the digitised pressures of the experiment that are given, by name."""
    return {name: _single_valued(s) for name in EXPERIMENTS if (s := reference.get(name)) is not None}


def sensor_pressure(dataset: xr.Dataset, probe: str) -> xr.DataArray:
    """Return the pressure at a sensor, running mean, in units of rho g H over t sqrt(g/H)."""
    t = dataset["probe_time"].values / time_scale(dataset)
    p = dataset["probe_pressure"].sel(probe=probe).values / pressure_scale(dataset)
    return running_mean(t, p, WINDOW, 0.01)


def events(series: xr.DataArray) -> dict[str, float]:
    """Return arrival, peaks and plateau of a measured or computed pressure at the sensor; NaN if it ends too early."""
    t, p = series["t"].values, series.values
    first, plateau, second = (series.sel(t=slice(*w)) for w in ((2.4, 3.2), (3.2, 4.8), (5.0, 7.0)))
    there = np.flatnonzero((p > 0.1) & (t > 2.0))
    return {
        "arrival": float(t[there[0]]) if there.size else math.nan,
        "first peak": float(first.max()) if first.size else math.nan,
        "at": float(first["t"][int(np.argmax(first.values))]) if first.size else math.nan,
        "plateau": float(plateau.mean()) if plateau.size and t[-1] >= 4.8 else math.nan,
        "plateau, deviation": float(plateau.std()) if plateau.size and t[-1] >= 4.8 else math.nan,
        "second peak": float(second.max()) if second.size else math.nan,
        "second peak at": float(second["t"][int(np.argmax(second.values))]) if second.size else math.nan,
    }


def rms_difference(series: xr.DataArray, experiment: xr.DataArray | None, at_points: bool = False) -> float:
    """Return the RMS difference over the compared times, or ``at_points`` that were digitised; NaN for short runs."""
    if experiment is None or not series.size or float(series["t"][-1]) < COMPARED.stop - 0.1:
        return math.nan
    try:
        if not at_points:
            t = np.linspace(COMPARED.start, COMPARED.stop, 361)
            experiment = xr.DataArray(np.interp(t, experiment["t"], experiment), coords={"t": t})
        return series_error(series, experiment.sel(t=COMPARED))["rms"]
    except InputError:
        return math.nan


def _rms_differences(series: xr.DataArray, experiments: Mapping[str, xr.DataArray]) -> dict[str, Cell]:
    """Return the RMS differences from the digitisations, by both rules."""
    found: dict[str, Cell] = {}
    for rule, at_points in (("RMS to digitisation", False), ("RMS at its points,", True)):
        for k, experiment in enumerate(experiments.values(), start=1):
            found[f"{rule} {k}"] = rms_difference(series, experiment, at_points)
    return found


def _single_valued(series: xr.DataArray) -> xr.DataArray:
    """Return a digitised series with one value at each time."""
    t, first = np.unique(series["t"].values, return_index=True)
    return xr.DataArray(series.values[first], coords={"t": t})


def sensor_tables(
    runs: Mapping[str, xr.Dataset], reference: Reference, experiments: Mapping[str, xr.DataArray]
) -> list[Table]:
    """Return a table of the pressures at each place of the sensor, and one of published simulations."""
    measured: list[dict[str, Cell]] = [
        {"boundary": EXPERIMENTS[name], **events(series)} for name, series in experiments.items()
    ]
    tables = []
    for probe, place in SENSORS.items():
        computed = {v.label: sensor_pressure(runs[label(v)], probe) for v in VARIANTS}
        rows: list[dict[str, Cell]] = [
            {"boundary": name, **events(series), **_rms_differences(series, experiments)}
            for name, series in computed.items()
        ]
        tables.append(
            Table(
                f"dam_break_{probe.lower().replace('-', '_')}",
                f"Pressure at the sensor {place}: times t sqrt(g/H), pressures over rho g H",
                [*measured, *rows],
            )
        )
    return [*tables, _published_table(reference, experiments)]


def _published_table(reference: Reference, experiments: Mapping[str, xr.DataArray]) -> Table:
    """Return the same figures of the published delta-SPH simulations."""
    rows: list[dict[str, Cell]] = []
    for column, resolution in ((2, "H/40"), (4, "H/80"), (3, "H/320")):
        series = reference.get(SIMULATION, column)
        if series is None:
            break
        row: dict[str, Cell] = {"simulation": f"delta-SPH, {resolution} (Marrone et al. 2011)"}
        even = _single_valued(series)
        row |= events(even) | _rms_differences(even, experiments)
        rows.append(row)
    return Table("dam_break_published", "Published simulations of the same experiment, read by the same rules", rows)


def goal(runs: Mapping[str, xr.Dataset], experiments: Mapping[str, xr.DataArray]) -> str:
    """Return sentences that compare the RMS differences with the goals of this project."""
    if not experiments:
        return "The goals of the RMS difference to the experiment cannot be checked: no reference series were given."
    parts = []
    for probe, place in SENSORS.items():
        worst = {
            v: max(rms_difference(sensor_pressure(runs[label(v)], probe), e) for e in experiments.values())
            for v in VARIANTS
        }
        known = {v: r for v, r in worst.items() if not math.isnan(r)}
        if known:
            best = min(known, key=lambda v: known[v])
            shepard = known.get(BEST, math.nan)
            parts.append(
                f"sensor {place}: best {known[best]:.3f} ({best.label}), improved Shepard balanced {shepard:.3f},"
                f" mirror {known.get(PAPER[0], math.nan):.3f}"
            )
    return (
        "Goal: an RMS difference of 0.13 rho g H or less with the best method, as published delta-SPH at H/80 to H/320,"
        " and never above 0.3 with improved Shepard. The larger of both digitisations: " + "; ".join(parts) + "."
    )
