"""The wall boundaries that the sections compare, and their runs."""

from dataclasses import dataclass
from typing import Any

from sphframe.studies import RunTask, run_task, wall_boundary

__all__ = ["OURS", "PAPER", "Variant", "run_with"]


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


def run_with(variant: Variant, label: str, case: str, **parameters: Any) -> RunTask:
    """Return the run of ``case``, preset ``paper``, with ``variant`` as its wall boundary."""
    boundary = wall_boundary(variant.interpolator, variant.lift)
    return run_task(label, case, "paper", **boundary, **parameters)
