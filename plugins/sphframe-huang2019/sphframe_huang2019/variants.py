"""The wall boundaries that the sections compare, and their runs."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import xarray as xr

from sphframe.studies import Cell, RunTask, ended, fallback_share, run_task, wall_boundary

__all__ = ["OURS", "PAPER", "Variant", "row_of_run", "run_with"]


@dataclass(frozen=True)
class Variant:
    """A wall boundary: an interpolation method with its options, and a hydrostatic lift.

    Attributes
    ----------
    method, form
        the interpolation method, and the option ``form`` of SFDI.
    lift
        ``mirror``, with interpolated ghost velocities, or ``balanced``, with corrected ones.
    published
        whether the paper compares it.
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
        """Parameter ``interpolator`` of a case."""
        return {"name": self.method} | ({"form": self.form} if self.form else {})


PAPER = (
    Variant("improved-shepard", "mirror", published=True),
    Variant("mls-linear", "mirror", published=True),
    Variant("mls-quadratic", "mirror", published=True),
    Variant("sfdi", "mirror", published=True, form="printed"),
    Variant("normalized", "mirror", published=True),
)
"""the methods that the paper compares, with its lift"""

OURS = (
    Variant("improved-shepard", "balanced"),
    Variant("normalized", "balanced"),
    Variant("shepard", "balanced"),
    Variant("mdbc", "balanced"),
    Variant("adami", "balanced"),
)
"""boundaries beside those of the paper: the balanced lift, the classical Shepard method, and two of other codes"""


def run_with(variant: Variant, label: str, case: str, **parameters: Any) -> RunTask:
    """Return the run of ``case``, preset ``paper``, with ``variant`` as its wall boundary."""
    boundary = wall_boundary(variant.interpolator, variant.lift)
    return run_task(label, case, "paper", **boundary, **parameters)


def row_of_run(
    variant: Variant, dataset: xr.Dataset, numbers: Mapping[str, Cell], *, published: bool
) -> dict[str, Cell]:
    """Return a row of a table: the variant, ``numbers``, the share of the fallback, and whether the run completed."""
    return {
        "boundary": variant.label,
        "of": "the paper" if published else "ours",
        **numbers,
        "fallback (% of wet ghosts)": fallback_share(dataset),
        "to the end": ended(dataset),
    }
