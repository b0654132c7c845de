"""Analysis: the parts of a picture: particles, walls, probes, free surface, scales and labels."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely
import xarray as xr

from sphframe.analysis.fields import outline_nodes, particle_weights
from sphframe.analysis.figures import line_style, plain
from sphframe.analysis.placed import probes_at, walls_at
from sphframe.analysis.scales import case_of, pressure_scale, time_scale, wall_method
from sphframe.arrays import Array
from sphframe.errors import InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.collections import EllipseCollection
    from matplotlib.figure import FigureBase
    from matplotlib.lines import Line2D

View = tuple[tuple[float, float], tuple[float, float]]

WALL_COLOUR = "#3b3b3b"
_LEAST_HEIGHT = 1.1
"""of the axes of a picture, inches"""
_EDGE = 0.4  # pt around each particle: without it, antialiased small discs would be pale


@dataclass(frozen=True)
class Field:
    """How a field is drawn: its label, unit, the factor from SI units, and a perceptually uniform colour map."""

    label: str
    unit: str
    factor: float
    colours: str


FIELDS = {
    "pressure": Field("pressure", "kPa", 1e-3, "viridis"),
    "speed": Field("speed", "m/s", 1.0, "cividis"),
    "density": Field("density", "kg/m³", 1.0, "viridis"),
}


def field_to_draw(name: str) -> Field:
    """Return how the field ``name`` is drawn.

    Raises
    ------
    InputError
        there is no such field.
    """
    if name not in FIELDS:
        raise InputError(f"no field {name!r} to draw; choose one of {', '.join(FIELDS)}")
    return FIELDS[name]


def shown_particles(dataset: xr.Dataset, frame: xr.Dataset, values: Array) -> tuple[Array, Array]:
    """Horizontal and vertical positions (n, 2) of the particles to draw, with their values (n,).

    In 2-D all of them, in 3-D those within one spacing of the vertical plane through the middle of the tank.
    """
    position = frame["position"].values
    if position.shape[1] == 2:
        return position, values
    near = np.abs(position[:, 1] - _middle(dataset)) < float(dataset.attrs["particle_spacing"])
    return position[near][:, [0, 2]], values[near]


def _middle(dataset: xr.Dataset) -> float:
    """The y of the vertical plane through the middle of the tank, m."""
    width = outline_nodes(dataset)[:, 1]
    return 0.5 * float(width.min() + width.max())


def draw_particles(axes: "Axes", dataset: xr.Dataset, frame: xr.Dataset, values: Array) -> "EllipseCollection":
    """Draw the particles of ``frame`` as discs of one spacing, coloured by ``values`` (particles,).

    In 3-D only those within one spacing of the middle plane are drawn.
    """
    from matplotlib.collections import EllipseCollection

    position, values = shown_particles(dataset, frame, values)
    # slightly more than the spacing, so that a lattice at rest has no gaps in the picture; layers of a slice coincide
    size = (1.1 if int(dataset.attrs["dimension"]) == 2 else 1.3) * float(dataset.attrs["particle_spacing"])
    collection = EllipseCollection(
        [size],
        [size],
        [0.0],
        units="xy",
        offsets=position,
        offset_transform=axes.transData,
        linewidths=_EDGE,
        edgecolors="face",
        array=np.ma.masked_invalid(values),
        zorder=2,
    )
    axes.add_collection(collection, autolim=False)
    return collection


def draw_walls(axes: "Axes", dataset: xr.Dataset, time: float) -> "list[Line2D]":
    """Draw the walls where they are at ``time``; in 3-D their outlines seen along y."""
    lines = [
        axes.plot([], [], color=WALL_COLOUR, linewidth=1.6, solid_capstyle="round", zorder=3)[0]
        for _ in range(dataset.sizes.get("outline", 0))
    ]
    move_walls(lines, dataset, time)
    return lines


def move_walls(lines: "Sequence[Line2D]", dataset: xr.Dataset, time: float) -> None:
    """Move walls drawn by :func:`draw_walls` to where they are at ``time``."""
    for line, (points, _) in zip(lines, walls_at(dataset, time), strict=True):
        line.set_data(points[:, 0], points[:, -1])


def draw_probes(axes: "Axes", dataset: xr.Dataset, time: float) -> "list[Line2D]":
    """Mark where the pressure probes are at ``time`` (s), in the colours of their series, and return the marks.

    Probes that average over a disc have larger marks, on which those of points can be seen.
    """
    if "probe_pressure" not in dataset:
        return []
    marks = [
        axes.plot([], [], "o", markersize=4 if radius == 0.0 else 8, markeredgecolor="white", markeredgewidth=0.8,
                  zorder=4.5 if radius == 0.0 else 4.2, color=line_style(k)["color"])[0]
        for k, radius in enumerate(dataset["probe_radius"].values)
    ]  # fmt: skip
    move_probes(marks, dataset, time)
    return marks


def move_probes(marks: "Sequence[Line2D]", dataset: xr.Dataset, time: float) -> None:
    """Move marks made by :func:`draw_probes` to where the probes are at ``time`` (s)."""
    for mark, position in zip(marks, probes_at(dataset, time) if marks else (), strict=True):
        mark.set_data([position[0]], [position[-1]])


def draw_gauges(axes: "Axes", dataset: xr.Dataset) -> None:
    """Mark the gauges at rest at the upper edge, in the colours of their series."""
    if "gauge_elevation" in dataset:
        for k in np.flatnonzero(dataset["gauge_body"].values < 0):
            colour = line_style(int(k))["color"]
            place = axes.get_xaxis_transform()
            axes.plot(dataset["gauge_x"].values[k], 0.97, "v", markersize=6, color=colour, transform=place, zorder=4)


def draw_free_surface(axes: "Axes", dataset: xr.Dataset, frame: xr.Dataset) -> None:
    """Draw the line on which the particles fill half of the space, left out within a spacing of walls.

    In 3-D it is that of the particles that are shown.
    """
    from contourpy import contour_generator

    spacing, time = float(dataset.attrs["particle_spacing"]), float(frame["time"])
    area = (dataset["particle_mass"] / frame["density"]).values
    position, area = shown_particles(dataset, frame, area)
    if int(dataset.attrs["dimension"]) == 3:
        area = area / (2.0 * spacing)
    lower, upper = position.min(axis=0) - 3.0 * spacing, position.max(axis=0) + 3.0 * spacing
    x, y = (np.arange(low, high, 0.5 * spacing) for low, high in zip(lower, upper, strict=True))
    nodes = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    rows, _, weight = particle_weights(nodes, position, area, spacing)
    filling = np.bincount(rows, weight, len(nodes)).reshape(len(y), len(x))
    walls = shapely.multilinestrings([shapely.linestrings(points[:, [0, -1]]) for points, _ in walls_at(dataset, time)])
    for line in map(np.asarray, contour_generator(x, y, filling).lines(0.5)):
        line[shapely.distance(shapely.points(line), walls) < spacing] = np.nan
        axes.plot(*line.T, color="white", linewidth=2.4, zorder=5)
        axes.plot(*line.T, color="black", linewidth=1.0, zorder=5)


def view_of(dataset: xr.Dataset, frames: Sequence[xr.Dataset]) -> View:
    """Limits of x and height, m, that show the water and the walls, which may move, in ``frames``, with little air."""
    walls = [wall for frame in frames for wall in walls_at(dataset, float(frame["time"]))]
    nodes = np.concatenate([outline_nodes(dataset), *(points for points, _ in walls)])
    bodies = [points for points, wall in walls if dataset["wall_body"].values[wall] >= 0]
    positions = np.concatenate([shown_particles(dataset, frame, frame["density"].values)[0] for frame in frames])
    x0, x1 = nodes[:, 0].min(), np.fmax(nodes[:, 0].max(), np.nanmax(positions[:, 0]))
    y0 = nodes[:, -1].min()
    # a few drops of spray do not determine the height
    top = max(float(np.nanpercentile(positions[:, -1], 99.8)), float(dataset.attrs["depth"]))
    top = max([top, *(float(points[:, -1].max()) for points in bodies)])
    y1 = min(y0 + 1.15 * (top - y0), max(float(nodes[:, -1].max()), top))
    margin = 0.015 * (x1 - x0)
    below = min(margin, 0.05 * (y1 - y0))  # long flumes are no reason for empty space below their beds
    return (float(x0 - margin), float(x1 + margin)), (float(y0 - below), float(y1 + below))


def style_of(frames: Sequence[xr.Dataset], name: str) -> Field:
    """Return how the field ``name`` of ``frames`` is drawn: pressures that are nowhere 100 Pa in Pa."""
    small = all(float(np.nanmax(np.abs(frame[name].values))) < 100.0 for frame in frames)
    return replace(FIELDS[name], unit="Pa", factor=1.0) if name == "pressure" and small else FIELDS[name]


def colour_limits(dataset: xr.Dataset, frames: Sequence[xr.Dataset], name: str) -> tuple[float, float]:
    """Values at the ends of the colour bar, in the unit of the field.

    They are 0 and rho0 g H for the pressure, and percentiles of the values for other fields.
    """
    factor = style_of(frames, name).factor
    if name == "pressure" and pressure_scale(dataset) > 0.0:
        return 0.0, pressure_scale(dataset) * factor
    values = np.concatenate([frame[name].values for frame in frames]) * factor
    low, high = np.nanpercentile(values, [0.5, 99.5])
    return (0.0 if name == "speed" else float(low)), float(high if high > low else low + 1.0)


def beyond(limits: tuple[float, float], values: Array) -> str:
    """Return at which ends of the colour bar ``values`` lie beyond its ``limits``: neither, min, max or both."""
    below, above = bool(np.nanmin(values) < limits[0]), bool(np.nanmax(values) > limits[1])
    return {(False, False): "neither", (True, False): "min", (False, True): "max"}.get((below, above), "both")


def stretch_of(view: View, width: float) -> int:
    """Return how many times the height is drawn larger than the length, in a panel ``width`` inches wide.

    It is 1 but for flumes, which would else be strips.
    """
    (x0, x1), (y0, y1) = view
    return max(1, math.ceil(_LEAST_HEIGHT / (width * (y1 - y0) / (x1 - x0))))


def with_stretch(title: str, stretch: int) -> str:
    """Return the title of a picture, with how much larger the height is drawn."""
    return title if stretch == 1 else f"{title}  ·  height drawn {stretch} times as large"


def time_label(dataset: xr.Dataset, time: float) -> str:
    """Time in s, and with gravity dimensionless as t sqrt(g/H), as text."""
    if dataset.attrs["gravity"] == 0.0:
        return rf"$t$ = {time:.3f} s"
    return rf"$t$ = {time:.3f} s    ($t\sqrt{{g/H}}$ = {time / time_scale(dataset):.2f})"


def run_title(dataset: xr.Dataset, *, oblique: bool = False) -> str:
    """Case, method, resolution and the status of a run that is not complete; in 3-D the slice, in a second line."""
    title = str(dataset.attrs["title"])
    parts = [
        plain(title[:1].upper() + title[1:]),
        wall_method(case_of(dataset)),
        f"{dataset.sizes['particle']} particles, spacing {1e3 * dataset.attrs['particle_spacing']:.4g} mm",
    ]
    second = []
    if int(dataset.attrs["dimension"]) == 3 and not oblique:
        second.append(f"slice at y = {_middle(dataset):.3g} ± {dataset.attrs['particle_spacing']:.2g} m")
    if dataset.attrs["completed"] != "yes":
        (second or parts).append(str(dataset.attrs["run_status"]))
    return "\n".join("  ·  ".join(line) for line in (parts, second) if line)


def draw_colour_bar(
    figure: "FigureBase", drawn: "ScalarMappable", axes: Any, field: Field, *, size: float, **options: Any
) -> None:
    """Draw the colour bar of ``drawn`` beside ``axes``, labelled in points of ``size``.

    The option ``extend`` says at which ends values lie beyond it, which are then drawn as triangles.
    """
    bar = figure.colorbar(drawn, ax=axes, pad=0.01, fraction=0.03, **options)
    bar.set_label(f"{field.label} ({field.unit})", fontsize=size)
    bar.ax.tick_params(labelsize=size - 1)


def vertical_axis(dataset: xr.Dataset) -> str:
    """Name of the vertical coordinate: ``y`` in 2-D, ``z`` in 3-D."""
    return "xyz"[int(dataset.attrs["dimension"]) - 1]
