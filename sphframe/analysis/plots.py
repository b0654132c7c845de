"""Analysis: pictures of a run. Needs matplotlib, which is imported on first use and never shows a window."""

import math
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from sphframe.analysis.drawing import (
    colour_limits,
    draw_free_surface,
    draw_particles,
    draw_probes,
    draw_walls,
    field_to_draw,
    figure_class,
    run_title,
    tidy,
    time_label,
    view_of,
)
from sphframe.analysis.fields import particles_at
from sphframe.analysis.scales import pressure_scale, time_scale
from sphframe.errors import OutputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_histories", "draw_particles", "draw_walls", "plot_run"]


def plot_run(
    dataset: xr.Dataset,
    path: str | os.PathLike[str] | None = None,
    *,
    field: str = "pressure",
    times: Sequence[float] | None = None,
    reference: xr.DataArray | Sequence[xr.DataArray] | None = None,
    surface: bool = False,
) -> "Figure":
    """Draw a run: the particles coloured by a field at several times, with the probes' histories and the energies.

    In 3-D the particles within one spacing of the vertical plane through the middle of the tank are shown. Circles
    mark the probes. A case without probes shows its gauges instead.

    Parameters
    ----------
    dataset: the run, finished or still going.
    path: where to save the picture; the suffix chooses the format (.png, .pdf, .svg).
    field: ``pressure``, ``speed`` or ``density``.
    times: times in s; by default four, spread evenly over the run.
    reference: one or several series of p/(rho0 g H) over t sqrt(g/H), drawn beside the probes.
    surface: draw the free surface too, the highest fluid in each vertical column.

    Returns
    -------
    The figure.

    Raises
    ------
    InputError: matplotlib is not installed, the run has no frame, or the field or a time is unknown.
    OutputError: the picture cannot be written.
    """
    style = field_to_draw(field)
    make_figure = figure_class()
    frames = [particles_at(dataset, time) for time in (_spread(dataset) if times is None else times)]
    (x0, x1), (y0, y1) = view_of(dataset, frames)
    columns = 1 if len(frames) == 1 else 2
    rows = math.ceil(len(frames) / columns)
    width = 10.0
    panel = (width - 1.6) / columns * (y1 - y0) / (x1 - x0) + 0.32
    panel = min(panel, 4.0)
    below = 2.5 if dataset.sizes["probe_time"] > 1 else 0.0
    figure = make_figure(figsize=(width, rows * panel + below + 1.0), dpi=150, layout="constrained")
    grid = figure.add_gridspec(2 if below else 1, 1, height_ratios=[rows * panel + 0.4, below] if below else [1.0])
    upper = figure.add_subfigure(grid[0])
    low, high = colour_limits(dataset, frames, field)
    panels = upper.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    drawn = None
    for axes, frame in zip(panels.flat, frames, strict=False):
        time = float(frame["time"])
        draw_walls(axes, dataset, time)
        drawn = draw_particles(axes, dataset, frame, frame[field].values * style.factor)
        drawn.set(cmap=style.colours, clim=(low, high))
        draw_probes(axes, dataset)
        if surface:
            draw_free_surface(axes, dataset, time)
        axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal")
        axes.set_title(time_label(dataset, time), fontsize=10, loc="left", pad=3)
        tidy(axes, grid=False)
    for axes in panels.flat[len(frames) :]:
        axes.set_axis_off()
    for axes in panels[-1]:
        axes.set_xlabel("x (m)", fontsize=10)
    for axes in panels[:, 0]:
        axes.set_ylabel(f"{'xyz'[int(dataset.attrs['dimension']) - 1]} (m)", fontsize=10)
    assert drawn is not None
    bar = upper.colorbar(drawn, ax=panels, pad=0.01, fraction=0.03, aspect=30, extend="max" if low == 0.0 else "both")
    bar.set_label(f"{style.label} ({style.unit})", fontsize=10)
    bar.ax.tick_params(labelsize=9)
    if below:
        lower = figure.add_subfigure(grid[1])
        if "probe_pressure" in dataset or "gauge_elevation" in dataset:
            left, right = lower.subplots(1, 2, width_ratios=[1.7, 1.0], gridspec_kw={"wspace": 0.06})
            draw_histories(left, dataset, reference)
        else:
            right = lower.subplots()
        _draw_energies(right, dataset)
    figure.suptitle(run_title(dataset), fontsize=12, wrap=True)
    if path is not None:
        _save(figure, path)
    return figure


