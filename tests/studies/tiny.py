"""A study of one section whose runs take a second.

``python tiny.py OUTPUT`` carries it out on two local workers.
"""

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from sphframe.cases.hydrostatic_tank import HydrostaticTank
from sphframe.studies import (
    Chapter,
    Claim,
    Reference,
    RunTask,
    Section,
    Study,
    Table,
    Task,
    new_figure,
    picture,
    reproduce,
    tidy,
)

HOSTILE = "<script>alert('x')</script> & \"quoted\""
"""a name that must be escaped, as it may come from a plugin or a file"""


def tank(**parameters: Any) -> HydrostaticTank:
    """100 particles at rest."""
    chosen = {"particle_spacing": 0.03, "tank_length": 0.3, "until": 1.0, "probe_interval": 0.01, **parameters}
    return HydrostaticTank(**chosen)


def tasks(quick: bool) -> list[Task]:
    """Four runs that differ in their method."""
    until = 0.2 if quick else 1.5
    methods = ("improved-shepard", "shepard", "normalized", "adami")
    return [RunTask.of(f"tank {m} {HOSTILE}", tank(interpolator=m, until=until)) for m in methods]


def chapter(runs: Mapping[str, xr.Dataset], reference: Reference, quick: bool) -> Chapter:
    """A table, and figures as SVG and as PNG."""
    reference.get("nothing_of_that_name")
    figure = new_figure(4.0, 3.0)
    axes = figure.subplots()
    for label, dataset in runs.items():
        axes.plot(dataset["probe_time"], dataset["probe_pressure"][:, 0], label=label)
    tidy(axes, xlabel="t (s)", ylabel="p (Pa)")
    rows = [
        {"run": label, "mean (Pa)": float(dataset["probe_pressure"][:, 0].mean()), HOSTILE: None}
        for label, dataset in runs.items()
    ]
    return Chapter(
        "tiny",
        f"Tiny {HOSTILE}",
        [HOSTILE],
        [Table("pressures", HOSTILE, rows)],
        [
            picture("pressures", HOSTILE, figure),
            picture("pressures_raster", "The same as a raster.", figure, raster=True),
        ],
        [Claim.judged("Fig. 0", HOSTILE, HOSTILE, HOSTILE, True, HOSTILE), Claim.open("Fig. 1", "b", "c", "d")],
    )


class Tiny(Study):
    """The study of that section, or of those that are given."""

    title = "Tiny tanks"
    source = "Nothing is published."

    def __init__(self, *sections: Section) -> None:
        self._sections = sections or (Section("tiny", tasks, chapter),)

    def sections(self) -> Sequence[Section]:
        return self._sections


if __name__ == "__main__":
    reproduce(Tiny(), output=Path(sys.argv[1]), workers=2)
