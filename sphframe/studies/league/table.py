"""Studies: the results of all methods on all benchmarks as one dataset."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from sphframe.analysis import convergence_order
from sphframe.arrays import Array
from sphframe.studies.league.entrants import Benchmarked, Method
from sphframe.studies.league.result import Outcome
from sphframe.studies.league.ties import ranks, relative_spread

Key = tuple[str, str, int, int]
"""method, benchmark, index of the particle spacing, seed"""
_OVER = ("method", "benchmark", "resolution", "repeat")
_NUMBERS = {
    "cost": ("us", "processor time per particle and step"),
    "particles": ("1", "fluid particles"),
    "energy_excess": ("1", "largest total energy over the first, -1"),
    "fallback": ("%", "wet ghosts that used the fallback"),
    "outside": ("1", "largest number of particles behind walls in a frame"),
}


def league_dataset(
    methods: Sequence[Method],
    benchmarks: Sequence[Benchmarked],
    resolutions: int,
    repeats: int,
    results: Mapping[Key, Mapping[str, Any]],
) -> xr.Dataset:
    """Return errors, ranks, orders, costs and outcomes over (method, benchmark, resolution, repeat).

    Parameters
    ----------
    resolutions, repeats
        numbers of particle spacings, and of runs at the coarsest of them.
    results
        attributes of the results, see :class:`ScoreTask`, for the runs that there are.

    Returns
    -------
    xr.Dataset
        ``error`` of each run; ``score``, the mean error at the finest spacing that a benchmark has, NaN where a run did
        not complete; ``spread``, relative, from the repeated runs at the coarsest; ``rank``, 0 where a method is not
        applicable; ``order`` of convergence; ``outcome`` and ``message``.
    """  # fmt: skip
    shape = (len(methods), len(benchmarks), resolutions, repeats)
    error, outcome = np.full(shape, np.nan), np.full(shape, "", dtype=object)
    message = np.full(shape, "", dtype=object)
    numbers = {name: np.full(shape, np.nan) for name in _NUMBERS}
    for i, method in enumerate(methods):
        for j, one in enumerate(benchmarks):
            for k in range(resolutions):
                for seed in range(repeats):
                    found = results.get((method.name, one.name, k, seed))
                    if found is None:
                        continue
                    place = (i, j, k, seed)
                    outcome[place], message[place] = found["outcome"], found["message"]
                    for name, values in numbers.items():
                        values[place] = found.get(name, math.nan)
                    if outcome[place] == Outcome.COMPLETED:
                        error[place] = found.get(f"error: {one.benchmark.score}", math.nan)
    dataset = xr.Dataset(
        {
            "error": (_OVER, error, {"units": "1", "long_name": "error by which methods are ranked"}),
            "outcome": (_OVER, outcome.astype(str), {"long_name": "how the run ended"}),
            "message": (_OVER, message.astype(str), {"long_name": "why it did not complete"}),
            **{
                name: (_OVER, numbers[name], {"units": unit, "long_name": meaning})
                for name, (unit, meaning) in _NUMBERS.items()
            },
            "particle_spacing": (
                ("benchmark", "resolution"),
                [[_get(one.benchmark.spacings, k) for k in range(resolutions)] for one in benchmarks],
                {"units": "m", "long_name": "particle spacing"},
            ),
        },
        coords={"method": [method.name for method in methods], "benchmark": [one.name for one in benchmarks]},
    )  # fmt: skip
    return dataset.assign(_scores(dataset, repeats))


def finest(spacing: Array) -> int:
    """Return the index of the finest of the particle spacings that a benchmark has; the others are NaN."""
    return int(np.flatnonzero(np.isfinite(spacing))[-1])


def _get(values: Sequence[float], index: int) -> float:
    return values[index] if index < len(values) else math.nan


def _scores(dataset: xr.Dataset, repeats: int) -> dict[str, Any]:
    over = ("method", "benchmark")
    shape = (dataset.sizes["method"], dataset.sizes["benchmark"])
    score, spread, order = (np.full(shape, np.nan) for _ in range(3))
    rank = np.zeros(shape, dtype=np.int64)
    for j in range(shape[1]):
        one = dataset.isel(benchmark=j)
        error, spacing = one["error"].values, one["particle_spacing"].values
        last = finest(spacing)
        score[:, j] = _mean(error[:, last], one["outcome"].values[:, last])
        spread[:, j] = relative_spread(error[:, 0])
        order[:, j] = [_order(spacing, row[:, 0]) for row in error]
        applicable = ~np.any(one["outcome"].values == Outcome.NOT_APPLICABLE, axis=(1, 2))
        rank[applicable, j] = ranks(score[applicable, j], spread[applicable, j], repeats)
    return {
        "score": (over, score, {"units": "1", "long_name": "mean error at the finest spacing"}),
        "spread": (over, spread, {"units": "1", "long_name": "standard deviation of a run over its error"}),
        "rank": (over, rank, {"units": "1", "long_name": "1 + number of methods that are significantly better"}),
        "order": (over, order, {"units": "1", "long_name": "observed order of convergence"}),
    }


def _mean(errors: Array, outcomes: Any) -> Array:
    """Return the mean (methods,) of ``errors`` (methods, repeats) over the runs made, NaN if one did not complete."""
    made = outcomes != ""
    counts = made.sum(axis=1)
    mean: Array = np.divide(
        np.where(made, errors, 0.0).sum(axis=1), counts, out=np.full(len(errors), np.nan), where=counts > 0
    )
    return mean


def _order(spacing: Array, errors: Array) -> float:
    known = np.isfinite(spacing) & np.isfinite(errors) & (errors > 0.0)
    return convergence_order(spacing[known], errors[known]) if known.sum() > 1 else math.nan
