"""Analysis: pictures of a run. They need matplotlib, which is imported on first use and opens no window."""

import math
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from sphframe.analysis.drawing import (
    FIELDS,
    View,
    colour_limits,
    draw_colour_bar,
    draw_free_surface,
    draw_particles,
    draw_probes,
    draw_walls,
    field_to_draw,
    run_title,
    time_label,
    vertical_axis,
    view_of,
)
from sphframe.analysis.exact import draw_exact, exact_case
from sphframe.analysis.fields import particles_at
from sphframe.analysis.figures import figure_class, new_figure, save_figure, tidy
from sphframe.analysis.scales import pressure_scale, time_scale

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WIDTH = 10.0
"""of a picture, inches"""


def plot_run(
    dataset: xr.Dataset,
    path: str | os.PathLike[str] | None = None,
    *,
    field: str = "pressure",
    times: Sequence[float] | None = None,
    reference: xr.DataArray | Sequence[xr.DataArray] | None = None,
    surface: bool = False,
) -> "Figure":
    """Draw a run: particles coloured by a field at several times, the pressure at the probes, and the energies.

    In 3-D the particles within one spacing of the vertical plane through the middle of the tank are shown. Circles
    mark the probes. A case without probes shows its gauges instead, and one with an exact solution run and solution.

    Parameters
    ----------
    dataset: the run, finished or in progress.
    path: where to save the picture; the suffix chooses the format (.png, .pdf, .svg).
    field: ``pressure``, ``speed`` or ``density``.
    times: times in s; by default four that are evenly distributed over the run.
    reference: one or several series of p/(rho0 g H) over t sqrt(g/H), drawn together with the probes.
    surface: draw the free surface too, the highest fluid in each vertical column.

    Returns
    -------
    The figure.

    Raises
    ------
    InputError: matplotlib is not installed, the run has no frame, or the field or a time is unknown.
    OutputError: the picture cannot be written.
    """
    field_to_draw(field)
    figure_class()
    frames = [particles_at(dataset, time) for time in (_spread(dataset) if times is None else times)]
    view = view_of(dataset, frames)
    columns = 1 if len(frames) == 1 else 2
    rows = math.ceil(len(frames) / columns)
    height = rows * _panel_height(view, columns)
    below = 2.5 if dataset.sizes["probe_time"] > 1 else 0.0
    figure = new_figure(_WIDTH, height + below + 1.0, dpi=150)
    grid = figure.add_gridspec(2 if below else 1, 1, height_ratios=[height + 0.4, below] if below else [1.0])
    upper = figure.add_subfigure(grid[0])
    panels = upper.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    _draw_panels(upper, panels, dataset, frames, field, view, surface=surface)
    if below:
        _draw_series(figure.add_subfigure(grid[1]), dataset, reference)
    figure.suptitle(run_title(dataset), fontsize=12, wrap=True)
    if path is not None:
        save_figure(figure, path)
    drawn: Figure = figure
    return drawn


def _panel_height(view: View, columns: int) -> float:
    """Height in inches of a panel, with ``columns`` panels side by side."""
    (x0, x1), (y0, y1) = view
    return min((_WIDTH - 1.6) / columns * (y1 - y0) / (x1 - x0) + 0.32, 4.0)


def _draw_panels(
    figure: Any, panels: Any, dataset: xr.Dataset, frames: list[xr.Dataset], field: str, view: View, *, surface: bool
) -> None:
    """Draw each of ``frames`` in one of the ``panels`` (rows, columns) of ``figure``, with one colour bar for all."""
    style = FIELDS[field]
    limits = colour_limits(dataset, frames, field)
    for axes, frame in zip(panels.flat, frames, strict=False):
        time = float(frame["time"])
        draw_walls(axes, dataset, time)
        drawn = draw_particles(axes, dataset, frame, frame[field].values * style.factor)
        drawn.set(cmap=style.colours, clim=limits)
        draw_probes(axes, dataset)
        if surface:
            draw_free_surface(axes, dataset, time)
        tidy(axes, grid=False, xlim=view[0], ylim=view[1], aspect="equal")
        axes.set_title(time_label(dataset, time), fontsize=10, loc="left", pad=3)
    for axes in panels.flat[len(frames) :]:
        axes.set_axis_off()
    for axes in panels[-1]:
        axes.set_xlabel("x (m)", fontsize=10)
    for axes in panels[:, 0]:
        axes.set_ylabel(f"{vertical_axis(dataset)} (m)", fontsize=10)
    draw_colour_bar(figure, drawn, panels, style, size=10, aspect=30)


def _draw_series(figure: Any, dataset: xr.Dataset, reference: xr.DataArray | Sequence[xr.DataArray] | None) -> None:
    """Draw run and exact solution; without one, the series of probes or gauges, if there are any, and the energies."""
    case = exact_case(dataset)
    if case is not None:
        panels = list(np.atleast_1d(figure.subplots(1, len(case.exact(dataset).data_vars))))
        draw_exact(panels, dataset, case)
        return
    if "probe_pressure" in dataset or "gauge_elevation" in dataset:
        left, right = figure.subplots(1, 2, width_ratios=[1.7, 1.0], gridspec_kw={"wspace": 0.06})
        draw_histories(left, dataset, reference)
    else:
        right = figure.subplots()
    _draw_energies(right, dataset)


def draw_histories(
    axes: "Axes", dataset: xr.Dataset, reference: xr.DataArray | Sequence[xr.DataArray] | None = None
) -> None:
    """Draw the pressure at the probes and reference series over time; without probes, the elevation at the gauges.

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
    """Limits of the time axis, which differ even for a run of one sample."""
    return 0.0, float(t[-1]) if t[-1] > 0.0 else 1.0


def _spread(dataset: xr.Dataset) -> list[float]:
    times = dataset["time"].values
    count = len(times)
    if count <= 1:
        return [float(t) for t in times] or [0.0]
    return [float(times[k]) for k in sorted({round(part * (count - 1)) for part in (0.25, 0.5, 0.75, 1.0)})]
