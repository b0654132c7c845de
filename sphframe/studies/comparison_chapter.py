"""Studies: the chapter of a comparison of methods: its table and its figures."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from sphframe.analysis.figures import new_figure, plain
from sphframe.studies.chapter import Cell, Chapter, Picture, Table
from sphframe.studies.drawing import colour, picture, thinned, tidy
from sphframe.studies.ensemble import band_table, difference_table


def comparison_chapter(dataset: xr.Dataset, references: Mapping[str, Sequence[xr.DataArray]] | None = None) -> Chapter:
    """Return the tables and figures of a dataset that :func:`sphframe.studies.compare` has made.

    Parameters
    ----------
    references
        series of pressures, Pa, over times, s, that are drawn with those of a probe, by its name.
    """
    return Chapter(
        "comparison",
        "Comparison",
        [
            f"Error: {dataset['error'].attrs['long_name']}"
            + (". " if dataset["error"].attrs["units"] == "1" else ", in Pa. ")
            + "Costs are processor times, which other programs on the machine change little; sphframe bench measures"
            " them more precisely. That of a run includes the compilation of loops that were not in the cache; that per"
            " particle and step does not."
            + (" The machine was not idle: some runs had to wait for processors." if dataset["waited"].any() else "")
        ],
        [
            Table("comparison", "Error and cost of each method at each resolution", _rows(dataset)),
            *([band_table(dataset), difference_table(dataset)] if "peak" in dataset else []),
        ],
        [_curves(dataset), *([_histories(dataset, references or {})] if dataset.sizes["probe"] else [])],
    )


def _rows(dataset: xr.Dataset) -> list[dict[str, Cell]]:
    rows: list[dict[str, Cell]] = []
    for method in dataset["interpolator"].values:
        for spacing in dataset["particle_spacing"].values:
            one = dataset.sel(interpolator=method, particle_spacing=spacing)
            rows.append(
                {
                    "method": str(method),
                    "particle spacing (m)": float(spacing),
                    "particles": int(one["particles"]),
                    "error": float(one["error"]),
                    "observed order": float(one["order"]),
                    "processor time (s)": float(one["processor_time"]),
                    "wall clock (s)": float(one["wall_clock"]),
                    "us per particle and step": float(one["cost"]),
                    "energy above its start (%)": 100.0 * float(one["energy_excess"]),
                    "fallback (% of wet ghosts)": float(one["fallback"]),
                    "to the end": "yes" if int(one["completed"]) else "no",
                }
            )
    return rows


def _curves(dataset: xr.Dataset) -> Picture:
    """Draw error and cost over the particle spacing; of a single spacing, as a bar for each method."""
    shown = [("error", "error"), ("cost", "processor time per particle and step (us)")]
    shown = [(name, label) for name, label in shown if bool((dataset[name] > 0.0).any())]
    figure, methods = new_figure(5.0 * len(shown), 4.0), [str(method) for method in dataset["interpolator"].values]
    for axes, (name, label) in zip(np.atleast_1d(figure.subplots(1, len(shown))), shown, strict=True):
        if dataset.sizes["particle_spacing"] == 1:
            axes.barh(
                [plain(method) for method in methods],
                dataset[name].values[:, 0],
                color=[colour(method) for method in methods],
            )
            axes.invert_yaxis()
            tidy(axes, xlabel=label)
            continue
        for method in methods:
            one = dataset.sel(interpolator=method)
            order = float(one["order"])
            text = method if name != "error" or math.isnan(order) else f"{method}, order {order:.2f}"
            style: dict[str, Any] = {"color": colour(method), "marker": "o", "markersize": 4, "linewidth": 1.0}
            axes.plot(one["particle_spacing"], one[name].where(one[name] > 0.0), label=plain(text), **style)
        tidy(axes, xscale="log", yscale="log", xlabel="particle spacing (m)", ylabel=label)
        axes.legend(fontsize=8, frameon=False)
    return picture("comparison", "Error and cost of each method at each resolution.", figure)


def _histories(dataset: xr.Dataset, references: Mapping[str, Sequence[xr.DataArray]]) -> Picture:
    names = sorted((str(p) for p in dataset["probe"].values), key=lambda name: not references.get(name))[:4]
    figure = new_figure(10.0, 2.4 * len(names) + 0.8)
    panels = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
    for axes, name in zip(panels, names, strict=True):
        for method in dataset["interpolator"].values:
            one = dataset["probe_pressure"].isel(particle_spacing=-1).sel(interpolator=method, probe=name)
            axes.plot(
                *thinned(one["probe_time"], one), color=colour(str(method)), linewidth=0.8, label=plain(str(method))
            )
        for mark, series in zip("ox+^", references.get(name, ()), strict=False):
            style: dict[str, Any] = {"color": "black", "markersize": 3.0, "markerfacecolor": "none"}
            t, p = series[series.dims[0]].values, series.values
            axes.plot(t, p, mark, markeredgewidth=0.7, label=plain(str(series.name)), **style)
        tidy(axes, title=plain(name), ylabel="p (Pa)")
    panels[-1].set_xlabel("t (s)")
    panels[0].legend(fontsize=8, frameon=False, ncols=3)
    return picture("comparison_probes", "Pressure at the probes, finest resolution.", figure)
