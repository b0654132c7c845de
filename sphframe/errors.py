"""Errors: what sphframe raises on purpose, each with a message that says how to fix it.

Every error is a :class:`SphframeError`. The command line prints its message without a traceback and exits with its
``exit_code``. Any other exception that leaves sphframe is a defect.
"""

from typing import ClassVar


class SphframeError(Exception):
    """Base class of all errors that sphframe raises on purpose."""

    exit_code: ClassVar[int] = 2
    """exit code of the command line: 2 if nothing was run, 3 if a run went wrong"""


class InputError(SphframeError, ValueError):
    """A parameter, an option or an input file is not valid; nothing has been run or written."""


class OutputError(SphframeError):
    """A file cannot be written, or is not one that sphframe wrote."""


class SimulationError(SphframeError):
    """A run has gone wrong: NaN, a particle outside the domain, a time step that collapsed.

    Parameters
    ----------
    message
        what happened and its likely causes.
    place
        position (dim,), in m, if the error belongs to one.

    Attributes
    ----------
    time
        simulated time, in s.
    step
        number of the step; the running simulation sets both.
    """

    exit_code = 3

    def __init__(self, message: str, *, place: tuple[float, ...] | None = None) -> None:
        super().__init__(message)
        self.place = place
        self.time: float | None = None
        self.step: int | None = None

    def __str__(self) -> str:
        where = [
            *([f"t = {self.time:.6g} s"] if self.time is not None else []),
            *([f"step {self.step}"] if self.step is not None else []),
            *([f"at ({', '.join(f'{x:.6g}' for x in self.place)}) m"] if self.place is not None else []),
        ]
        message = super().__str__()
        return f"{message} ({', '.join(where)})" if where else message


class PluginError(SphframeError):
    """A component cannot be loaded from the registry; the subclasses say why."""


class UnknownComponentError(PluginError, LookupError):
    """No installed distribution offers a component of the requested name."""


class BrokenPluginError(PluginError):
    """An installed component cannot be loaded or is not of the declared kind; ``__cause__`` is the reason."""


class ClashingPluginError(PluginError):
    """Several installed distributions offer a component of the requested name."""


class ApiVersionError(PluginError):
    """A plugin was written for another version of sphframe's plugin interface."""


class PluginWarning(UserWarning):
    """An installed hook cannot be used; the run goes on without it, since it was not requested by name."""


class ResumeWarning(UserWarning):
    """A run is continued with other versions than those that started it: its results may differ."""