def draw_histories(
    axes: "Axes", dataset: xr.Dataset, reference: xr.DataArray | Sequence[xr.DataArray] | None = None
) -> None:
    """Draw the pressure at the probes over time, beside reference series; without probes the elevation at the gauges.

    Parameters
    ----------
    reference: one or several series of p/(rho0 g H) over t sqrt(g/H).
    """
    pressures = "probe_pressure" in dataset
    series = dataset["probe_pressure" if pressures else "gauge_elevation"].load()
    factor = 1e-3 if pressures else 1.0
    t = series["probe_time"].values
    for k, name in enumerate(series[series.dims[1]].values):
        axes.plot(t, series.values[:, k] * factor, linewidth=0.9, label=str(name), zorder=3 - 0.1 * k)
    shown = series.values[t > 0.02 * t[-1]] if len(t) > 50 else series.values
    high, low = (float(np.nanpercentile(shown, percent)) * factor for percent in (99.8, 0.2))
    if pressures:
        low = min(0.0, low)
        for one in [] if reference is None else [reference] if isinstance(reference, xr.DataArray) else reference:
            scale = pressure_scale(dataset) * factor
            label = str(one.name or "reference")
            when = one[one.dims[0]].values * time_scale(dataset)
            axes.plot(when, one.values * scale, ".", markersize=3.5, label=label, zorder=4)
            high = max(high, float(one.max()) * scale)
    span = high - low
    if not span > 1e-9 * max(abs(high), abs(low)):  # a constant series
        span = 0.1 * abs(high) or 1.0
        high, low = high + 0.5 * span, low - (0.0 if low == 0.0 else 0.5 * span)
    axes.set(xlim=_from_start(t), ylim=(low - 0.05 * span, high + 0.08 * span))
    axes.set_xlabel("t (s)", fontsize=10)
    axes.set_ylabel("probe pressure (kPa)" if pressures else "surface elevation (m)", fontsize=10)
    axes.legend(fontsize=9, frameon=False, ncols=2, loc="best")
    tidy(axes)


def _draw_energies(axes: "Axes", dataset: xr.Dataset) -> None:
    t = dataset["probe_time"].values
    start = float(dataset["total_energy"][0]) or 1.0
    for name, style in (("kinetic", "-"), ("potential", "-"), ("internal", "-"), ("total", "--")):
        colour = "black" if name == "total" else None
        axes.plot(t, dataset[f"{name}_energy"].values / start, style, linewidth=1.1, label=name, color=colour)
    highest = max(1.0, float(dataset["total_energy"].max()) / start)
    axes.set(xlim=_from_start(t), ylim=(-0.03, 1.35 * highest))
    axes.set_xlabel("t (s)", fontsize=10)
    axes.set_ylabel("energy / initial total", fontsize=10)
    axes.legend(fontsize=9, frameon=False, ncols=2, loc="upper right")
    tidy(axes)


def _from_start(t: "np.ndarray[Any, np.dtype[np.float64]]") -> tuple[float, float]:
    """Limits of a time axis that are apart, however short the run."""
    return 0.0, float(t[-1]) if t[-1] > 0.0 else 1.0


def _spread(dataset: xr.Dataset) -> list[float]:
    times = dataset["time"].values
    count = len(times)
    if count <= 1:
        return [float(t) for t in times] or [0.0]
    return [float(times[k]) for k in sorted({round(part * (count - 1)) for part in (0.25, 0.5, 0.75, 1.0)})]


def _save(figure: Any, path: str | os.PathLike[str]) -> None:
    try:
        figure.savefig(path)
    except (OSError, ValueError) as error:
        raise OutputError(f"cannot write the picture {path}: {error}; choose another name, ending in .png") from None
