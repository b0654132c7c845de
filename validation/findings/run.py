"""Findings about wall methods, each at two resolutions: ``python -m validation.findings.run --output FOLDER``."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from sphframe import studies
from sphframe.analysis import summary
from validation.command import carry_out

CORRECTED = {
    "improved-shepard": {"wall_treatment": "fixed-ghosts", "interpolator": "improved-shepard"},
    "adami": {"wall_treatment": "fixed-ghosts", "interpolator": "adami"},
    "mdbc": {"wall_treatment": "fixed-ghosts", "interpolator": "mdbc"},
    "distance-ratio": {"wall_treatment": "distance-ratio"},
}
"""methods whose ghosts have the corrected velocity in the continuity, with the parameters that choose them"""
OF_THE_WALL = {name: {"wall_treatment": name} for name in ("adami-2012", "mdbc-2025", "hashemi-2012", "band-2018")}
"""methods whose ghosts have the velocity of the wall in the continuity"""
PAIRWISE = {name: {"wall_treatment": name} for name in ("pair-mirror", "riemann-2017")}
"""methods with a pressure for each pair of particle and ghost"""
GAMMA = {"usaw-2013": {"wall_treatment": "usaw-2013"}}


class Finding(NamedTuple):
    """Runs of a case at two ``spacings`` (m) with ``methods``; ``measure`` returns the columns of a run."""

    case: str
    title: str
    spacings: tuple[float, float]
    methods: Mapping[str, Mapping[str, Any]]
    measure: Callable[[xr.Dataset], Mapping[str, float]]
    parameters: Mapping[str, Any] = {}


def errors(*names: str) -> Callable[[xr.Dataset], dict[str, float]]:
    """Return a function of a run that returns its errors ``names``, in per cent."""

    def of(dataset: xr.Dataset) -> dict[str, float]:
        found = summary(dataset)["errors"]
        return {f"{name} (%)": 100.0 * found[name] for name in names}

    return of


def growth(dataset: xr.Dataset) -> dict[str, float]:
    """Return the growth of the mean density over the last two thirds of the run, in per cent per second."""
    late = dataset["density"].mean("particle").isel(time=slice(dataset.sizes["time"] // 3, None))
    slope = np.polyfit(late["time"], late / dataset.attrs["reference_density"], 1)[0]
    return {"density (% per second)": 100.0 * float(slope)}


FINDINGS = {
    "impact": Finding(
        "column-impact",
        "A column of water hits a wall",
        (0.04, 0.02),
        {**CORRECTED, **OF_THE_WALL},
        errors("plateau", "overshoot"),
    ),
    "dam-break": Finding(
        "dam-break-impact",
        "Pressures of a dam break",
        (0.02, 0.0125),
        {name: {**CORRECTED, **OF_THE_WALL}[name] for name in ("adami", "adami-2012", "mdbc", "mdbc-2025")},
        errors("pressure"),
    ),
    "cavity": Finding(
        "lid-driven-cavity",
        "Density in a closed vessel",
        (0.05, 0.025),
        {**CORRECTED, **OF_THE_WALL, **PAIRWISE},
        growth,
        {"until": 3.0, "frame_interval": 0.25},
    ),
    "jet": Finding(
        "jet-on-plate",
        "Force of a jet on a plate, and the pressure beside it",
        (0.01, 0.00625),
        {**CORRECTED, **OF_THE_WALL, **PAIRWISE, **GAMMA},
        errors("force", "pressure"),
    ),
}


def tasks(finding: Finding, quick: bool) -> list[studies.Task]:
    """Return a run of each method at each spacing; in a quick test of two methods at the coarse one."""
    spacings, methods = finding.spacings, list(finding.methods)
    if quick:
        spacings, methods = spacings[:1], methods[1:2] + [name for name in OF_THE_WALL if name in methods][:1]
    return [
        studies.run_task(
            f"{finding.case}, {name}, {spacing:g}",
            finding.case,
            particle_spacing=spacing,
            **finding.methods[name],
            **finding.parameters,
        )
        for name in methods
        for spacing in spacings
    ]


def chapter(
    name: str, finding: Finding, runs: Mapping[str, xr.Dataset], reference: studies.Reference, quick: bool
) -> studies.Chapter:
    """Return a table with a row for each method, and its picture."""
    rows: dict[str, dict[str, studies.Cell]] = {}
    for label, dataset in runs.items():
        _, method, spacing = label.split(", ")
        kind = "wall" if method in OF_THE_WALL else "corrected" if method in CORRECTED else "own"
        row = rows.setdefault(method, {"method": method, "velocity in the continuity": kind})
        row |= {f"{what}, {spacing} m": value for what, value in finding.measure(dataset).items()}
    table = studies.Table(f"key_figures_{name}", finding.title, list(rows.values()))
    figure = studies.new_figure(7.0, 2.8)
    axes = figure.subplots()
    columns = [key for key in next(iter(rows.values())) if "(%" in key]
    for k, column in enumerate(columns):
        axes.bar(
            np.arange(len(rows)) + 0.8 * k / len(columns), [row[column] for row in rows.values()], 0.8 / len(columns)
        )
    axes.set_xticks(np.arange(len(rows)) + 0.3, list(rows), rotation=30, ha="right", fontsize=7)
    axes.legend(columns, fontsize=6)
    studies.tidy(axes, title=finding.title)
    return studies.Chapter(
        name, finding.title, tables=[table], pictures=[studies.picture(name, f"{finding.title}.", figure)]
    )


class Findings(studies.Study):
    """What the league table shows, with the methods that show why, at two resolutions."""

    title = "Findings about wall methods"
    source = "Cases of sphframe-flows; the methods' sources are in their documentation."

    def sections(self) -> Sequence[studies.Section]:
        """Return one section for each finding."""
        return [
            studies.Section(name, partial(tasks, finding), partial(chapter, name, finding))
            for name, finding in FINDINGS.items()
        ]


if __name__ == "__main__":
    carry_out(Findings())
