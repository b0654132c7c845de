"""Output: checks, before anything is computed, that the file of a run can be written."""

import os
import shutil
from pathlib import Path

from sphframe.errors import OutputError
from sphframe.output.checkpoint import checkpoint_path
from sphframe.output.lock import lock_file


def check_target(path: Path, overwrite: bool) -> None:
    """Raise an error if no run may write to ``path``.

    Raises
    ------
    OutputError
        the file exists and ``overwrite`` is false, another run is writing it, or its folder is missing or
        cannot be written to.
    """
    if path.is_dir():
        raise OutputError(f"{path} is a folder: name a file in it, such as {path / 'run.nc'}")
    if path.is_symlink() and not path.exists():
        raise OutputError(
            f"{path} is a link to {os.readlink(path)}, which does not exist: remove the link, or give another --output"
        )
    if path.exists():
        if not overwrite:
            raise OutputError(exists_message(path))
        try:
            descriptor = lock_file(path)
        except OSError as error:
            raise OutputError(f"cannot replace {path}: {error.strerror}; choose another --output") from None
        if descriptor is None:
            raise OutputError(locked_message(path))
        os.close(descriptor)
    elif checkpoint_path(path).exists() and not overwrite:
        raise OutputError(
            f"{checkpoint_path(path)} exists, the checkpoint of a run whose output is missing: give --overwrite"
            " (overwrite=True) to remove it, or another --output"
        )
    folder = path.parent
    if not folder.is_dir():
        raise OutputError(f"the folder {folder} for {path.name} does not exist: create it (mkdir -p {folder})")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise OutputError(
            f"the folder {folder} cannot be written to: change its permissions or choose another --output"
        )


def check_space(path: Path, planned: int, frames: int) -> None:
    """Raise an error if fewer than ``planned`` bytes are free on the disk, which ``frames`` frames need.

    Raises
    ------
    OutputError
        the free space is too small.
    """
    free = shutil.disk_usage(path.parent).free
    if planned > free:
        raise OutputError(
            f"{path} would need about {_size(planned)} for {frames} frames, but only {_size(free)} are"
            " free: choose another --output, a larger frame_interval, or free some space"
        )


def _size(count: int) -> str:
    return f"{count / 1e9:.1f} GB" if count > 1e9 else f"{count / 1e6:.1f} MB"


def exists_message(path: Path) -> str:
    """Return the message of the error that ``path`` exists already."""
    resume = f", sphframe resume {path} to continue it" if checkpoint_path(path).exists() else ""
    return f"{path} exists: give --overwrite (overwrite=True) to replace it{resume}, or another --output"


def locked_message(path: Path) -> str:
    """Return the message of the error that another run has locked ``path``."""
    return f"another run is writing {path}: wait for it, stop it, or give another --output"
