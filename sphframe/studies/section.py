"""Studies: a section of a study: its runs, and the chapter of the report that is written from their results."""

import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import xarray as xr

from sphframe.cases import CaseWarning, load_case
from sphframe.studies.chapter import Chapter
from sphframe.studies.series import Reference
from sphframe.studies.tasks import RunTask, Task


class Section(NamedTuple):
    """A section of a study.

    Attributes
    ----------
    name
        names the section on the command line (``--only``).
    tasks
        returns the tasks; its argument is true for the quick version, at coarse resolutions and for short times.
    chapter
        returns the chapter; its arguments are the results by the labels of the tasks, the reference series, and
        whether it is the quick version.
    """

    name: str
    tasks: Callable[[bool], Sequence[Task]]
    chapter: Callable[[Mapping[str, xr.Dataset], Reference, bool], Chapter]


def run_task(label: str, case: str, preset: str | None = None, **parameters: Any) -> RunTask:
    """Return the task that runs ``case`` with ``parameters``, as for :func:`sphframe.load_case`.

    Warnings of the case are not shown: a study may contain settings that the case advises against.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CaseWarning)
        return RunTask.of(label, load_case(case, preset, parameters))
