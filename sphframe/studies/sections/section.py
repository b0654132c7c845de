"""Studies: what a section is, and the variants of the boundary that sections compare."""

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import xarray as xr

from sphframe.cases import CaseWarning, load_case
from sphframe.studies.chapter import Chapter
from sphframe.studies.series import Reference
from sphframe.studies.tasks import RunTask, Task, wall_boundary

__all__ = ["OURS", "PAPER", "Section", "Variant", "run_task"]


class Section(NamedTuple):
    """One section of the paper.

    Attributes
    ----------
    name: on the command line.
    tasks: from whether it is to be quick, the runs.
    chapter: from the results by the tasks' labels, reference series and whether it was quick, what they show.
    """

    name: str
    tasks: Callable[[bool], Sequence[Task]]
    chapter: Callable[[Mapping[str, xr.Dataset], Reference, bool], Chapter]


@dataclass(frozen=True)
class Variant:
    """A wall boundary: an interpolation method with its options, and a hydrostatic lift.

    ``published`` says that the paper shows it; the others are ours.
    """

    method: str
    lift: str
    published: bool = False
    form: str | None = None

    @property
    def label(self) -> str:
        """Name in tables and figures."""
        form = f" {self.form}" if self.form else ""
        lift = "" if self.method in ("mdbc", "adami") else f", {self.lift}"
        return f"{self.method}{form}{lift}"

    @property
    def interpolator(self) -> dict[str, Any]:
        """The component, as a case takes it."""
        return {"name": self.method} | ({"form": self.form} if self.form else {})


PAPER = (
    Variant("improved-shepard", "mirror", published=True),
    Variant("mls-linear", "mirror", published=True),
    Variant("mls-quadratic", "mirror", published=True),
    Variant("sfdi", "mirror", published=True, form="printed"),
    Variant("normalized", "mirror", published=True),
)
"""the paper's five, with its lift"""

OURS = (
    Variant("improved-shepard", "balanced"),
    Variant("normalized", "balanced"),
    Variant("shepard", "balanced"),
    Variant("mdbc", "balanced"),
    Variant("adami", "balanced"),
)
"""beside them: the balanced lift, the classical Shepard method, and two boundaries of other codes"""


def run_task(label: str, case: str, variant: Variant, preset: str | None, **parameters: Any) -> RunTask:
    """Return the run of ``case`` with ``variant``; what the case warns of is what the paper does."""
    chosen = {**wall_boundary(variant.interpolator, variant.lift), **parameters}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CaseWarning)
        return RunTask.of(label, load_case(case, preset, chosen))
