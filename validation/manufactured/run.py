"""A manufactured flow with wall treatments: ``python -m validation.manufactured.run --output FOLDER``."""

import json
import math
from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
import xarray as xr

from sphframe import load_case, studies
from validation.command import carry_out

TREATMENTS = {
    "fixed-ghosts": {"name": "fixed-ghosts"},
    "adami-2012": {"name": "adami-2012"},
    "distance-ratio": {"name": "distance-ratio"},
    "mdbc-2022": {"name": "mdbc-2022"},
    "mdbc-2025, corrected": {"name": "mdbc-2025", "velocity": "corrected"},
    "pair-mirror": {"name": "pair-mirror"},
}
FIELDS = {
    "noslip-box": "No slip in a box",
    "freeslip-box": "Slip without stress in a box",
    "noslip-disc": "No slip in a disc",
    "tangent-wave": "Slip at a wavy bed",
}
"""titles of the fields, by name"""
COUNTS = (25, 50, 100)
"""spacings over the unit of length"""
WITHOUT_WALLS = "without walls"


def tasks(field: str, quick: bool) -> list[studies.Task]:
    """Return the runs of ``field``, by resolution and treatment, and of the flow without walls, of side 2."""
    counts, until = ((10, 20), 0.02) if quick else (COUNTS, 0.5)
    found: list[studies.Task] = []
    for count in counts:
        size = {
            "particle_spacing": 1.0 / count,
            "until": until,
            "frame_interval": until / 20.0,
            "probe_interval": until / 20.0,
        }
        for name, treatment in list(TREATMENTS.items())[: 1 if quick else None]:
            chosen = {"field": field, "wall_treatment": treatment}
            found.append(studies.run_task(f"{field}, {name}, {count}", "manufactured", **chosen, **size))
        found.append(studies.run_task(f"periodic, {WITHOUT_WALLS}, {count}", "manufactured", field="periodic", **size))
    return found


def norms(dataset: xr.Dataset) -> xr.Dataset:
    """Return the errors of a run against time."""
    case = load_case("manufactured", None, json.loads(dataset.attrs["case_parameters"]))
    return case.norms(dataset)


def mean_of_late(values: xr.DataArray) -> float:
    """Return the RMS over the second half of the run, since sound passes through the box for all of it."""
    late = values.values[len(values) // 2 :]
    return float(np.sqrt(np.square(late).mean()))


def errors(runs: Mapping[str, xr.Dataset]) -> dict[str, dict[int, xr.Dataset]]:
    """Return the errors of the runs against time, by treatment and count of spacings."""
    found: dict[str, dict[int, xr.Dataset]] = {}
    for label, dataset in runs.items():
        name, count = label.rsplit(", ", 1)
        found.setdefault(name.removeprefix(f"{_field(dataset)}, "), {})[int(count)] = norms(dataset)
    return found


def _field(dataset: xr.Dataset) -> str:
    return str(json.loads(dataset.attrs["case_parameters"])["field"])


def rows(found: Mapping[str, Mapping[int, xr.Dataset]]) -> list[dict[str, studies.Cell]]:
    """Return errors and orders of each treatment."""
    table = []
    for name, by_count in found.items():
        counts = sorted(by_count)
        row: dict[str, studies.Cell] = {"treatment": name}
        for quantity in ("velocity", "pressure", "wall_pressure"):
            if quantity == "wall_pressure" and name == WITHOUT_WALLS:
                continue
            values = [mean_of_late(by_count[count][quantity]) for count in counts]
            word = quantity.replace("_", " ")
            row |= {f"{word}, {count} (%)": 100.0 * value for count, value in zip(counts, values, strict=True)}
            row[f"{word}, order"] = float(-np.polyfit(np.log(counts), np.log(values), 1)[0])
        table.append(row)
    columns = list(dict.fromkeys(column for row in table for column in row))
    return [{column: row.get(column, math.nan) for column in columns} for row in table]


def picture(field: str, found: Mapping[str, Mapping[int, xr.Dataset]]) -> studies.Picture:
    """Draw the errors of velocity and pressure against resolution, and that of velocity against time."""
    figure = studies.new_figure(11.0, 3.6)
    velocity, pressure, time = figure.subplots(1, 3)
    for index, (name, own) in enumerate(found.items()):
        style = {"color": "black" if name == WITHOUT_WALLS else f"C{index}", "label": name, "linewidth": 1.0}
        for axes, quantity in ((velocity, "velocity"), (pressure, "pressure")):
            axes.loglog(sorted(own), [100.0 * mean_of_late(own[n][quantity]) for n in sorted(own)], "o-", **style)
        finest = own[max(own)]
        time.plot(finest["time"], 100.0 * finest["velocity"], **style)
    for axes, title in ((velocity, "velocity (%)"), (pressure, "pressure (%)")):
        studies.tidy(axes, title=title, xlabel="spacings over the unit of length")
    studies.tidy(time, title="velocity (%), finest run", xlabel="time (s)")
    velocity.legend(fontsize=6, loc="lower left")
    return studies.picture(field, f"{FIELDS[field]}: errors against resolution and time.", figure)


def section(field: str) -> studies.Section:
    """Return the section of a field: its runs, and their chapter with table and picture."""

    def chapter(runs: Mapping[str, xr.Dataset], reference: studies.Reference, quick: bool) -> studies.Chapter:
        found = errors(runs)
        table = studies.Table("key_figures", FIELDS[field], rows(found))
        return studies.Chapter(field, FIELDS[field], tables=[table], pictures=[picture(field, found)])

    return studies.Section(field, partial(tasks, field), chapter)


class ManufacturedFlows(studies.Study):
    """Manufactured flows at three resolutions, with several wall treatments."""

    title = "Validation: manufactured flows"
    source = "Idea after P. Negi, P. Ramachandran (2022), arXiv:2208.10848; the fields are those of `manufactured`."

    def sections(self) -> Sequence[studies.Section]:
        """Return a section for each field."""
        return [section(field) for field in FIELDS]


if __name__ == "__main__":
    carry_out(ManufacturedFlows())
