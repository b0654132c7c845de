"""Analysis: the progress display of a run."""

import time
from collections import deque
from collections.abc import Sequence
from datetime import timedelta
from importlib.util import find_spec

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn

from sphframe.analysis.summary import concerns
from sphframe.console import log_console
from sphframe.hooks import hookimpl
from sphframe.interfaces import RunView

_REFRESH = 0.1  # s
_WINDOW = 100  # refreshes over which rates are taken


class ProgressDisplay:
    """A hook plugin that shows step, simulated time, time step, rate, remaining time and warnings.

    Rate and remaining time are computed from the last ten seconds, so the compilation in the first step and the steps
    before a resumed run do not count. The warnings are those of :func:`sphframe.analysis.concerns`.

    On a terminal, and in a notebook with ``ipywidgets``, it is a bar; elsewhere, such as in a log file, it is a line
    for every tenth of the run. What cannot be displayed, because a pipe is closed or a disk full, is left out and never
    ends the run.

    Parameters
    ----------
    console
        where the display is printed; by default on the standard error stream.

    Examples
    --------
    ``sphframe.run`` shows it where it is a bar. To have its lines in a log file too::

        sphframe.run("dam-break", hooks=[sphframe.ProgressDisplay()])
    """

    def __init__(self, console: Console | None = None) -> None:
        self._console = console or log_console()
        self._progress: Progress | None = None
        self._task = TaskID(0)
        self._tenths = self._outside = 0
        self._seen: deque[tuple[float, int, float]] = deque(maxlen=_WINDOW)  # wall clock, step, simulated time

    @property
    def is_live(self) -> bool:
        """Whether it is a bar that moves, on a terminal or in a notebook with ``ipywidgets``."""
        if self._console.is_jupyter:
            return find_spec("ipywidgets") is not None
        return self._console.is_terminal

    @hookimpl
    def sphframe_run_started(self, simulation: RunView) -> None:
        """Show the bar."""
        self._tenths = int(10.0 * simulation.time / simulation.case.until)
        if self.is_live:
            self._progress = Progress(
                BarColumn(),
                TextColumn("{task.percentage:3.0f}%"),
                TextColumn("{task.description}", markup=False),
                TextColumn("{task.fields[warnings]}", style="yellow", markup=False),
                console=self._console,
                transient=True,
            )
            self._task = self._progress.add_task("starting", total=simulation.case.until, warnings="")
            self._progress.start()

    @hookimpl
    def sphframe_frame_due(self, simulation: RunView) -> None:
        """Count the particles behind walls, which takes too long for every step."""
        self._outside = simulation.particles_outside()

    @hookimpl
    def sphframe_step_completed(self, simulation: RunView) -> None:
        """Move the bar, or print a line."""
        now = time.monotonic()
        due = not self._seen or now - self._seen[-1][0] > _REFRESH
        if due:
            self._seen.append((now, simulation.step, simulation.time))
        if self._progress is not None:
            if due:
                state, warnings = self._state(simulation, now), "; ".join(self._warnings(simulation))
                self._progress.update(self._task, completed=simulation.time, description=state, warnings=warnings)
            return
        tenths = int(10.0 * simulation.time / simulation.case.until)
        if tenths > self._tenths:
            self._tenths = tenths
            parts = [f"{10 * tenths:3d}%  {self._state(simulation, now)}", *self._warnings(simulation)]
            self._console.print("; ".join(parts), markup=False)

    @hookimpl
    def sphframe_run_finished(self, simulation: RunView) -> None:
        """Remove the bar."""
        self._stop()

    @hookimpl
    def sphframe_run_failed(self, simulation: RunView, error: BaseException) -> None:
        """Remove the bar."""
        self._stop()

    def _stop(self) -> None:
        if self._progress is not None:
            self._progress.stop()

    def _state(self, simulation: RunView, now: float) -> str:
        until, step_length = simulation.case.until, f"dt = {simulation.time_step:.2e} s"
        text = f"step {simulation.step:,}, t = {simulation.time:.4g} of {until:.4g} s, {step_length}"
        began, step, then = self._seen[0]
        if simulation.step == step or now <= began:
            return text
        left = (until - simulation.time) * (now - began) / (simulation.time - then)
        return f"{text}, {(simulation.step - step) / (now - began):.0f} steps/s, {timedelta(seconds=round(left))} left"

    def _warnings(self, simulation: RunView) -> list[str]:
        return concerns(
            outside=self._outside,
            removed=simulation.removed_count,
            densities=simulation.densities_outside,
            statuses=simulation.status_counts(),
        )


def with_display(hooks: Sequence[object], *, always: bool) -> list[object]:
    """Return the hooks of a run, with a display unless they contain one or it would not be live.

    Parameters
    ----------
    always
        whether progress is also shown where it takes lines.
    """
    display = ProgressDisplay()
    shown = (always or display.is_live) and not any(isinstance(hook, ProgressDisplay) for hook in hooks)
    return [display, *hooks] if shown else [*hooks]
