"""Output: checkpoints, from which a run that was stopped or killed continues to the same bits.

A checkpoint lies beside the output, ``run.nc.restart`` beside ``run.nc``: a ZIP archive, uncompressed, of raw arrays in
little-endian byte order, one member each, and ``checkpoint.json`` with their types and shapes and with the versions of
all that computed them. Its check sums tell a damaged one. It is data: nothing in it can execute.

It is written under another name, brought to the disk and then renamed: whatever happens, either the checkpoint before
or the new one is there. The output is brought to the disk first: a checkpoint never counts a frame that is not there.
"""

import contextlib
import importlib.metadata
import json
import os
import platform
import time
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sphframe.errors import InputError, OutputError
from sphframe.hooks import hookimpl
from sphframe.interfaces import CaseView, ResumableRun
from sphframe.output.provenance import distributions, software
from sphframe.output.writer import NetCDFWriter, checkpoint_path

__all__ = ["Checkpoint", "CheckpointWriter", "changed_versions", "read_checkpoint"]

_FORMAT = 1
_HEADER = "checkpoint.json"
_TYPES = {"f": "<f8", "i": "<i8"}


@dataclass(frozen=True)
class Checkpoint:
    """What a checkpoint holds: the ``state`` of the simulation, and of which run, made by which versions."""

    run_id: str
    time: float
    samples: int
    frames: int
    versions: Mapping[str, str]
    state: Mapping[str, NDArray[Any]]


class CheckpointWriter:
    """A hook plugin that writes checkpoints beside the output of ``writer``.

    A checkpoint is also written when the run is interrupted, and removed when it is complete. None is written of a
    state that the guards have stopped: the last good one stays.

    Parameters
    ----------
    writer: what writes the output; it must be told of an event before this is.
    every: wall-clock time between checkpoints, s; None for none.
    interval: simulated time between checkpoints, s; None for none.

    Raises
    ------
    InputError: when an interval is not positive.
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
        """Start counting."""
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
        """Remove the checkpoint: nothing is left to continue."""
        self.path.unlink(missing_ok=True)

    @hookimpl
    def sphframe_run_failed(self, simulation: ResumableRun, error: BaseException) -> None:
        """Write a checkpoint when the run was interrupted."""
        if isinstance(error, KeyboardInterrupt) and simulation.between_steps and self._writer.run_id:
            self.write(simulation)

    def write(self, simulation: ResumableRun) -> None:
        """Write a checkpoint of the present state.

        Raises
        ------
        OutputError: when it cannot be written; the one before is intact.
        """
        self._writer.flush()
        state = simulation.state()
        arrays = {name: np.asarray(array, _TYPES[array.dtype.kind], order="C") for name, array in state.items()}
        header = {
            "format": _FORMAT,
            "run_id": self._writer.run_id,
            "time": simulation.time,
            "samples": simulation.samples,
            "frames": simulation.frames,
            "versions": _versions(simulation.case),
            "arrays": {name: [array.dtype.str, array.shape] for name, array in arrays.items()},
        }
        draft = self.path.with_name(f".{self.path.name}.draft")
        try:
            with draft.open("wb") as file:
                with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
                    archive.writestr(_HEADER, json.dumps(header))
                    for name, array in arrays.items():
                        archive.writestr(name, array.tobytes())
                file.flush()
                os.fsync(file.fileno())
            draft.replace(self.path)
        except OSError as error:
            with contextlib.suppress(OSError):
                draft.unlink(missing_ok=True)
            raise OutputError(
                f"cannot write the checkpoint {self.path}: {error.strerror or error}; the output and the checkpoint"
                " before, if any, are intact. To mend it: free some space or check the folder, then"
                f" sphframe resume {self._writer.path}"
            ) from error
        self.saved_time = simulation.time
        self._written_at = time.monotonic()
        self._set_due(simulation.time)

    def _set_due(self, now: float) -> None:
        if self._interval is not None:
            self._due = (now // self._interval + 1.0) * self._interval


def read_checkpoint(path: Path) -> Checkpoint:
    """Read and check the checkpoint at ``path``.

    Raises
    ------
    InputError: when it is missing, damaged, or written by another format of checkpoints.
    """
    damaged = f"{path} is not a readable checkpoint of sphframe: it is foreign or damaged; copy it again, or run again"
    try:
        with zipfile.ZipFile(path) as archive:
            if any(member.compress_type != zipfile.ZIP_STORED for member in archive.infolist()):
                raise InputError(damaged)
            header = json.loads(archive.read(_HEADER))
            if header["format"] != _FORMAT:
                raise InputError(
                    f"{path} is a checkpoint of format {header['format']}, and this sphframe reads {_FORMAT}: continue"
                    f" with the sphframe that wrote it ({header.get('versions')})"
                )
            state = {name: _array(archive.read(name), kind, shape) for name, (kind, shape) in header["arrays"].items()}
        return Checkpoint(
            run_id=str(header["run_id"]),
            time=float(header["time"]),
            samples=int(header["samples"]),
            frames=int(header["frames"]),
            versions={str(name): str(version) for name, version in header["versions"].items()},
            state=state,
        )
    except FileNotFoundError:
        raise InputError(
            f"there is no checkpoint {path}: the run is complete, or ended before its first one; run the case again"
        ) from None
    except InputError:
        raise
    except OSError as error:
        raise InputError(f"cannot read the checkpoint {path}: {(error.strerror or str(error)).lower()}") from None
    except (zipfile.BadZipFile, KeyError, ValueError, TypeError, AttributeError, NotImplementedError, RuntimeError):
        raise InputError(damaged) from None  # RuntimeError: an encrypted member, or nested too deeply


def _array(content: bytes, kind: str, shape: list[int]) -> NDArray[Any]:
    if kind not in _TYPES.values():
        raise ValueError(kind)
    return np.frombuffer(content, dtype=kind).reshape(shape).copy()


def changed_versions(checkpoint: Checkpoint, case: CaseView) -> list[str]:
    """Return what is not the version that wrote ``checkpoint``, as texts ``numpy 2.1.0, now 2.2.0``."""
    before, now = checkpoint.versions, _versions(case)
    return [
        f"{name} {before.get(name, 'absent')}, now {now.get(name, 'absent')}"
        for name in sorted({*before, *now})
        if before.get(name) != now.get(name)
    ]


def _versions(case: CaseView) -> dict[str, str]:
    """Versions of all that the bits of a result depend on."""
    return {
        **distributions(case),
        **software(),
        "llvmlite": importlib.metadata.version("llvmlite"),
        "processor": platform.machine(),
    }
