"""Simulation: errors of plugins are raised again as errors that name the plugin."""

import traceback
from collections.abc import Iterator
from contextlib import contextmanager

from sphframe.cases import Case
from sphframe.compiled.explain import explained
from sphframe.errors import BrokenPluginError, SimulationError, SphframeError
from sphframe.registry import COMPONENT_KINDS, Entry, available, find


@contextmanager
def naming_component(case: Case, *, running: bool) -> Iterator[None]:
    """Replace an exception of a component of the case, or of its compilation, by an error that names the component.

    Raises
    ------
    BrokenPluginError
        when nothing has run yet. SimulationError: when it is ``running``.
    """
    try:
        yield
    except (SphframeError, MemoryError):
        raise
    except Exception as error:
        strangers = [find(kind, getattr(case, field).name) for field, kind in COMPONENT_KINDS.items()]
        strangers = [entry for entry in strangers if entry.distribution != "sphframe"]
        failed = explained(error)
        if not failed and not (isinstance(error, SystemError) or _raised_in_a_loop(error)):
            strangers = [entry for entry in strangers if _passed_through(error, entry)]
        if not strangers:
            raise
        named = [entry for entry in strangers if _module(entry) in str(error)] or strangers
        names = " or ".join(entry.label for entry in named)
        text = f"{names} {failed or f'failed: {type(error).__name__}: {_shortened(error)}'}"
        if failed:
            text += f"\nsphframe verify {named[0].name} checks each of its functions by itself"
        else:
            text += "\nwith NUMBA_DISABLE_JIT=1 it runs as plain Python, slowly, in which a traceback shows the line"
        raise (SimulationError(text) if running else BrokenPluginError(text)) from error


@contextmanager
def naming_hook() -> Iterator[None]:
    """Replace an exception of an installed hook plugin by an error that names the plugin.

    Raises
    ------
    SimulationError
        in place of that exception.
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
    package = _module(entry).partition(".")[0]
    frames = traceback.walk_tb(error.__traceback__)
    return any(str(frame.f_globals.get("__name__")).partition(".")[0] == package for frame, _ in frames)


def _module(entry: Entry) -> str:
    return entry.value.partition(":")[0]


def _shortened(error: BaseException) -> str:
    """Return the first line of a message."""
    return next((line.strip() for line in str(error).splitlines() if line.strip()), "")
