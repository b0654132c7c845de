"""Errors: what sphframe raises on purpose, each with a message that says how to mend it.

Every one is a :class:`SphframeError`; the command line prints its message without a traceback and exits with its
``exit_code``. Anything else that escapes from sphframe is a bug.
"""

from typing import ClassVar

__all__ = [
    "ApiVersionError",
    "BrokenPluginError",
    "ClashingPluginError",
    "InputError",
    "OutputError",
    "PluginError",
    "PluginWarning",
    "ResumeWarning",
    "SimulationError",
    "SphframeError",
    "UnknownComponentError",
]


class SphframeError(Exception):
    """Base of all: catch it to catch everything that sphframe raises on purpose."""

    exit_code: ClassVar[int] = 2
    """what the command line exits with: 2 nothing was run, 3 a run went wrong"""


class InputError(SphframeError, ValueError):
    """When a parameter, an option or an input file is not valid; nothing has been run or written."""


class OutputError(SphframeError):
    """When a file cannot be written, or cannot be read as one that sphframe wrote."""


class SimulationError(SphframeError):
    """When a run has gone wrong: NaN, a particle outside the domain, a time step that collapsed.

    Parameters
    ----------
    message: what happened and its likely causes.
    time: simulated time, in s.
    step: number of the step.
    place: where, in m (dim,), when it happened at one place.
    """

    exit_code = 3

    def __init__(
        self,
        message: str,
        *,
        time: float | None = None,
        step: int | None = None,
        place: tuple[float, ...] | None = None,
    ) -> None:
        super().__init__(message)
        self.time = time
        self.step = step
        self.place = place

    def __str__(self) -> str:
        where = [
            *([f"t = {self.time:.6g} s"] if self.time is not None else []),
            *([f"step {self.step}"] if self.step is not None else []),
            *([f"at ({', '.join(f'{x:.6g}' for x in self.place)}) m"] if self.place is not None else []),
        ]
        message = super().__str__()
        return f"{message} ({', '.join(where)})" if where else message


class PluginError(SphframeError):
    """When a component cannot be had from the registry; one of the errors below says why."""


class UnknownComponentError(PluginError, LookupError):
    """When no installed distribution offers a component of the name asked for."""


class BrokenPluginError(PluginError):
    """When an installed component cannot be loaded or is not what it claims to be; its cause is ``__cause__``."""


class ClashingPluginError(PluginError):
    """When several installed distributions claim the name asked for."""


class ApiVersionError(PluginError):
    """When a plugin was written for another version of sphframe's plugin interface."""


class PluginWarning(UserWarning):
    """When a plugin nobody asked for by name (a hook) cannot be used; the run goes on without it."""


class ResumeWarning(UserWarning):
    """When a run is continued by other versions than began it: its results may differ in the last digits or more."""
