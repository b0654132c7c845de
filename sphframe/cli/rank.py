"""CLI: ``sphframe rank``."""

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from sphframe.cli.run import console_log
from sphframe.cli.studies_progress import shown_progress
from sphframe.cli.values import listed
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
    with shown_progress(console_log()) as on_progress:
        league = rank(
            output=output,
            methods=listed(methods),
            benchmarks=listed(benchmarks),
            quick=quick,
            repeats=repeats,
            workers=workers,
            scheduler=scheduler,
            on_progress=on_progress,
        )
    screen = Console(markup=False, highlight=False, soft_wrap=True)
    screen.print(_table(league))
    screen.print(f"wrote {league.page}", markup=False)


def _table(league: League) -> Table:
    table = Table(box=None, pad_edge=False)
    for head in ("method", "median rank", "first or tied", "completed", "not applicable"):
        table.add_column(head)
    for method, own in league.standings.items():
        completed = f"{own.completed} of {own.completed + own.failed}"
        table.add_row(Text(method), f"{own.median_rank:g}", str(own.best), completed, str(own.not_applicable))
    return table
