"""CLI: what a run shows while it goes."""

import time
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn

from sphframe.hooks import hookimpl

__all__ = ["ProgressDisplay"]

_REFRESH = 0.1


class ProgressDisplay:
    """A hook plugin that shows step, simulated time, time step, speed and the time left.

    On a terminal a bar; elsewhere, such as in a log file, a line for every tenth of the run.

    Parameters
    ----------
    console: where to show it.
    """

    def __init__(self, console: Console) -> None:
        self._console = console
        self._progress: Progress | None = None
        self._task = TaskID(0)
        self._began = self._shown = 0.0
        self._tenths = 0

    @hookimpl
    def sphframe_run_started(self, simulation: Any) -> None:
        """Show the bar."""
        self._began = time.monotonic()
        if self._console.is_terminal:
            self._progress = Progress(
                BarColumn(),
                TextColumn("{task.percentage:3.0f}%"),
                TextColumn("{task.description}"),
                TimeRemainingColumn(),
                TextColumn("left"),
                console=self._console,
                transient=True,
            )
            self._task = self._progress.add_task("starting", total=simulation.case.until)
            self._progress.start()

    @hookimpl
    def sphframe_step_completed(self, simulation: Any) -> None:
        """Move the bar, or print a line."""
        now = time.monotonic()
        if self._progress is not None:
            if now - self._shown > _REFRESH:
                self._shown = now
                self._progress.update(self._task, completed=simulation.time, description=self._state(simulation))
            return
        tenths = int(10.0 * simulation.time / simulation.case.until)
        if tenths > self._tenths:
            self._tenths = tenths
            left = (now - self._began) * (simulation.case.until / simulation.time - 1.0)
            self._console.print(f"{10 * tenths:3d}%  {self._state(simulation)}, {left:.0f} s left")

    @hookimpl
    def sphframe_run_finished(self, simulation: Any) -> None:
        """Remove the bar."""
        self._stop()

    @hookimpl
    def sphframe_run_failed(self, simulation: Any, error: BaseException) -> None:
        """Remove the bar."""
        self._stop()

    def _stop(self) -> None:
        if self._progress is not None:
            self._progress.stop()

    def _state(self, simulation: Any) -> str:
        elapsed = max(time.monotonic() - self._began, 1e-9)
        return (
            f"step {simulation.step:,}, t = {simulation.time:.4g} of {simulation.case.until:.4g} s,"
            f" dt = {simulation.time_step:.2e} s, {simulation.step / elapsed:.0f} steps/s"
        )
