"""Output: a lock by which only one run writes a file; the operating system releases it when the process ends."""

import os
import sys
from pathlib import Path


def lock_file(path: Path) -> int | None:
    """Lock ``path`` for the writing run and return the open descriptor that holds the lock; None if it is taken.

    The lock is ``flock`` on the file itself, so no lock file can be left behind. Where the system or the file system
    has no such lock (Windows, some network file systems), the descriptor is returned without one.
    """
    while True:
        descriptor = os.open(path, os.O_RDWR)
        if sys.platform != "win32":
            import fcntl

            try:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                os.close(descriptor)
                return None
            except OSError:
                return descriptor
        if is_same_file(descriptor, path):
            return descriptor
        os.close(descriptor)  # replaced between opening and locking


def is_same_file(descriptor: int, path: Path) -> bool:
    """Return whether the open file is the one at ``path``, which may have been deleted or replaced."""
    try:
        return os.path.samestat(os.fstat(descriptor), os.stat(path))
    except FileNotFoundError:
        return False
