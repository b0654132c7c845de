"""Output: the NetCDF file of a run, written so that it can be read at any moment and after a crash at any moment.

The header and everything that does not change are written to a draft, which is then renamed: the file appears complete.
After that, numbers are only added. A frame counts once the record number in the header includes it, and this number is
written after the frame's data. A sample counts once its ``probe_time`` is not NaN, and this is written last.
"""

import contextlib
import errno
import os
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Literal, final

import netCDF4
import numpy as np
from numpy.typing import ArrayLike

from sphframe.errors import OutputError
from sphframe.output.checkpoint import Checkpoint, checkpoint_path
from sphframe.output.files import draft_path, fresh_draft
from sphframe.output.lock import is_same_file, lock_file
from sphframe.output.schema import FORMAT, RunStatus, encode_texts
from sphframe.output.target import exists_message, locked_message

_DISK_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


@final
class RunFile:
    """The file at ``path``, locked by the run that writes it.

    Every failure to write is raised as an :class:`~sphframe.errors.OutputError` that says which part of the file is
    intact; the file is then closed.

    Attributes
    ----------
    path
        the file.
    frames, samples
        number of each that the file holds.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.frames = self.samples = 0
        self._dataset: netCDF4.Dataset | None = None
        self._lock: int | None = None

    @property
    def is_open(self) -> bool:
        """Whether the file can be written to."""
        return self._dataset is not None

    def create(self, write_start: Callable[[netCDF4.Dataset], None], *, overwrite: bool) -> None:
        """Write the header and all that does not change by ``write_start``, then let the file appear at its path.

        Raises
        ------
        OutputError
            the file cannot be written, or exists and is not to be replaced.
        """
        with self._reporting_failures():
            draft = self._locked_draft()
            try:
                self._dataset = _open(draft, "w")
                write_start(self._dataset)
                self._dataset.sync()
                self._publish(draft, overwrite)
                checkpoint_path(self.path).unlink(missing_ok=True)  # it belongs to the run that was replaced
            except BaseException:
                self._abandon()
                draft.unlink(missing_ok=True)
                raise

    def reopen(self, checkpoint: Checkpoint) -> None:
        """Open the existing file to continue it after the frames and samples that ``checkpoint`` counts.

        Raises
        ------
        OutputError
            the file belongs to another run than the checkpoint, holds less, or another run is writing it.
        """
        with self._reporting_failures():
            self._lock = lock_file(self.path)
            if self._lock is None:
                raise OutputError(locked_message(self.path))
            self._dataset = _open(self.path, "r+")
            try:
                _check_belongs(self._dataset, checkpoint, self.path)
            except OutputError:
                self._abandon()
                raise
            self.frames, self.samples = checkpoint.frames, checkpoint.samples
            self.mark(RunStatus.RUNNING, "")

    def append_samples(self, values: Mapping[str, ArrayLike]) -> None:
        """Add samples: all values, and once these are in the file, their ``probe_time``.

        Parameters
        ----------
        values
            arrays (n, ...) by the names of the variables.
        """
        dataset = self._open_dataset()
        times = np.asarray(values["probe_time"])
        rows = slice(self.samples, self.samples + len(times))
        with self._reporting_failures():
            self._check_in_place()
            for name, array in values.items():
                if name != "probe_time":
                    dataset[name][rows] = array
            dataset.sync()
            dataset["probe_time"][rows] = times
            dataset.sync()
        self.samples += len(times)

    def append_frame(self, values: Mapping[str, ArrayLike]) -> None:
        """Add a frame; ``values`` are arrays by the names of the variables, written in their order."""
        dataset = self._open_dataset()
        with self._reporting_failures():
            self._check_in_place()
            for name, array in values.items():
                dataset[name][self.frames] = array
            dataset.sync()
        self.frames += 1

    def mark(self, status: RunStatus, message: str) -> None:
        """Write the state of the run."""
        dataset = self._open_dataset()
        with self._reporting_failures():
            width = len(dataset.dimensions["run_message_length"])
            dataset["run_message"][:] = encode_texts([message], width)[0]
            dataset["run_status"][...] = int(status)
            dataset.sync()

    def sync_to_disk(self) -> None:
        """Wait until the disk holds all that was written."""
        with self._reporting_failures():
            if self._lock is not None:
                os.fsync(self._lock)

    def close(self) -> None:
        """Close the file and unlock it."""
        with self._reporting_failures():
            self._close()

    def _locked_draft(self) -> Path:
        """Create the draft and lock it, unless another run has it."""
        draft = draft_path(self.path)
        old = lock_file(draft) if draft.is_file() and not draft.is_symlink() else -1
        if old is not None:
            draft = fresh_draft(self.path)
            if old >= 0:
                os.close(old)
            self._lock = lock_file(draft)
        if self._lock is None:
            raise OutputError(locked_message(self.path))
        return draft

    def _publish(self, draft: Path, overwrite: bool) -> None:
        """Rename the finished draft; a file that another run is writing is never replaced."""
        if overwrite and self.path.exists():
            old = lock_file(self.path)
            if old is None:
                raise OutputError(locked_message(self.path))
            try:
                draft.replace(self.path)
            finally:
                os.close(old)
        else:
            try:
                os.link(draft, self.path)
            except FileExistsError:
                raise OutputError(exists_message(self.path)) from None
            except OSError:  # a file system without hard links
                draft.rename(self.path)
            else:
                draft.unlink()

    def _check_in_place(self) -> None:
        if self._lock is not None and not is_same_file(self._lock, self.path):
            raise OutputError(
                f"{self.path} was deleted or replaced while the run was writing it; the run stops."
                " Run it again, with another --output if something cleans that folder"
            )

    @contextlib.contextmanager
    def _reporting_failures(self) -> Iterator[None]:
        """Turn failures to write into an OutputError that says what was kept."""
        try:
            yield
        except (OSError, RuntimeError) as error:  # netCDF4 raises RuntimeError
            kept = "nothing was written"
            if self.samples or self.frames:
                kept = f"{self.frames} frames and {self.samples} samples written before are intact in {self.path}"
            self._abandon()
            cause, remedy = _cause_and_remedy(error)
            raise OutputError(f"cannot write {self.path}: {cause}; {kept}. To fix it: {remedy}") from error

    def _open_dataset(self) -> netCDF4.Dataset:
        if self._dataset is None:
            raise OutputError(f"{self.path} is not open: the run has not started, or writing has failed before")
        return self._dataset

    def _abandon(self) -> None:
        """Unlock a file that cannot be written to. Closing its dataset fails too, and netCDF4 then frees it twice."""
        self._dataset = None
        self._close()

    def _close(self) -> None:
        if self._dataset is not None:
            self._dataset.close()
            self._dataset = None
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None


def _open(path: Path, mode: Literal["w", "r+"]) -> netCDF4.Dataset:
    dataset = netCDF4.Dataset(path, mode, format=FORMAT)
    dataset.set_auto_maskandscale(False)
    dataset.set_auto_chartostring(False)
    return dataset


def _check_belongs(dataset: netCDF4.Dataset, checkpoint: Checkpoint, path: Path) -> None:
    if getattr(dataset, "run_id", "") != checkpoint.run_id:
        raise OutputError(f"{path} is of another run than its checkpoint; run the case again")
    samples = int(np.isfinite(dataset["probe_time"][:]).sum())
    if len(dataset["time"]) < checkpoint.frames or samples < checkpoint.samples:
        raise OutputError(
            f"{path} holds less than its checkpoint counts: it is an older copy; put them together again,"
            " or run the case again"
        )


def _cause_and_remedy(error: Exception) -> tuple[str, str]:
    full = getattr(error, "errno", None) in _DISK_FULL or any(os.strerror(n) in str(error) for n in _DISK_FULL)
    if full:
        remedy = "free some space or choose another --output, or a larger frame_interval"
        return "the disk is full or the size limit is reached", remedy
    return str(error), "check the folder and its permissions, or choose another --output"
