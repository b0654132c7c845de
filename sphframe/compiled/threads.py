"""Compiled: how the loops use the processors: the library of their threads, the number of threads, and forks."""

import contextlib
import ctypes
import importlib.metadata
import math
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numba as typed_numba

from sphframe.errors import InputError

numba: Any = typed_numba  # its settings have no types
_process_with_threads: int | None = None


def prefer_fair_threads() -> None:
    """Let Numba find TBB, whose waiting threads leave the processors to others; else let OpenMP's wait only briefly.

    Numba's own search for TBB misses the library that ``pip install tbb`` puts beside Python. It is found once it has
    been loaded. Threads of GNU OpenMP wait by using their processors, so that two runs at a time starve each other: 5
    steps per second instead of 1,100 on two cores, and about 390 with the limit set here. Both have to be done before
    the first compiled loop runs.
    """
    names = {"win32": "tbb12.dll", "darwin": "libtbb.12.dylib"}
    with contextlib.suppress(importlib.metadata.PackageNotFoundError, OSError):
        for file in importlib.metadata.files("tbb") or ():
            if file.name == names.get(sys.platform, "libtbb.so.12"):
                ctypes.CDLL(str(file.locate()), ctypes.RTLD_GLOBAL)
                return
    if "OMP_WAIT_POLICY" not in os.environ:
        os.environ.setdefault("GOMP_SPINCOUNT", "1000")


def use_threads(threads: int | None) -> int:
    """Set the number of threads of the compiled loops and return it; None for one per available processor.

    Raises
    ------
    InputError
        there are not so many, or this process was forked from one whose threads did not survive the fork.
    """
    global _process_with_threads
    most = int(numba.config.NUMBA_NUM_THREADS)
    if threads is not None and not 1 <= threads <= most:
        raise InputError(f"threads = {threads}, but this machine offers 1 to {most}")
    chosen = threads or default_threads()
    numba.set_num_threads(chosen)
    if chosen > 1:
        if _process_with_threads not in (None, os.getpid()) and numba.threading_layer() != "tbb":
            raise InputError(
                f"this process was forked from one that has run with several threads, which {numba.threading_layer()}"
                " does not allow: start processes by multiprocessing.get_context('spawn'), run with threads=1, or"
                " install tbb (pip install tbb)"
            )
        _process_with_threads = os.getpid()
    return chosen


def default_threads() -> int:
    """Return the number of processors that this process may use, by its affinity and its control group."""
    return max(1, int(min(numba.config.NUMBA_NUM_THREADS, *_group_limits())))


def _group_limits(root: Path = Path("/sys/fs/cgroup"), own: Path = Path("/proc/self/cgroup")) -> Iterator[float]:
    """Yield the processors that each Linux control group of this process, and each above it, may use together."""
    yield math.inf
    with contextlib.suppress(OSError, ValueError):
        for line in own.read_text(encoding="utf-8").splitlines():
            _, controllers, path = line.split(":", 2)
            top = root / "cpu" if "cpu" in controllers.split(",") else root
            for group in (top / path.lstrip("/"), *(top / path.lstrip("/")).parents):
                with contextlib.suppress(OSError, ValueError):
                    if controllers:
                        quota, period = ((group / f"cpu.cfs_{name}_us").read_text() for name in ("quota", "period"))
                    else:
                        quota, period = (group / "cpu.max").read_text().split()
                    if float(quota) > 0.0:
                        yield float(quota) / float(period)
