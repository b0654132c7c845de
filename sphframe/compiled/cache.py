"""Compiled: where the compiled loops are kept, and what happens if they cannot be read or kept there."""

import atexit
import os
import shutil
import tempfile
import warnings
from functools import cache
from pathlib import Path
from typing import Any

import numba as typed_numba
from numba.core import caching, dispatcher

TEMPORARY = "sphframe-cache-"
"""with which the names of temporary folders begin"""
numba: Any = typed_numba  # its settings have no types
typed_caching: Any = caching  # nor has its cache


class TolerantCache(typed_caching.FunctionCache):  # type: ignore[misc]
    """Numba's cache of one function, without which a process goes on: what is in it can be compiled again.

    Numba itself raises whatever reading a damaged file and writing to a full disk raise, in each process again.
    """

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return what was compiled for the signature, or None; a damaged file is dropped."""
        try:
            return super().load_overload(sig, target_context)
        except Exception as error:  # pickle and LLVM raise anything
            _warn(f"files in {self.cache_path} are damaged ({_what(error)}) and replaced", self.cache_path)
            try:
                self.flush()
            except OSError:
                self.disable()
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled, if that is possible."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            self.disable()
            _warn(
                f"{self.cache_path} cannot be written to ({_what(error)}), so that each process compiles again: make"
                " room there, or set NUMBA_CACHE_DIR to another folder",
                self.cache_path,
            )


class TemporaryLocator(typed_caching._SourceFileBackedLocatorMixin, typed_caching._CacheLocator):  # type: ignore[misc]
    """Keeps the loops of this process in a temporary folder, where no other folder can be written to."""

    def __init__(self, py_func: Any, py_file: str) -> None:
        self._py_file, self._lineno = py_file, py_func.__code__.co_firstlineno
        self._folder = os.path.join(temporary_cache(), Path(py_file).stem)

    def get_cache_path(self) -> str:
        """Return the folder of the function's file."""
        return self._folder


@cache
def temporary_cache() -> str:
    """Return a folder that is removed when Python ends, after a warning."""
    own = tempfile.mkdtemp(prefix=TEMPORARY)
    atexit.register(shutil.rmtree, own, ignore_errors=True)
    _warn(
        f"neither {Path(__file__).parents[1]} nor the user's cache can be written to, so that each process compiles"
        " all loops: set NUMBA_CACHE_DIR to a folder that can be",
        own,
    )
    return own


@cache
def _warn(message: str, folder: str) -> None:
    warnings.warn(f"compiled loops: {message}", RuntimeWarning, stacklevel=2)


def _what(error: Exception) -> str:
    return getattr(error, "strerror", None) or f"{type(error).__name__}: {error}"


def tolerate_broken_caches() -> None:
    """Let Numba use both; functions that were declared before keep their cache."""
    dispatcher.FunctionCache = TolerantCache  # type: ignore[attr-defined]
    locators = typed_caching.CacheImpl._locator_classes
    if TemporaryLocator not in locators:
        locators.append(TemporaryLocator)


tolerate_broken_caches()  # before any loop is declared, as the other modules of this room do when they are imported
