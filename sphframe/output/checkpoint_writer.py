"""Output: the hook plugin that writes checkpoints beside the output of a run."""

import time
from typing import final

from sphframe.errors import InputError, OutputError
from sphframe.hooks import hookimpl
from sphframe.interfaces import ResumableRun
from sphframe.output.checkpoint import checkpoint_path, write_checkpoint
from sphframe.output.writer import NetCDFWriter


@final
class CheckpointWriter:
    """A hook plugin that writes checkpoints beside the output of ``writer``.

    A checkpoint is also written when the run is interrupted, or any other error ends it between two steps, and it is
    removed when the run is complete. No checkpoint is written when the guards stop the run in a step: the last one
    before remains.

    Parameters
    ----------
    writer
        writes the output; it must receive every event before the checkpoint writer does.
    every
        wall-clock time between checkpoints, s; None for none.
    interval
        simulated time between checkpoints, s; None for none.

    Raises
    ------
    InputError
        when an interval is not positive.
    """

    def __init__(self, writer: NetCDFWriter, *, every: float | None = 60.0, interval: float | None = None) -> None:
        for name, value in (("every", every), ("interval", interval)):
            if value is not None and not (0.0 < value < float("inf")):
                raise InputError(f"checkpoints: {name} = {value:g} s must be a positive number of seconds")
        self.path = checkpoint_path(writer.path)
        self.saved_time: float | None = None
        """simulated time of the last checkpoint written, s"""
        self._writer = writer
        self._every, self._interval = every, interval
        self._written_at = time.monotonic()
        self._due = 0.0

    @hookimpl
    def sphframe_run_started(self, simulation: ResumableRun) -> None:
        """Start measuring the time to the first checkpoint."""
        self._written_at = time.monotonic()
        self._set_due(simulation.time)

    @hookimpl
    def sphframe_step_completed(self, simulation: ResumableRun) -> None:
        """Write a checkpoint when one is due."""
        by_clock = self._every is not None and time.monotonic() - self._written_at >= self._every
        if by_clock or (self._interval is not None and simulation.time >= self._due):
            self.write(simulation)

    @hookimpl
    def sphframe_run_finished(self, simulation: ResumableRun) -> None:
        """Remove the checkpoint: the run is complete."""
        self.path.unlink(missing_ok=True)

    @hookimpl
    def sphframe_run_failed(self, simulation: ResumableRun, error: BaseException) -> None:
        """Write a checkpoint if the state is sound and the output holds all that the checkpoint would count."""
        if simulation.between_steps and self._writer.holds(simulation.samples, simulation.frames):
            try:
                self.write(simulation)
            except OutputError as failure:
                error.add_note(str(failure))

    def write(self, simulation: ResumableRun) -> None:
        """Write a checkpoint of the present state.

        Raises
        ------
        OutputError
            when it cannot be written; the previous one is intact.
        """
        self._writer.flush()
        try:
            write_checkpoint(self.path, simulation, self._writer.run_id)
        except OSError as error:
            raise OutputError(
                f"cannot write the checkpoint {self.path}: {error.strerror or error}; the output and the previous"
                " checkpoint, if any, are intact. To fix it: free some space or check the folder, then"
                f" sphframe resume {self._writer.path}"
            ) from error
        self.saved_time = simulation.time
        self._written_at = time.monotonic()
        self._set_due(simulation.time)

    def _set_due(self, now: float) -> None:
        if self._interval is not None:
            self._due = (now // self._interval + 1.0) * self._interval
