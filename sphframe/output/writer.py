"""Output: the hook plugin that writes a run into one NetCDF file."""

import contextlib
import os
import time
import uuid
from pathlib import Path
from typing import Any, final

import numpy as np

from sphframe.errors import OutputError
from sphframe.hooks import hookimpl
from sphframe.interfaces import RunView
from sphframe.output.checkpoint import Checkpoint
from sphframe.output.contents import check_finite, frame_of, planned_size, sample_of, write_start
from sphframe.output.run_file import RunFile
from sphframe.output.schema import RunStatus
from sphframe.output.target import check_space, check_target


@final
class NetCDFWriter:
    """A hook plugin that writes a run to ``path``.

    Parameters
    ----------
    path
        the file to write; conventionally ending in ``.nc``.
    overwrite
        replace an existing file. It is replaced when the run starts, not before.
    flush_interval
        wall-clock time after which samples are written at the latest, s; a killed run loses at most the
        samples of this time.
    resumed
        the checkpoint from which an existing file is continued; None to create a new file.

    Raises
    ------
    OutputError
        the file exists and ``overwrite`` is false, its folder is missing or cannot be written to, or another
        run is writing it. All of this is checked here, before anything is computed.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        overwrite: bool = False,
        *,
        flush_interval: float = 1.0,
        resumed: Checkpoint | None = None,
    ) -> None:
        self.path = Path(path)
        self.run_id = ""
        """identifies the run in its output and its checkpoints; empty before the run has started"""
        self.overwrite = overwrite
        self.flush_interval = flush_interval
        self._resumed = resumed
        self._file = RunFile(self.path)
        self._samples: list[dict[str, Any]] = []
        self._flushed_at = 0.0
        if resumed is None:
            check_target(self.path, overwrite)

    @hookimpl
    def sphframe_run_started(self, simulation: RunView) -> None:
        """Create the file with all that is known at the start, or open an existing one to continue it."""
        if self._resumed is not None:
            self._file.reopen(self._resumed)
            self.run_id = self._resumed.run_id
        else:
            check_target(self.path, self.overwrite)
            check_space(self.path, *planned_size(simulation))
            run_id = uuid.uuid4().hex
            self._file.create(lambda file: write_start(file, simulation, run_id), overwrite=self.overwrite)
            self.run_id = run_id
        self._flushed_at = time.monotonic()

    @hookimpl
    def sphframe_probes_due(self, simulation: RunView) -> None:
        """Take a sample of probes, sums and diagnostics."""
        sample = sample_of(simulation)
        check_finite(sample)
        self._samples.append(sample)
        if time.monotonic() - self._flushed_at > self.flush_interval:
            self._write_samples()

    @hookimpl
    def sphframe_frame_due(self, simulation: RunView) -> None:
        """Write all particles."""
        frame = frame_of(simulation)
        check_finite(frame)
        self._file.append_frame(frame)
        self._write_samples()

    @hookimpl
    def sphframe_run_finished(self, simulation: RunView) -> None:
        """Write the remaining samples, mark the run as completed and close the file."""
        self._end(RunStatus.COMPLETED, "")

    @hookimpl
    def sphframe_run_failed(self, simulation: RunView, error: BaseException) -> None:
        """Write the remaining samples and the reason of the failure, and close the file."""
        if not self._file.is_open:
            return
        with contextlib.suppress(OutputError):  # the run has failed already, perhaps because the disk is full
            interrupted = isinstance(error, KeyboardInterrupt)
            self._end(RunStatus.FAILED, "interrupted" if interrupted else f"{type(error).__name__}: {error}")

    def flush(self) -> None:
        """Write all samples taken so far, and wait until the disk holds them.

        Raises
        ------
        OutputError
            when that fails.
        """
        if self._file.is_open:
            self._write_samples()
            self._file.sync_to_disk()

    def holds(self, samples: int, frames: int) -> bool:
        """Return whether the file has been begun and contains so many samples and frames."""
        return bool(self.run_id) and self._file.samples >= samples and self._file.frames >= frames

    def _write_samples(self) -> None:
        if self._samples:
            names = self._samples[0]
            self._file.append_samples({name: np.array([sample[name] for sample in self._samples]) for name in names})
            self._samples.clear()
        self._flushed_at = time.monotonic()

    def _end(self, status: RunStatus, message: str) -> None:
        self._write_samples()
        self._file.mark(status, message)
        self._file.close()
