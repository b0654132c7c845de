"""CLI: shows the progress of many runs."""

import time
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.progress import Progress as Bar

from sphframe.studies import Progress
from sphframe.studies.engine import ProgressListener

_LINE_EVERY = 60.0
"""s between lines about running tasks, where there is no terminal"""


@contextmanager
def shown_progress(log: Console) -> Iterator[ProgressListener]:
    """Yield a listener that shows the progress of all runs: a bar on a terminal, elsewhere a line per finished run.

    An interruption by the user is passed on, after a line that says how to continue.
    """
    try:
        if log.is_terminal:
            columns = (BarColumn(), TextColumn("{task.percentage:3.0f}% {task.description}"))
            with Bar(*columns, TimeElapsedColumn(), TimeRemainingColumn(), console=log, transient=True) as bar:
                yield _bar_listener(bar)
        else:
            yield _line_listener(log)
    except KeyboardInterrupt:
        log.print("finished runs are kept; repeat the command to continue")
        raise


def _bar_listener(bar: Bar) -> ProgressListener:
    task = bar.add_task("starting", total=1.0)

    def move(progress: Progress) -> None:
        bar.update(task, completed=progress.part, description=escape(_state(progress)))
        if progress.last is not None:
            bar.console.print(f"done: {progress.last}", markup=False)

    return move


def _line_listener(log: Console) -> ProgressListener:
    printed = time.monotonic()

    def print_line(progress: Progress) -> None:
        nonlocal printed
        if progress.last is not None:
            log.print(f"{progress.done} of {progress.total} done: {progress.last}", markup=False)
        elif progress.done == progress.kept and not progress.running:
            log.print(f"{progress.total} runs, {progress.kept} of them done before", markup=False)
        elif time.monotonic() - printed > _LINE_EVERY:
            log.print(f"{100.0 * progress.part:.0f}%  {_state(progress)}", markup=False)
        else:
            return
        printed = time.monotonic()

    return print_line


def _state(progress: Progress) -> str:
    running = ", ".join(f"{label} {100.0 * part:.0f}%" for label, part in sorted(progress.running.items()))
    return f"{progress.done} of {progress.total} runs" + (f"; {running}" if running else "")
