"""Simulation: errors of plugins are raised again as errors that name the plugin."""

import traceback
from collections.abc import Iterator
from contextlib import contextmanager

import numba

from sphframe.cases import Case
from sphframe.errors import BrokenPluginError, SimulationError, SphframeError
from sphframe.registry import COMPONENT_KINDS, Entry, available, find


@contextmanager
def naming_component(case: Case, *, running: bool) -> Iterator[None]:
    """Replace an exception of a component of the case, or of its compilation, by an error that names the component.

    Raises
    ------
    BrokenPluginError: when nothing has run yet. SimulationError: when it is ``running``.
    """
    try:
        yield
    except (SphframeError, MemoryError):
        raise
    except Exception as error:
        strangers = [find(kind, getattr(case, field).name) for field, kind in COMPONENT_KINDS.items()]
        strangers = [entry for entry in strangers if entry.distribution != "sphframe"]
        compiled = isinstance(error, numba.core.errors.NumbaError | SystemError) or _raised_in_a_loop(error)
        if not compiled:
            strangers = [entry for entry in strangers if _passed_through(error, entry)]
        if not strangers:
            raise
        doing = "does not compile" if isinstance(error, numba.core.errors.NumbaError) else "failed"
        text = (
            f"{' or '.join(entry.label for entry in strangers)} {doing}: {type(error).__name__}: {_shortened(error)}\n"
            "to see where, run sphframe verify NAME, or run with NUMBA_DISABLE_JIT=1, which is slow but debugs as"
            " plain Python"
        )
        raise (SimulationError(text) if running else BrokenPluginError(text)) from error


@contextmanager
def naming_hook() -> Iterator[None]:
    """Replace an exception of an installed hook plugin by an error that names the plugin.

    Raises
    ------
    SimulationError: in place of that exception.
    """
    try:
        yield
    except (SphframeError, MemoryError):
        raise
    except Exception as error:
        for entry in available("hooks"):
            if _passed_through(error, entry):
                raise SimulationError(
                    f"{entry.label} failed: {type(error).__name__}: {_shortened(error)}\n"
                    f"what was computed is kept; fix the plugin or remove it (pip uninstall {entry.distribution})"
                    " and continue with sphframe resume"
                ) from error
        raise


def _raised_in_a_loop(error: BaseException) -> bool:
    """Whether ``error`` was raised in a compiled function, whose frame does not know its module."""
    *_, (last, _) = traceback.walk_tb(error.__traceback__)
    return "__name__" not in last.f_globals


def _passed_through(error: BaseException, entry: Entry) -> bool:
    """Whether ``error`` was raised in, or by something called from, the module of ``entry``."""
    package = entry.value.partition(":")[0].partition(".")[0]
    frames = traceback.walk_tb(error.__traceback__)
    return any(str(frame.f_globals.get("__name__")).partition(".")[0] == package for frame, _ in frames)


def _shortened(error: BaseException) -> str:
    """Return the first line of a message, and the lines of a compiler's message that say what failed and where."""
    first, *rest = [line.strip() for line in str(error).splitlines() if line.strip()] or [""]
    telling = [line for line in rest if line.startswith(("NameError", "Unknown", "No implementation", "File"))]
    return "; ".join([first, *telling[:3]])
