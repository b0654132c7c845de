"""Studies: the pages of the league table: the matrix, a page for each benchmark and for each method."""

import inspect
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from sphframe.studies.chapter import Picture
from sphframe.studies.league.drawing import curves, particles
from sphframe.studies.league.entrants import Benchmarked, Method
from sphframe.studies.league.result import Outcome
from sphframe.studies.league.standings import Standing
from sphframe.studies.league.table import Key, finest
from sphframe.studies.league.ties import ROUND_OFF
from sphframe.studies.report import render, write_file

_BEST, _MIDDLE, _WORST = (143, 208, 196), (255, 255, 255), (242, 178, 122)
"""colours of the best error, of one ten times, and of one a hundred times as large"""


class Cell(NamedTuple):
    """A method on a benchmark: ``text`` and ``colour`` in the matrix, ``value`` to sort by, and figures in words."""

    text: str
    value: float
    colour: str
    note: str
    rank: int
    error: float
    spread: float
    order: float
    cost: float


def write_pages(
    folder: Path,
    dataset: xr.Dataset,
    standing: Mapping[str, Standing],
    methods: Sequence[Method],
    benchmarks: Sequence[Benchmarked],
    results: Mapping[Key, xr.Dataset],
    facts: Mapping[str, str],
) -> Path:
    """Write the pages, their figures, ``table.csv`` and ``table.md`` into ``folder``; return the path of the first.

    Raises
    ------
    InputError
        jinja2 or matplotlib is not installed.
    OutputError
        a file cannot be written.
    """
    cells = {(m.name, b.name): _cell(dataset, m.name, b.name) for m in methods for b in benchmarks}
    by_name = {method.name: method for method in methods}
    ordered = [by_name[name] for name in standing]
    common = {
        "methods": ordered,
        "benchmarks": benchmarks,
        "cells": cells,
        "standings": standing,
        "facts": facts,
        "repeats": int(dataset.attrs["repeats"]),
        "quick": dataset.attrs["quick"] == "yes",
        "winners": {one.name: _winners(cells, ordered, one.name) for one in benchmarks},
    }
    for one in benchmarks:
        figures = _figures(folder, one, ordered, cells, results)
        text = inspect.getdoc(one.model) or ""
        _page(
            folder,
            f"benchmark-{one.name}",
            "league_benchmark",
            {**common, "one": one, "figures": figures, "text": text},
        )
    for method in methods:
        placed = sorted(benchmarks, key=lambda one: (_share(cells, methods, method.name, one.name), one.name))
        _page(folder, f"method-{method.name}", "league_method", {**common, "method": method, "placed": placed})
    write_file(folder / "table.csv", _csv(dataset).encode())
    write_file(folder / "table.md", render("league.md.j2", common).encode())
    return _page(folder, "index", "league", common)


def _page(folder: Path, name: str, template: str, content: Mapping[str, Any]) -> Path:
    path = folder / f"{name}.html"
    write_file(path, render(f"{template}.html.j2", content).encode())
    return path


def _cell(dataset: xr.Dataset, method: str, benchmark: str) -> Cell:
    """Return what the matrix shows of a method on a benchmark."""
    column = dataset.sel(benchmark=benchmark)
    one = column.sel({"method": method})
    outcomes, messages = one["outcome"].values, one["message"].values
    cost = float(np.nanmean(one["cost"].values)) if np.isfinite(one["cost"].values).any() else math.nan
    error, rank = float(one["score"]), int(one["rank"])
    figures = (rank, error, float(one["spread"]), float(one["order"]), cost)
    for outcome, text in ((Outcome.NOT_APPLICABLE, "n/a"), (Outcome.BROKEN, "broken"), (Outcome.STOPPED, "fails")):
        if (outcomes == outcome).any():
            note = str(messages[outcomes == outcome][0])
            grey = "#eeeeee" if outcome == Outcome.NOT_APPLICABLE else "#d9a0a0"
            return Cell(text, math.inf if outcome == Outcome.NOT_APPLICABLE else 1e300, grey, note, *figures)
    best = float(np.nanmin(column["score"].values)) if np.isfinite(column["score"].values).any() else math.nan
    spacing = float(one["particle_spacing"][finest(one["particle_spacing"].values)])
    note = f"rank {rank} at a particle spacing of {spacing:g} m"
    if math.isnan(error):
        return Cell("-", math.inf, "#eeeeee", "the run gave no error", *figures)
    return Cell(percent(error), error, _colour(error, best), note, *figures)


def percent(error: float) -> str:
    """Return an error in per cent with two digits.

    >>> percent(0.0123), percent(0.5), percent(0.00004), percent(12.0)
    ('1.2', '50', '0.004', '1200')
    """
    value = 100.0 * error
    if error < ROUND_OFF or value >= 10.0:
        return f"{value:.0f}"
    return f"{value:.{max(1 - math.floor(math.log10(value)), 1)}f}".rstrip("0").rstrip(".")


def _colour(error: float, best: float) -> str:
    """Return the background of an error, by its ratio to the best one."""
    ratio = math.log10(max(error, ROUND_OFF) / max(best, ROUND_OFF))
    one, two, share = (_BEST, _MIDDLE, ratio) if ratio < 1.0 else (_MIDDLE, _WORST, min(ratio - 1.0, 1.0))
    return "#" + "".join(f"{round(a + share * (b - a)):02x}" for a, b in zip(one, two, strict=True))


def _share(cells: Mapping[tuple[str, str], Cell], methods: Sequence[Method], method: str, benchmark: str) -> float:
    """Return the rank of a method over the number of methods that are ranked; behind all where there is none."""
    ranked = sum(cells[other.name, benchmark].rank > 0 for other in methods)
    rank = cells[method, benchmark].rank
    return rank / ranked if rank else 2.0


def _winners(cells: Mapping[tuple[str, str], Cell], methods: Sequence[Method], benchmark: str) -> list[str]:
    """Return the methods that no other beats by more than the spread."""
    own = {method.name: cells[method.name, benchmark] for method in methods}
    return [name for name, cell in own.items() if cell.rank == 1 and math.isfinite(cell.error)]


def _figures(
    folder: Path,
    one: Benchmarked,
    methods: Sequence[Method],
    cells: Mapping[tuple[str, str], Cell],
    results: Mapping[Key, xr.Dataset],
) -> list[Picture]:
    """Draw the coarsest run of each method beside the exact solution, and the last frame of the best one."""
    runs = {m.name: results[m.name, one.name, 0, 0] for m in methods if (m.name, one.name, 0, 0) in results}
    figures = [curves(one.name, runs)]
    best = min(runs, key=lambda name: cells[name, one.name].value, default=None)
    if best is not None and "position" in runs[best]:
        figures.append(particles(one.name, best, runs[best], one.benchmark.spacings[0]))
    drawn = [figure for figure in figures if figure is not None]
    for figure in drawn:
        write_file(folder / "figures" / f"{figure.name}.{figure.suffix}", figure.content)
    return drawn


def _csv(dataset: xr.Dataset) -> str:
    """Return one line for each run."""
    frame = dataset[[name for name in dataset.data_vars if dataset[name].ndim == 4]].to_dataframe().reset_index()
    spacing = dataset["particle_spacing"].to_dataframe().reset_index()
    merged = frame[frame["outcome"] != ""].merge(spacing, on=["benchmark", "resolution"])
    return str(merged.to_csv(index=False, float_format="%.6g", lineterminator="\n"))
