"""Medians of measured times."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from sphframe_huang2019.cost.states import FIRST

__all__ = ["Medians", "disturbance", "growth", "medians"]

SPREAD = 0.2
"""largest distance of the quartiles over the median for which the claims are judged"""


@dataclass(frozen=True)
class Medians:
    """Medians of the times of one method on one state.

    Attributes
    ----------
    fill, step
        time of filling all ghosts once, and of one whole step, s.
    fill_ratio, step_ratio
        both over those of improved Shepard in the same repeat.
    fill_spread, step_spread
        distance of the quartiles over the median.
    points, neighbours
        wet ghosts, and their mean number of neighbours.
    """

    fill: float
    step: float
    fill_ratio: float
    step_ratio: float
    fill_spread: float
    step_spread: float
    points: float
    neighbours: float

    @property
    def per_point(self) -> float:
        """Time of the interpolation per point, us."""
        return 1e6 * self.fill / self.points

    @property
    def share(self) -> float:
        """Per cent of a step that the interpolation takes; a step fills the ghosts twice."""
        return 200.0 * self.fill / self.step


def medians(measured: xr.Dataset) -> dict[str, Medians]:
    """Return the medians by method."""
    first = measured.sel(interpolator=FIRST)
    found = {}
    for method in measured["interpolator"].values:
        own = measured.sel(interpolator=method)
        found[str(method)] = Medians(
            fill=float(own["fill"].median()),
            step=float(own["step"].median()),
            fill_ratio=float((own["fill"] / first["fill"]).median()),
            step_ratio=float((own["step"] / first["step"]).median()),
            fill_spread=_spread(own["fill"]),
            step_spread=_spread(own["step"]),
            points=float(own["points"]),
            neighbours=float(own["neighbours"]),
        )
    return found


def _spread(times: xr.DataArray) -> float:
    return float((times.quantile(0.75) - times.quantile(0.25)) / times.median())


def growth(by_ratio: Mapping[float, Mapping[str, Medians]], method: str) -> float:
    """Return the exponent b of time per point ~ neighbours^b, least squares over the ratios."""
    n = [found[method].neighbours for found in by_ratio.values()]
    t = [found[method].per_point for found in by_ratio.values()]
    return float(np.polyfit(np.log(n), np.log(t), 1)[0]) if len(n) > 1 else math.nan


def disturbance(runs: Iterable[xr.Dataset], measured: Iterable[Mapping[str, Medians]]) -> str | None:
    """Return why the claims cannot be judged by the times, or None if the machine had no other work."""
    busy = max(float(run.attrs["busy"]) for run in runs)
    spread = max(float(np.median([one.fill_spread for one in found.values()])) for found in measured)
    if spread < SPREAD:
        return None
    return (
        f"The machine had other work: the wall-clock time was up to {busy:.2f} times the processor's, and quartiles"
        f" were up to {100.0 * spread:.0f} % apart. Measure again on a quiet machine: remove the runs whose names begin"
        " with cost."
    )
