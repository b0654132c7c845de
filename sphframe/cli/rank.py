"""CLI: ``sphframe rank``."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from sphframe.cli.run import console_log
from sphframe.cli.studies_progress import shown_progress
from sphframe.studies.league import League, rank


def rank_command(
    *,
    output: Path,
    methods: Sequence[str],
    benchmarks: Sequence[str],
    quick: bool,
    repeats: int | None,
    workers: int | None,
    scheduler: str | None,
) -> None:
    """Make the league table, and print the standings and where the pages are."""
    log = console_log()
    try:
        with shown_progress(log) as on_progress:
            league = rank(
                output=output,
                methods=_names(methods),
                benchmarks=_names(benchmarks),
                quick=quick,
                repeats=repeats,
                workers=workers,
                scheduler=scheduler,
                on_progress=on_progress,
            )
    except KeyboardInterrupt:
        log.print("finished runs are kept; repeat the command to continue")
        raise
    screen = Console(markup=False, highlight=False, soft_wrap=True)
    screen.print(_standings(league))
    screen.print(f"wrote {league.page}", markup=False)


def _names(given: Sequence[str]) -> list[str]:
    return [name for text in given for name in text.split(",") if name]


def _standings(league: League) -> Table:
    table = Table(box=None, pad_edge=False)
    for head in ("method", "median rank", "first or tied", "completed", "not applicable"):
        table.add_column(head)
    rows = []
    for method in league.dataset["method"].values:
        own = league.dataset.sel({"method": method})
        rank_, score = own["rank"].values, own["score"].values
        applies = rank_ > 0
        median = float(np.median(rank_[applies])) if applies.any() else np.inf
        completed = int(np.isfinite(score[applies]).sum())
        first = int(((rank_ == 1) & np.isfinite(score)).sum())
        counts = (first, f"{completed} of {int(applies.sum())}", int((~applies).sum()))
        rows.append((median, str(method), counts))
    for median, name, numbers in sorted(rows):
        table.add_row(Text(name), f"{median:g}", *(str(number) for number in numbers))
    return table
