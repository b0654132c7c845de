"""CLI: ``sphframe reproduce``."""

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from sphframe.cli.run import console_log
from sphframe.cli.studies_progress import shown_progress
from sphframe.cli.values import listed
from sphframe.errors import InputError
from sphframe.studies import installed_study, reproduce


def reproduce_command(
    name: str | None,
    *,
    only: Sequence[str],
    quick: bool,
    reference: Path | None,
    workers: int | None,
    scheduler: str | None,
    output: Path | None,
) -> None:
    """Carry out the study ``name``, or the only one that is installed, and print where the report is."""
    study = installed_study(name)
    if output is None:
        raise InputError(f"give the folder for the report of {study.title!r}: --output DIR")
    with shown_progress(console_log()) as on_progress:
        report = reproduce(
            study,
            output=output,
            only=listed(only),
            quick=quick,
            reference=reference,
            workers=workers,
            scheduler=scheduler,
            on_progress=on_progress,
        )
    Console(markup=False, highlight=False, soft_wrap=True).print(f"wrote {report}", markup=False)
