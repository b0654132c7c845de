"""CLI: ``sphframe evaluate``."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from sphframe.cli.values import allow_imports_from_here
from sphframe.interfaces import Status
from sphframe.registry import create
from sphframe.testing.judgement import Judgement, judge, judge_walls
from sphframe.testing.particle_files import read_particles, read_walls
from sphframe.testing.verification import parse_label


def evaluate_command(
    file: Path,
    methods: Sequence[str],
    *,
    kernel: str,
    smoothing_length: float | None,
    as_json: bool,
    reading: Mapping[str, Any],
    sample: int,
    walls: str | None = None,
    gravity: float | None = None,
) -> None:
    """Judge methods on the particles of a file, and at its walls; print a row for each."""
    allow_imports_from_here([*methods, kernel])
    particles = read_particles(file, **reading)
    common = {name: reading[name] for name in ("time", "fields") if name in reading}
    wall_points = read_walls(file, particles, walls=walls, gravity=gravity, **common)
    h = particles.length(smoothing_length)
    found = {}
    for label in methods:
        name, options = parse_label(label)
        method = create("interpolators", name, **options)
        given: dict[str, Any] = {"kernel": kernel, "smoothing_length": h, "sample": sample}
        found[label] = _figures(judge(method, particles, **given))
        if wall_points is not None:
            at_walls = judge_walls(method, particles, wall_points, **given)
            found[label]["walls"] = _figures_at_walls(at_walls)
    if as_json:
        print(json.dumps(found, indent=2))
        return
    console = Console(markup=False, highlight=False, soft_wrap=True)
    count, dim = particles.position.shape
    console.print(f"{file}: {count:,} particles in {dim}-D, spacing {particles.spacing:g} m, h = {h:g} m, {kernel}")
    console.print(_table(found, {"error inside": "error_inside", "error near edges": "error_near_edges"}))
    console.print(
        "each particle is left out and interpolated from the others: error over the root mean square of the pressure;"
        " noise: median of sqrt(sum Phi^2); gain: sum |Phi|"
    )
    if wall_points is not None:
        rows = {label: figures["walls"] for label, figures in found.items()}
        console.print(f"\n{next(iter(rows.values()))['wall_particles']:,} wall particles")
        console.print(_table(rows, {"error": "error", "mean error": "mean_error"}))
        console.print("the pressure there, with that of the water in between, less the stored one, in the same unit")


def _table(rows: Mapping[str, Mapping[str, Any]], errors: Mapping[str, str]) -> Table:
    table = Table(box=None, pad_edge=False)
    for heading in ("method", *errors, "noise", "largest gain", "statuses"):
        table.add_column(heading)
    for label, figures in rows.items():
        statuses = ", ".join(f"{name} {100 * share:.2f} %" for name, share in figures["statuses"].items() if share)
        numbers = (f"{figures[name]:.3g}" for name in (*errors.values(), "noise", "largest_gain"))
        table.add_row(Text(label), *numbers, statuses)
    return table


def _figures_at_walls(judgement: Judgement) -> dict[str, Any]:
    """Return the figures of a row at walls: those of wall particles that are not DRY but for the statuses."""
    wet = judgement.neighbours > 0
    return {
        "wall_particles": len(wet),
        "error": judgement.distance(wet),
        "mean_error": float(judgement.error[wet].mean() / judgement.scale) if wet.any() else float("nan"),
        "noise": float(np.median(judgement.noise[wet])) if wet.any() else float("nan"),
        "largest_gain": float(judgement.gain.max()),
        "statuses": {status.name: judgement.share(status) for status in Status},
    }


def _figures(judgement: Judgement) -> dict[str, Any]:
    """Return the figures of a row as plain data."""
    return {
        "particles": len(judgement.status),
        "error_inside": judgement.distance(judgement.inside),
        "error_near_edges": judgement.distance(~judgement.inside),
        "noise": float(np.median(judgement.noise)),
        "largest_gain": float(judgement.gain.max()),
        "largest_deviation_of_sum": float(np.abs(judgement.total[judgement.neighbours > 0] - 1.0).max(initial=0.0)),
        "statuses": {status.name: judgement.share(status) for status in Status},
        "neighbours": [int(judgement.neighbours.min()), int(judgement.neighbours.max())],
    }
