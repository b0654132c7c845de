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
from sphframe.testing.judgement import Judgement, judge
from sphframe.testing.particle_files import read_particles
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
) -> None:
    """Judge methods on the particles of a file; print a row for each."""
    allow_imports_from_here([*methods, kernel])
    particles = read_particles(file, **reading)
    h = particles.length(smoothing_length)
    found = {}
    for label in methods:
        name, options = parse_label(label)
        found[label] = judge(
            create("interpolators", name, **options), particles, kernel=kernel, smoothing_length=h, sample=sample
        )
    if as_json:
        print(json.dumps({label: _figures(judgement) for label, judgement in found.items()}, indent=2))
        return
    console = Console(markup=False, highlight=False, soft_wrap=True)
    count, dim = particles.position.shape
    console.print(f"{file}: {count:,} particles in {dim}-D, spacing {particles.spacing:g} m, h = {h:g} m, {kernel}")
    table = Table(box=None, pad_edge=False)
    for heading in ("method", "error inside", "error near edges", "noise", "largest gain", "statuses"):
        table.add_column(heading)
    for label, judgement in found.items():
        figures = _figures(judgement)
        statuses = ", ".join(f"{name} {100 * share:.2f} %" for name, share in figures["statuses"].items() if share)
        numbers = (f"{figures[name]:.3g}" for name in ("error_inside", "error_near_edges", "noise", "largest_gain"))
        table.add_row(Text(label), *numbers, statuses)
    console.print(table)
    console.print(
        "each particle is left out and interpolated from the others: error over the root mean square of the pressure;"
        " noise: median of sqrt(sum Phi^2); gain: sum |Phi|"
    )


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
