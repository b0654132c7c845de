"""CLI: ``sphframe reproduce``, and the display of the progress of many runs."""

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.progress import Progress as Bar

from sphframe.cli.run import console_log
from sphframe.errors import InputError
from sphframe.studies import Progress, installed_study, reproduce
from sphframe.studies.engine import Watch

__all__ = ["reproduce_command", "shown_progress"]

_LINE_EVERY = 60.0
"""s between lines about the running tasks, where there is no terminal"""


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
    log = console_log()
    try:
        with shown_progress(log) as watch:
            report = reproduce(
                study,
                output=output,
                only=[section for given in only for section in given.split(",") if section],
                quick=quick,
                reference=reference,
                workers=workers,
                scheduler=scheduler,
                watch=watch,
            )
    except KeyboardInterrupt:
        log.print("finished runs are kept; repeat the command to continue")
        raise
    Console(highlight=False, soft_wrap=True).print(f"wrote {report}", markup=False)


@contextmanager
def shown_progress(log: Console) -> Iterator[Watch]:
    """Show the progress of all runs: on a terminal a bar, elsewhere a line for each finished run."""
    if log.is_terminal:
        columns = (BarColumn(), TextColumn("{task.percentage:3.0f}% {task.description}"))
        with Bar(*columns, TimeElapsedColumn(), TimeRemainingColumn(), console=log, transient=True) as bar:
            task = bar.add_task("starting", total=1.0)

            def move(progress: Progress) -> None:
                bar.update(task, completed=progress.part, description=escape(_state(progress)))
                if progress.last is not None:
                    bar.console.print(f"done: {progress.last}", markup=False)

            yield move
        return
    told = time.monotonic()

    def tell(progress: Progress) -> None:
        nonlocal told
        if progress.last is not None:
            log.print(f"{progress.done} of {progress.total} done: {progress.last}", markup=False)
        elif progress.done == progress.kept and not progress.running:
            log.print(f"{progress.total} runs, {progress.kept} of them finished before", markup=False)
        elif time.monotonic() - told > _LINE_EVERY:
            log.print(f"{100.0 * progress.part:.0f}%  {_state(progress)}", markup=False)
        else:
            return
        told = time.monotonic()

    yield tell


def _state(progress: Progress) -> str:
    running = ", ".join(f"{label} {100.0 * part:.0f}%" for label, part in sorted(progress.running.items()))
    return f"{progress.done} of {progress.total} runs" + (f"; {running}" if running else "")
