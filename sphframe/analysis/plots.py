"""Analysis: pictures of a run. They need matplotlib, which is imported on first use and opens no window."""

import math
import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from sphframe.analysis.drawing import (
    View,
    beyond,
    colour_limits,
    draw_colour_bar,
    draw_free_surface,
    draw_gauges,
    draw_particles,
    draw_probes,
    draw_walls,
    field_to_draw,
    run_title,
    stretch_of,
    style_of,
    time_label,
    vertical_axis,
    view_of,
    with_stretch,
)
from sphframe.analysis.exact import draw_exact, exact_case
from sphframe.analysis.fields import particles_at
from sphframe.analysis.figures import figure_class, new_figure, save_figure, tidy
from sphframe.analysis.histories import history_panels
from sphframe.analysis.oblique import check_oblique, draw_oblique, oblique_view
from sphframe.analysis.reference import shipped_references
from sphframe.cases import ExactCase

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WIDTH = 10.0
"""of a picture, inches"""
_EXACT_COLUMNS = 3
"""panels of an exact solution in a row"""


def plot_run(
    dataset: xr.Dataset,
    path: str | os.PathLike[str] | None = None,
    *,
    field: str = "pressure",
    times: Sequence[float] | None = None,
    reference: xr.DataArray | Sequence[xr.DataArray] | None = None,
    surface: bool = False,
    oblique: bool = False,
    width: float = 10.0,
) -> "Figure":
    """Draw a run: particles coloured by a field at several times, and what was sampled, over time.

    In 3-D the particles within one spacing of the vertical plane through the middle of the tank are shown, and the
    title says so. Circles mark the probes, triangles the gauges, in the colours of their series. Below are the series
    that the run has: probes, gauges, displacements and angles of bodies, forces, and the energies with the work of
    bodies; or, of a case with an exact solution, run and solution. In long flumes the height is drawn larger.

    Parameters
    ----------
    dataset
        the run, finished or in progress.
    path
        where to save the picture; the suffix chooses the format (.png, .pdf, .svg).
    field
        ``pressure``, ``speed`` or ``density``.
    times
        times in s; by default four that are evenly distributed over the run.
    reference
        one or several series of p/(rho0 g H) over t sqrt(g/H), drawn together with the probes; by default those
        that the case ships, such as the measured pressure of the dam break.
    surface
        draw the free surface too: the line on which the particles fill half of the space. With ``oblique`` the surface
        of the water (:func:`sphframe.analysis.water_surface`) is drawn in place of the particles.
    oblique
        show a run in 3-D obliquely from above instead of the slice.
    width
        of the picture, inches; below 10, all panels are drawn below each other.

    Returns
    -------
    Figure
        The figure.

    Raises
    ------
    InputError
        matplotlib is not installed, the run has no frame, the field or a time is unknown, or ``oblique`` is asked
        for in 2-D; with ``oblique`` and ``surface`` also those of :func:`sphframe.analysis.water_surface`.
    OutputError
        the picture cannot be written.
    """
    field_to_draw(field)
    figure_class()
    if oblique:
        check_oblique(dataset, surface=surface)
    frames = [particles_at(dataset, time) for time in (_spread(dataset) if times is None else times)]
    view, exact = (oblique_view if oblique else view_of)(dataset, frames), exact_case(dataset)
    columns = 1 if len(frames) == 1 or width < _WIDTH or stretch_of(view, (width - 1.6) / 2) > 1 else 2
    rows = math.ceil(len(frames) / columns)
    stretch = 1 if oblique else stretch_of(view, (width - 1.6) / columns)
    height = rows * _panel_height(view, (width - 1.6) / columns, stretch)
    given = [reference] if isinstance(reference, xr.DataArray) else reference
    shown = shipped_references(dataset) if given is None else given
    series = history_panels(dataset, shown) if dataset.sizes["probe_time"] > 1 and exact is None else []
    solution = xr.Dataset() if exact is None else exact.exact(dataset)
    beside = 2 if width >= _WIDTH else 1
    below = 2.5 * math.ceil(len(series) / beside) + 2.5 * math.ceil(len(solution.data_vars) / _EXACT_COLUMNS)
    figure = new_figure(width, height + below + 1.0, dpi=150)
    grid = figure.add_gridspec(2 if below else 1, 1, height_ratios=[height + 0.4, below] if below else [1.0])
    upper = figure.add_subfigure(grid[0])
    panels = upper.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    _draw_panels(upper, panels, dataset, frames, field, view, stretch, surface=surface, oblique=oblique)
    if exact is not None:
        _draw_exact_panels(figure.add_subfigure(grid[1]), dataset, exact, solution, shown)
    elif series:
        _draw_series(figure.add_subfigure(grid[1]), series, beside)
    figure.suptitle(with_stretch(run_title(dataset, oblique=oblique), stretch), fontsize=12, wrap=True)
    if path is not None:
        save_figure(figure, path)
    return figure  # type: ignore[no-any-return]


