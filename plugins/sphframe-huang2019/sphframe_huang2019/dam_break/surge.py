"""Front and height of the column of Martin and Moyce (1952), doi:10.1098/rsta.1952.0006."""

import math
from collections.abc import Mapping

import xarray as xr

from sphframe.analysis import series_error
from sphframe.studies import Cell, Picture, Reference, Table, colour, new_figure, picture, tidy
from sphframe_huang2019.dam_break.runs import BEST, COLUMN_BASE, SQUARE_OF_N, surge_label
from sphframe_huang2019.variants import PAPER

__all__ = ["surge_front"]


def surge_front(runs: Mapping[str, xr.Dataset], reference: Reference) -> tuple[Table, Picture]:
    """Compare front and height of the column with the measured ones, in a table and a figure."""
    measured = {
        "front": reference.get("martin_moyce1952_table_front"),
        "height": reference.get("martin_moyce1952_table_height"),
    }
    figure = new_figure(9.0, 3.6)
    panels = dict(zip(measured, figure.subplots(1, 2), strict=True))
    rows: list[dict[str, Cell]] = []
    for variant in (PAPER[0], BEST):
        row: dict[str, Cell] = {"boundary": variant.label}
        for name, series in _front_and_height(runs[surge_label(variant)]).items():
            if (experiment := measured[name]) is not None:
                error = series_error(series, experiment)
                row |= {f"{name}, {key}": error[key.lower()] for key in ("RMS", "bias", "points")}
            style = "-" if variant.published else "--"
            panels[name].plot(series["t"], series, style, color=colour(variant.method), label=variant.label)
        rows.append(row)
    for name, experiment in measured.items():
        if experiment is not None:
            panels[name].plot(experiment["t"], experiment, "ko", markersize=3, label="Martin and Moyce (1952)")
    tidy(panels["front"], xlabel="n t sqrt(g/a)", ylabel="front / a", title="surge front")
    tidy(panels["height"], xlabel="t sqrt(g/a)", ylabel="height / (n² a)", title="height of the column")
    panels["front"].legend(fontsize=8, frameon=False)
    return (
        Table(
            "surge_front",
            "A column of Martin and Moyce (a = 57.15 mm, height 2 a): differences to their tables",
            rows if any(s is not None for s in measured.values()) else [],
        ),
        picture("surge_front", "Surge front and column height beside the measurements of Martin and Moyce.", figure),
    )


def _front_and_height(dataset: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return front/a over n t sqrt(g/a), and height/(n^2 a) over t sqrt(g/a)."""
    t = dataset["probe_time"].values * math.sqrt(9.81 / COLUMN_BASE)
    front = dataset["front_position"].values / COLUMN_BASE
    height = dataset["column_height"].values / (SQUARE_OF_N * COLUMN_BASE)
    return {
        "front": xr.DataArray(front, coords={"t": t * math.sqrt(SQUARE_OF_N)}),
        "height": xr.DataArray(height, coords={"t": t}),
    }
