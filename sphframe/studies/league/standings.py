"""Studies: how the methods of the league table stand over all benchmarks."""

import math
from typing import NamedTuple

import numpy as np
import xarray as xr


class Standing(NamedTuple):
    """A method over all benchmarks: its median rank, and numbers of benchmarks.

    ``best``: on which no other method is better by more than the spread; ``cost``: median of the processor time per
    particle and step, over that of the cheapest method.
    """

    median_rank: float
    best: int
    completed: int
    failed: int
    not_applicable: int
    cost: float


def standings(dataset: xr.Dataset) -> dict[str, Standing]:
    """Return the standing of each method of a league dataset, the lowest median rank first."""
    cost = dataset["cost"].isel(resolution=0, repeat=0)
    ratio = (cost / cost.min("method")).values
    found = {}
    for k, method in enumerate(dataset["method"].values):
        rank, completed = dataset["rank"].values[k], np.isfinite(dataset["score"].values[k])
        applies = rank > 0
        found[str(method)] = Standing(
            float(np.median(rank[applies])) if applies.any() else math.inf,
            int(np.sum(completed & (rank == 1))),
            int(np.sum(completed & applies)),
            int(np.sum(~completed & applies)),
            int(np.sum(~applies)),
            float(np.nanmedian(ratio[k])) if np.isfinite(ratio[k]).any() else math.nan,
        )
    return dict(sorted(found.items(), key=lambda one: (one[1].median_rank, one[0])))
