"""A manufactured flow with wall treatments: ``python -m validation.manufactured.run --output FOLDER``."""

import json
import math
from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from sphframe import load_case, studies
from validation.command import carry_out

TREATMENTS = {
    "fixed-ghosts": {"name": "fixed-ghosts"},
    "adami-2012": {"name": "adami-2012"},
    "distance-ratio": {"name": "distance-ratio"},
    "mdbc-2022": {"name": "mdbc-2022"},
    "mdbc-2025": {"name": "mdbc-2025"},
    "mdbc-2025, corrected": {"name": "mdbc-2025", "velocity": "corrected"},
    "mirror-images": {"name": "mirror-images"},
    "pair-mirror": {"name": "pair-mirror"},
}
COUNTS = (25, 50, 100)
"""spacings over the side of the box"""
WITHOUT_WALLS = "periodic, without walls"


def tasks(quick: bool) -> list[studies.Task]:
    """Return the runs of the flow with no slip in a box, by treatment and resolution, and of the one without walls.

    Without walls the square has twice the side, so that at 100 spacings it would have 40,000 particles: it is left out.
    """
    counts, until = ((10, 20), 0.02) if quick else (COUNTS, 0.5)
    names = list(TREATMENTS)[: 1 if quick else None]
    given = {"until": until, "frame_interval": until / 20.0}
    found: list[studies.Task] = []
    for count in counts:
        size = {"particle_spacing": 1.0 / count, **given}
        for name in names:
            chosen = {"field": "noslip-box", "wall_treatment": TREATMENTS[name]}
            found.append(studies.run_task(f"{name}, {count}", "manufactured", **chosen, **size))
        if count < 100:
            found.append(studies.run_task(f"{WITHOUT_WALLS}, {count}", "manufactured", field="periodic", **size))
    return found


def norms(dataset: xr.Dataset) -> xr.Dataset:
    """Return the errors of a run against time."""
    case = load_case("manufactured", None, json.loads(dataset.attrs["case_parameters"]))
    return case.norms(dataset)


def mean_of_late(values: xr.DataArray) -> float:
    """Return the RMS over the second half of the run, since sound passes through the box for all of it."""
    late = values.values[len(values) // 2 :]
    return float(np.sqrt(np.square(late).mean()))


def rows(runs: Mapping[str, xr.Dataset]) -> list[dict[str, studies.Cell]]:
    """Return errors and orders of each treatment."""
    errors: dict[str, dict[int, xr.Dataset]] = {}
    for label, dataset in runs.items():
        name, count = label.rsplit(", ", 1)
        errors.setdefault(name, {})[int(count)] = norms(dataset)
    found = []
    for name, by_count in errors.items():
        counts = sorted(by_count)
        row: dict[str, studies.Cell] = {"treatment": name}
        for quantity in ("velocity", "pressure", "wall_pressure"):
            if quantity == "wall_pressure" and name == WITHOUT_WALLS:
                continue
            values = [mean_of_late(by_count[count][quantity]) for count in counts]
            word = quantity.replace("_", " ")
            row |= {f"{word}, {count} (%)": 100.0 * value for count, value in zip(counts, values, strict=True)}
            row[f"{word}, order"] = float(-np.polyfit(np.log(counts), np.log(values), 1)[0])
        found.append(row)
    columns = list(dict.fromkeys(column for row in found for column in row))
    return [{column: row.get(column, math.nan) for column in columns} for row in found]


def picture(runs: Mapping[str, xr.Dataset]) -> studies.Picture:
    """Draw the errors of velocity and pressure against resolution, and that of velocity against time."""
    figure = studies.new_figure(11.0, 3.6)
    velocity, pressure, time = figure.subplots(1, 3)
    names = list(dict.fromkeys(label.rsplit(", ", 1)[0] for label in runs))
    for index, name in enumerate(names):
        own = {int(label.rsplit(", ", 1)[1]): norms(d) for label, d in runs.items() if label.rsplit(", ", 1)[0] == name}
        style = {"color": "black" if name == WITHOUT_WALLS else f"C{index}", "label": name, "linewidth": 1.0}
        for axes, quantity in ((velocity, "velocity"), (pressure, "pressure")):
            axes.loglog(list(own), [100.0 * mean_of_late(found[quantity]) for found in own.values()], "o-", **style)
        finest = own[max(own)]
        time.plot(finest["time"], 100.0 * finest["velocity"], **style)
    for axes, title in ((velocity, "velocity (%)"), (pressure, "pressure (%)")):
        studies.tidy(axes, title=title, xlabel="spacings over the side")
    studies.tidy(time, title="velocity (%), finest run", xlabel="time (s)")
    velocity.legend(fontsize=6)
    return studies.picture("manufactured", "Errors against resolution and time.", figure)


def chapter(runs: Mapping[str, xr.Dataset], reference: studies.Reference, quick: bool) -> studies.Chapter:
    """Return table and picture."""
    title = "Flow with no slip in a box"
    table = studies.Table("key_figures", title, rows(runs))
    return studies.Chapter("manufactured", title, tables=[table], pictures=[picture(runs)])


class ManufacturedFlows(studies.Study):
    """A manufactured flow with no slip, at three resolutions, with several wall treatments."""

    title = "Validation: manufactured flow"
    source = "Idea after P. Negi, P. Ramachandran (2022), arXiv:2208.10848; the fields are those of `manufactured`."

    def sections(self) -> Sequence[studies.Section]:
        """Return the section."""
        return [studies.Section("manufactured", tasks, chapter)]


if __name__ == "__main__":
    carry_out(ManufacturedFlows())
