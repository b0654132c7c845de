"""Compiled: where the compiled loops are kept."""

import atexit
import os
import shutil
import tempfile
import warnings
from pathlib import Path
from typing import Any

import numba as typed_numba
from numba.misc.appdirs import AppDirs

numba: Any = typed_numba  # its settings have no types


def prefer_writable_cache(package: Path = Path(__file__).parents[1]) -> None:
    """Let Numba keep compiled loops for this process alone where it can write neither beside them nor in the home.

    Numba would refuse to compile there. It keeps them beside the package, else in the user's cache, else in the folder
    that NUMBA_CACHE_DIR names.
    """
    if numba.config.CACHE_DIR or os.access(package, os.W_OK):
        return
    folder = Path(AppDirs(appname="numba", appauthor=False).user_cache_dir)  # type: ignore[no-untyped-call]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if os.access(folder, os.W_OK):
            return
    except OSError:
        pass
    own = tempfile.mkdtemp(prefix="sphframe-cache-")
    atexit.register(shutil.rmtree, own, ignore_errors=True)
    numba.config.CACHE_DIR = os.environ["NUMBA_CACHE_DIR"] = own
    warnings.warn(
        f"neither {package} nor {folder} can be written to, so that each process compiles all loops: set"
        " NUMBA_CACHE_DIR to a folder that can be",
        RuntimeWarning,
        stacklevel=2,
    )
