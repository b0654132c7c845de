"""Five cases with every wall treatment: ``python -m validation.wall_treatments.run --output FOLDER``."""

import json
import math
from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
import xarray as xr

from sphframe import available, create, studies
from sphframe.analysis import pressure_scale, rest_pressure, summary, time_scale
from validation.command import carry_out

WAVE = {"tank_length": 2.0, "until": 2.0}
CASES = {
    "tank": ("hydrostatic-tank", {"particle_spacing": 0.02, "until": 1.0}, {"particle_spacing": 0.06}),
    "dam-break": ("dam-break", {"particle_spacing": 0.04, "until": 2.5}, {"particle_spacing": 0.06}),
    "wave": ("solitary-wave-fixed-wall", {"particle_spacing": 0.03125, **WAVE}, {"particle_spacing": 0.0625, **WAVE}),
    "tank-3d": ("hydrostatic-tank", {"particle_spacing": 0.075, "until": 0.5}, {}),
    "dam-break-3d": ("dam-break", {"particle_spacing": 0.075, "until": 1.0}, {"particle_spacing": 0.12}),
}
"""case, its parameters, and those that differ in a quick test"""
TITLES = {
    "tank": "Still water in a tank",
    "dam-break": "Dam break",
    "wave": "Solitary wave against a vertical wall",
    "tank-3d": "Still water in a tank, in three dimensions",
    "dam-break-3d": "Dam break, in three dimensions",
}


def tasks(section: str, quick: bool) -> list[studies.Task]:
    """Return one run for each treatment that works in the dimension of the case."""
    case, size, coarse = CASES[section]
    dim = 3 if section.endswith("-3d") else 2
    names = [entry.name for entry in available("wall_treatments")]
    names = [name for name in names if dim in create("wall_treatments", name).traits.dimensions]
    if quick:
        names, size = ["fixed-ghosts", "lennard-jones"], {**size, **coarse, "until": 0.1}
    size = {
        "dimension": dim,
        "slip": "no",
        "tension": "none",
        "probe_interval": 0.01,
        "frame_interval": 0.02 if section.startswith("tank") else 0.1,
        **size,
    }
    if section == "wave":
        del size["dimension"]
    return [studies.run_task(f"{section}, {name}", case, wall_treatment=name, **size) for name in names]


def hanging(dataset: xr.Dataset) -> int:
    """Return how many particles hang at a wall at the end: they have stayed in one place, with nothing below them.

    Particles count that are within 1.5 spacings of a side wall or a lid, have moved by less than half a spacing since
    the last frame, and have no other particle in the cone of 45 degrees below them, to a depth of three spacings.
    """
    if dataset.sizes["time"] < 2:
        return 0
    spacing, case = float(dataset.attrs["particle_spacing"]), json.loads(dataset.attrs["case_parameters"])
    before, x = (dataset["position"].isel(time=k).values for k in (-2, -1))
    still = np.linalg.norm(x - before, axis=1) < 0.5 * spacing
    sides = np.minimum(x[:, 0], case["tank_length"] - x[:, 0])
    still &= np.minimum(sides, case["tank_height"] - x[:, -1]) < 1.5 * spacing
    still &= x[:, -1] > 1.5 * spacing
    count = 0
    for place in x[still]:
        below = place[-1] - x[:, -1]
        aside = np.linalg.norm(x[:, :-1] - place[:-1], axis=1)
        count += not np.any((below > 0.0) & (below < 3.0 * spacing) & (aside < below))
    return count


def row(section: str, dataset: xr.Dataset) -> dict[str, studies.Cell]:
    """Return the key figures of a run."""
    known = summary(dataset)
    speed = np.linalg.norm(dataset["velocity"].values, axis=2)
    depth = float(pressure_scale(dataset)) / (1000.0 * 9.81)
    found: dict[str, studies.Cell] = {"treatment": known["wall_treatment"]}
    if section.startswith("tank"):
        error = dataset["pressure"].values - rest_pressure(dataset, dataset["position"].isel(space=-1).values)
        half = slice(dataset.sizes["time"] // 2, None)
        found["fastest particle (% of sqrt(g H))"] = 100.0 * float(np.nanmax(speed)) / math.sqrt(9.81 * depth)
        found["RMS pressure error (% of rho g H)"] = 100.0 * float(
            np.sqrt(np.nanmean(error[half] ** 2)) / pressure_scale(dataset)
        )
    elif section.startswith("dam-break"):
        arrival = known["front_arrival"]
        found["front arrives (t sqrt(g/H))"] = arrival["dimensionless"] if arrival else math.nan
        found["end (t sqrt(g/H))"] = float(dataset["time"][-1]) / float(time_scale(dataset))
        found["hanging at the end"] = hanging(dataset)
    else:
        near = dataset["position"].isel(space=0) > float(dataset["position"].isel(space=0).max()) - 0.2
        found["highest water at the wall (m)"] = float(dataset["position"].isel(space=1).where(near).max())
    return found | {
        "energy excess (%)": 100.0 * known["energy_excess"],
        "behind walls": known["particles_outside"],
        "to the end": studies.ended(dataset),
    }


def picture(section: str, runs: Mapping[str, xr.Dataset]) -> studies.Picture:
    """Draw the last frame of each run: pressure against height in the tanks, else the particles."""
    columns = 4
    figure = studies.new_figure(12.0, 2.2 * math.ceil(len(runs) / columns))
    every = figure.subplots(math.ceil(len(runs) / columns), columns, sharex=True, sharey=True, squeeze=False)
    for axes in every.flat[len(runs) :]:
        axes.axis("off")
    for axes, dataset in zip(every.flat, runs.values(), strict=False):
        last = dataset.isel(time=-1)
        height, pressure = last["position"].isel(space=-1).values, last["pressure"].values
        if section.startswith("tank"):
            axes.plot(pressure / 1000.0, height, ".", markersize=1.5)
            axes.plot(rest_pressure(dataset, np.sort(height)) / 1000.0, np.sort(height), "k-", linewidth=0.7)
        else:
            scale = float(pressure_scale(dataset))
            x = last["position"].isel(space=0).values
            axes.scatter(x, height, c=pressure, s=1.0, vmin=0.0, vmax=scale, cmap="viridis")
        studies.tidy(axes, title=summary(dataset)["wall_treatment"])
    what = (
        "Pressure (kPa) against height (m); line: at rest." if section.startswith("tank") else "Particles at the end."
    )
    return studies.picture(section, f"{TITLES[section]}. {what}", figure, raster=True)


def chapter(section: str, runs: Mapping[str, xr.Dataset], reference: studies.Reference, quick: bool) -> studies.Chapter:
    """Return table and picture of a case."""
    rows = [row(section, dataset) for dataset in runs.values()]
    table = studies.Table(f"key_figures_{section}", TITLES[section], rows)
    return studies.Chapter(section, TITLES[section], tables=[table], pictures=[picture(section, runs)])


class WallTreatments(studies.Study):
    """Every wall treatment in five cases: which ones hold still water, a dam break and a wave."""

    title = "Validation: wall treatments"
    source = "Cases of sections 4.1 to 4.3 of Huang et al., Water 11 (2019) 1110, doi:10.3390/w11051110, coarse."

    def sections(self) -> Sequence[studies.Section]:
        """Return one section for each case."""
        return [studies.Section(name, partial(tasks, name), partial(chapter, name)) for name in CASES]


if __name__ == "__main__":
    carry_out(WallTreatments())
