"""Studies: peaks and impulses of repeated runs, their 95 % bands, and which methods differ by more."""

import itertools
import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from scipy import stats

from sphframe.analysis import running_mean
from sphframe.arrays import Array
from sphframe.studies.chapter import Cell, Table

CONFIDENCE = 0.95
"""level of the bands, and at which two methods are said to differ"""
JITTER = 0.02
"""largest displacement of the particles at the start of repeated runs, over the particle spacing"""
_OVER = ("interpolator", "particle_spacing", "repeat", "probe")
_QUANTITIES = {"peak": ("Pa", "largest pressure"), "impulse": ("Pa s", "time integral of the pressure")}


def displaced(seed: int) -> dict[str, Any]:
    """Return the parameters of a repeated run; the first one, ``seed`` 0, starts from the lattice."""
    return {"jitter": JITTER, "seed": seed} if seed else {}


def ensemble_variables(runs: Mapping[tuple[str, float, int], xr.Dataset]) -> dict[str, Any]:
    """Return ``peak`` and ``impulse`` of each probe in each run, over (interpolator, particle_spacing, repeat, probe).

    The peak is that of the running mean over a hundredth of the run; NaN for a run that was stopped.

    Parameters
    ----------
    runs
        by method, particle spacing (m) and number of the repeat.
    """
    methods, spacings, repeats = (list(dict.fromkeys(names)) for names in zip(*runs, strict=True))
    probes = next(iter(runs.values())).sizes.get("probe", 0)
    found = np.array(
        [[[_peaks_and_impulses(runs[m, s, r], probes) for r in repeats] for s in spacings] for m in methods]
    ).reshape(len(methods), len(spacings), len(repeats), probes, 2)
    return {
        name: (_OVER, found[..., k], {"units": unit, "long_name": f"{meaning} at the probe"})
        for k, (name, (unit, meaning)) in enumerate(_QUANTITIES.items())
    }


def _peaks_and_impulses(run: xr.Dataset, probes: int) -> Array:
    """Return (probes, 2)."""
    if run.attrs["completed"] != "yes":
        return np.full((probes, 2), np.nan)
    t = run["probe_time"].values
    rows = []
    for k in range(probes):
        series = run["probe_pressure"].values[:, k]
        smooth = running_mean(t, series, 0.01 * t[-1], 0.002 * t[-1])
        rows.append((float(smooth.max()), float(np.trapezoid(series, t))))
    return np.array(rows).reshape(probes, 2)


def half_width(values: Array) -> float:
    """Return the half width of the 95 % confidence interval of the mean of ``values``, by Student's t.

    >>> round(half_width(np.array([1.0, 2.0, 3.0])), 3)
    2.484
    """
    n = len(values)
    if n < 2:
        return math.nan
    return float(stats.t.ppf(0.5 * (1.0 + CONFIDENCE), n - 1) * np.std(values, ddof=1) / math.sqrt(n))


def band_table(dataset: xr.Dataset) -> Table:
    """Return mean and half width of the 95 % band of each quantity, by method, spacing and probe."""
    rows: list[dict[str, Cell]] = []
    for method, spacing, probe in itertools.product(
        dataset["interpolator"].values, dataset["particle_spacing"].values, dataset["probe"].values
    ):
        one = dataset.sel(interpolator=method, particle_spacing=spacing, probe=probe)
        row: dict[str, Cell] = {"method": str(method), "particle spacing (m)": float(spacing), "probe": str(probe)}
        for name, (unit, _) in _QUANTITIES.items():
            values = one[name].values
            row[f"{name} ({unit})"] = float(values.mean())
            row[f"{name} +- ({unit})"] = half_width(values)
        rows.append(row)
    return Table("bands", "Means of the repeated runs, and half widths of their 95 % confidence intervals", rows)


def difference_table(dataset: xr.Dataset) -> Table:
    """Return the pairs of methods at the finest spacing, and whether they differ significantly (Welch's t-test)."""
    rows: list[dict[str, Cell]] = []
    finest = dataset.isel(particle_spacing=-1)
    for one, other in itertools.combinations(dataset["interpolator"].values, 2):
        for probe, (name, (unit, _)) in itertools.product(dataset["probe"].values, _QUANTITIES.items()):
            first, second = (finest[name].sel(interpolator=m, probe=probe).values for m in (one, other))
            difference = float(second.mean() - first.mean())
            with np.errstate(invalid="ignore", divide="ignore"):
                chance = float(stats.ttest_ind(first, second, equal_var=False).pvalue)
            verdict = "unknown" if math.isnan(chance) else "yes" if chance < 1.0 - CONFIDENCE else "no"
            rows.append(
                {
                    "methods": f"{one}, {other}",
                    "probe": str(probe),
                    "quantity": f"{name} ({unit})",
                    "difference": difference,
                    "p": chance,
                    "significant": verdict,
                }
            )
    return Table("differences", "Differences between methods at the finest spacing (second minus first)", rows)