def _draw_exact_panels(
    figure: Any, dataset: xr.Dataset, case: ExactCase, solution: xr.Dataset, references: Sequence[xr.DataArray]
) -> None:
    """Draw the variables of a run beside those of the ``solution`` and the references, in rows of panels."""
    count = len(solution.data_vars)
    shape = (math.ceil(count / _EXACT_COLUMNS), min(count, _EXACT_COLUMNS))
    panels = list(figure.subplots(*shape, squeeze=False).flat)
    draw_exact(panels, dataset, case, solution, references)
    for unused in panels[count:]:
        unused.set_visible(False)


def _panel_height(view: View, width: float, stretch: int) -> float:
    """Height in inches of a panel that is ``width`` inches wide."""
    (x0, x1), (y0, y1) = view
    return min(stretch * width * (y1 - y0) / (x1 - x0) + 0.32, 4.0)


def _draw_panels(
    figure: Any,
    panels: Any,
    dataset: xr.Dataset,
    frames: list[xr.Dataset],
    field: str,
    view: View,
    stretch: int,
    *,
    surface: bool,
    oblique: bool,
) -> None:
    """Draw each of ``frames`` in one of the ``panels`` (rows, columns) of ``figure``, with one colour bar for all."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    style = style_of(frames, field)
    limits = colour_limits(dataset, frames, field)
    for axes, frame in zip(panels.flat, frames, strict=False):
        time, shown = float(frame["time"]), frame[field].values * style.factor
        if oblique:
            draw_oblique(axes, dataset, frame, shown, style.colours, limits, surface=surface)
        else:
            draw_walls(axes, dataset, time)
            draw_particles(axes, dataset, frame, shown).set(cmap=style.colours, clim=limits)
            draw_probes(axes, dataset, time)
            draw_gauges(axes, dataset)
            if surface:
                draw_free_surface(axes, dataset, frame)
        tidy(axes, grid=False, xlim=view[0], ylim=view[1], aspect=stretch)
        axes.set_title(time_label(dataset, time), fontsize=10, loc="left", pad=3)
    for axes in panels.flat[len(frames) :]:
        axes.set_axis_off()
    for axes in panels[-1]:
        axes.set_xlabel("x (m)", fontsize=10)
    for axes in panels[:, 0]:
        axes.set_ylabel(f"{vertical_axis(dataset)} (m)", fontsize=10)
    values = np.concatenate([frame[field].values for frame in frames]) * style.factor
    scale = ScalarMappable(Normalize(*limits), style.colours)
    draw_colour_bar(figure, scale, panels, style, size=10, aspect=30, extend=beyond(limits, values))


def _draw_series(figure: Any, panels: "list[Callable[[Axes], None]]", beside: int) -> None:
    """Draw each of ``panels`` in axes of its own, ``beside`` in a row; one that is left over comes first, alone."""
    rows = math.ceil(len(panels) / beside)
    grid, odd = figure.add_gridspec(rows, beside), len(panels) % beside
    for number, draw in enumerate(panels):
        place = number + odd
        draw(figure.add_subplot(grid[0, :] if odd and number == 0 else grid[place // beside, place % beside]))


def _spread(dataset: xr.Dataset) -> list[float]:
    times = dataset["time"].values
    count = len(times)
    if count <= 1:
        return [float(t) for t in times] or [0.0]
    return [float(times[k]) for k in sorted({round(part * (count - 1)) for part in (0.25, 0.5, 0.75, 1.0)})]
