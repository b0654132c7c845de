"""Analysis: a picture of the walls of a case, of its ghosts and fluid, and of how these fill the kernel."""

import os
from typing import TYPE_CHECKING, Any

import numpy as np

from sphframe.analysis.drawing import WALL_COLOUR
from sphframe.analysis.figures import figure_class, new_figure, plain, save_figure, tidy
from sphframe.arrays import Array, BoolArray
from sphframe.cases import Case
from sphframe.cases.placement import placed_scene
from sphframe.geometry import panels_of
from sphframe.simulation.components import Components
from sphframe.simulation.initial_state import Drawn, drawn, loop_parameters

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_FLUID, _GHOST, _MIRROR = "#9ecae1", "#c9b8a0", "#7a7a7a"
_LARGEST = 3000
"""number of ghosts up to which mirror points are drawn"""


def plot_walls(case: Case, path: str | os.PathLike[str] | None = None, *, numbers: bool = True) -> "Figure":
    """Draw a case as it starts: walls, ghosts, mirror points, fluid, and the filling of the kernel beside the walls.

    Discs have the areas that particles stand for. A line leads from each ghost to its mirror point. Where fluid and
    ghosts fill the kernel, the points beside the walls have the colour of the sum of the kernel over both, which should
    be one; they are grey where the kernel reaches empty space. In 3-D, what is within half a spacing of the vertical
    plane through the middle of the fluid is drawn.

    Parameters
    ----------
    case
        what to draw.
    path
        where to save the picture; the suffix chooses the format (.png, .pdf, .svg).
    numbers
        whether the filling is drawn and the worst place is named.

    Returns
    -------
    Figure
        The figure.

    Raises
    ------
    InputError
        matplotlib is not installed.
    OutputError
        the picture cannot be written.
    """
    figure_class()
    scene = placed_scene(case)
    components = Components.of_case(case)
    start = drawn(case, scene, components, loop_parameters(case, scene, components))
    every = np.vstack([start.position, start.boundary.position])
    lower, upper = every.min(axis=0) - case.particle_spacing, every.max(axis=0) + case.particle_spacing
    width, height = (upper - lower)[[0, -1]]
    drawn_width = 7.0 if width > height else max(7.0 * width / height, 2.5)
    beside, above = (1.5, 1.5) if numbers else (0.7, 0.5)
    figure: Figure = new_figure(drawn_width + beside, drawn_width * height / width + above, dpi=150)
    axes = figure.add_subplot()
    tidy(axes, grid=False, xlabel="x (m)", ylabel=f"{'y' if case.dimension == 2 else 'z'} (m)")
    axes.set(aspect="equal", xlim=(lower[0], upper[0]), ylim=(lower[-1], upper[-1]))
    spacing_in_points = 72.0 * drawn_width * case.particle_spacing / width
    _draw_particles(axes, start, case.particle_spacing, spacing_in_points)
    if numbers:
        _draw_filling(axes, start, case.particle_spacing, spacing_in_points)
        _describe(axes, case, start)
    if path is not None:
        save_figure(figure, path)
    return figure


def _shown(start: Drawn, points: Array, spacing: float) -> BoolArray:
    """Whether each of ``points`` (n, dim) is drawn: all in 2-D, those of one plane in 3-D."""
    if points.shape[1] == 2:
        return np.ones(len(points), dtype=np.bool_)
    return np.asarray(np.abs(points[:, 1] - _middle(start)) <= 0.5 * spacing)


def _middle(start: Drawn) -> float:
    """The y (m) of the vertical plane that is drawn in 3-D."""
    return float(start.position[np.argsort(start.position[:, 1])[len(start.position) // 2], 1])


def _draw_particles(axes: "Axes", start: Drawn, spacing: float, spacing_in_points: float) -> None:
    from matplotlib.collections import EllipseCollection, LineCollection

    boundary = start.boundary
    for label, position, volume, colour in (
        ("fluid", start.position, start.volume, _FLUID),
        ("ghosts", boundary.position, boundary.volume, _GHOST),
    ):
        shown = _shown(start, position, spacing)
        diameter = 0.95 * volume[shown] ** (1.0 / boundary.dim)
        discs = EllipseCollection(
            diameter, diameter, np.zeros(len(diameter)), units="xy", offsets=position[shown][:, [0, -1]],
            offset_transform=axes.transData, facecolors=colour, linewidths=0.0, zorder=1,
        )  # fmt: skip
        axes.add_collection(discs, autolim=False)
        axes.plot([], [], "o", color=colour, label=label)
    shown = _shown(start, boundary.position, spacing)
    if shown.sum() <= _LARGEST:
        ends = np.stack([boundary.position[shown], boundary.mirror[shown]], axis=1)[:, :, [0, -1]]
        axes.add_collection(LineCollection(list(ends), colors=_MIRROR, linewidths=0.25, alpha=0.6, zorder=2))
        axes.plot(
            *ends[:, 1].T, "o", markersize=min(1.0, 0.3 * spacing_in_points), markeredgewidth=0.0, color=_MIRROR,
            zorder=2, label="mirror points of ghosts",
        )  # fmt: skip
    panels = panels_of(boundary.groups, spacing)
    along = np.stack([-panels.area[:, -1], panels.area[:, 0]], axis=1)
    shown = _shown(start, panels.centre, spacing) & (np.abs(along).max(axis=1) > 0.0)
    size = np.linalg.norm(panels.area[shown], axis=1, keepdims=True)
    half = 0.5 * along[shown] * size ** (1.0 / (boundary.dim - 1) - 1.0)  # as long as a square panel is wide
    centre = panels.centre[shown][:, [0, -1]]
    lines = LineCollection(
        list(np.stack([centre - half, centre + half], axis=1)), colors=WALL_COLOUR, linewidths=1.4, label="walls"
    )
    axes.add_collection(lines)


def _draw_filling(axes: "Axes", start: Drawn, spacing: float, spacing_in_points: float) -> None:
    filling, size = start.filling, min(3.0, max(1.5, 0.7 * spacing_in_points))
    shown = _shown(start, filling.points, spacing)
    full, points = filling.full & shown, filling.points[:, [0, -1]]
    near_air = points[shown & ~filling.full].T
    axes.plot(
        *near_air, "o", markersize=size, markeredgewidth=0.0, color="0.6", zorder=4, label="not judged: beside air"
    )
    x, y = points[full].T
    marks = axes.scatter(
        x, y, s=size**2, c=filling.value[full], cmap="coolwarm", vmin=0.75, vmax=1.25, linewidths=0.2,
        edgecolors="0.4", zorder=4,
    )  # fmt: skip
    axes.figure.colorbar(marks, ax=axes, label="filling beside the walls", fraction=0.03, pad=0.01)


def _describe(axes: "Axes", case: Case, start: Drawn) -> None:
    """Name the case, the plane that is drawn and the worst place, and explain the marks."""
    from matplotlib.lines import Line2D

    lines = [plain(case.title) + ("" if case.dimension == 2 else f", y = {_middle(start):.4g} m")]
    filling = start.filling
    if len(filling.value):
        worst = int(np.argmax(np.abs(filling.deviation)))
        place = ", ".join(f"{x:.4g}" for x in filling.points[worst])
        lines.append(f"largest deviation of the filling {filling.deviation[worst]:+.1%} at ({place})")
    axes.set_title("\n".join(lines), fontsize=9.0)
    legend: Any = axes.figure.legend(loc="outside lower center", ncols=5, fontsize=8, frameon=False, handlelength=1.0)
    for handle in legend.legend_handles:
        if isinstance(handle, Line2D):
            handle.set_markersize(5.0)
