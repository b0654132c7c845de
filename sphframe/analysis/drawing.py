"""Analysis: the parts of a picture: particles, walls, probes, free surface, scales and labels."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from sphframe.analysis.fields import free_surface, outline_nodes
from sphframe.analysis.scales import case_of, pressure_scale, time_scale, wall_method
from sphframe.arrays import Array, IntArray
from sphframe.errors import InputError
from sphframe.geometry import to_world

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.collections import EllipseCollection
    from matplotlib.figure import FigureBase
    from matplotlib.lines import Line2D

View = tuple[tuple[float, float], tuple[float, float]]

_WALL_COLOUR = "#3b3b3b"
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
    InputError: there is no such field.
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
    width = outline_nodes(dataset)[:, 1]
    middle = 0.5 * float(width.min() + width.max())
    near = np.abs(position[:, 1] - middle) < float(dataset.attrs["particle_spacing"])
    return position[near][:, [0, 2]], values[near]


def draw_particles(axes: "Axes", dataset: xr.Dataset, frame: xr.Dataset, values: Array) -> "EllipseCollection":
    """Draw the particles of ``frame`` as discs of one spacing, coloured by ``values`` (particles,).

    In 3-D only those within one spacing of the middle plane are drawn. Particles without a finite value are drawn in
    the colour of the walls, so that they can be seen.
    """
    from matplotlib.collections import EllipseCollection

    position, values = shown_particles(dataset, frame, values)
    spacing = float(dataset.attrs["particle_spacing"])
    # slightly more than the spacing, so that a lattice at rest has no gaps in the picture
    collection = EllipseCollection(
        [1.1 * spacing],
        [1.1 * spacing],
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
        axes.plot([], [], color=_WALL_COLOUR, linewidth=1.6, solid_capstyle="round", zorder=3)[0]
        for _ in range(dataset.sizes.get("outline", 0))
    ]
    move_walls(lines, dataset, time)
    return lines


def move_walls(lines: "Sequence[Line2D]", dataset: xr.Dataset, time: float) -> None:
    """Move walls drawn by :func:`draw_walls` to where they are at ``time``."""
    for line, (points, _) in zip(lines, walls_at(dataset, time), strict=True):
        line.set_data(points[:, 0], points[:, -1])


def walls_at(dataset: xr.Dataset, time: float) -> list[tuple[Array, int]]:
    """Return the polylines (n, dim) of the walls in m at ``time`` (s), each with the index of its wall."""
    if "outline" not in dataset.sizes:
        return []
    nodes = dataset["outline_node"].values
    counts, bodies = dataset["outline_node_count"].values, dataset["wall_body"].values
    result = []
    for end, count, wall in zip(np.cumsum(counts), counts, dataset["outline_wall"].values, strict=True):
        points = nodes[end - count : end]
        if bodies[wall] >= 0:
            points = moved(points, dataset, int(bodies[wall]), time)
        result.append((points, int(wall)))
    return result


def triangles_at(dataset: xr.Dataset, time: float) -> tuple[Array, IntArray]:
    """Return the triangles (t, 3, 3) of the walls of a run in 3-D, m, at ``time`` (s), and their walls (t,)."""
    triangles, walls = dataset["triangle_node"].values.copy(), dataset["triangle_wall"].values
    for wall, body in enumerate(dataset["wall_body"].values):
        if body >= 0:
            own = walls == wall
            triangles[own] = moved(triangles[own].reshape(-1, 3), dataset, int(body), time).reshape(-1, 3, 3)
    return triangles, walls


def ghosts_at(dataset: xr.Dataset, time: float) -> Array:
    """Return the positions of the ghosts (g, dim), m, at ``time`` (s)."""
    position, bodies = dataset["ghost_position"].values.copy(), dataset["ghost_body"].values
    for body in np.unique(bodies[bodies >= 0]):
        position[bodies == body] = moved(position[bodies == body], dataset, int(body), time)
    return position


def draw_probes(axes: "Axes", dataset: xr.Dataset) -> "list[Line2D]":
    """Mark the positions of the pressure probes and return the marks."""
    if "probe_pressure" not in dataset:
        return []
    across, up = dataset["probe_x"].values, dataset[f"probe_{vertical_axis(dataset)}"].values
    return axes.plot(
        across, up, "o", markersize=4, color="white", markeredgecolor="black", markeredgewidth=0.8, zorder=4
    )


def draw_free_surface(axes: "Axes", dataset: xr.Dataset, time: float) -> None:
    """Draw the elevation of the highest fluid; in 3-D in the middle of the tank."""
    surface = free_surface(dataset, time)
    if "y" in surface.dims:
        surface = surface.isel(y=surface.sizes["y"] // 2)
    axes.plot(surface["x"].values, surface.values, color="#d62728", linewidth=1.2, drawstyle="steps-mid", zorder=5)


def view_of(dataset: xr.Dataset, frames: Sequence[xr.Dataset]) -> View:
    """Limits of x and height, m, that show the water and the walls, which may move, in ``frames``, with little air."""
    walls = [wall for frame in frames for wall in walls_at(dataset, float(frame["time"]))]
    nodes = np.concatenate([outline_nodes(dataset), *(points for points, _ in walls)])
    bodies = [points for points, wall in walls if dataset["wall_body"].values[wall] >= 0]
    positions = np.concatenate([frame["position"].values for frame in frames])
    x0, x1 = nodes[:, 0].min(), np.fmax(nodes[:, 0].max(), np.nanmax(positions[:, 0]))
    y0 = nodes[:, -1].min()
    # a few drops of spray do not determine the height
    top = max(float(np.nanpercentile(positions[:, -1], 99.8)), float(dataset.attrs["depth"]))
    top = max([top, *(float(points[:, -1].max()) for points in bodies)])
    y1 = min(y0 + 1.15 * (top - y0), max(float(nodes[:, -1].max()), top))
    margin = 0.015 * (x1 - x0)
    return (float(x0 - margin), float(x1 + margin)), (float(y0 - margin), float(y1 + margin))


def colour_limits(dataset: xr.Dataset, frames: Sequence[xr.Dataset], name: str) -> tuple[float, float]:
    """Values at the ends of the colour bar, in the unit of the field.

    They are 0 and rho0 g H for the pressure, and percentiles of the values for other fields.
    """
    factor = FIELDS[name].factor
    if name == "pressure" and pressure_scale(dataset) > 0.0:
        return 0.0, pressure_scale(dataset) * factor
    values = np.concatenate([frame[name].values for frame in frames]) * factor
    low, high = np.nanpercentile(values, [0.5, 99.5])
    return (0.0 if name == "speed" else float(low)), float(high if high > low else low + 1.0)


def time_label(dataset: xr.Dataset, time: float) -> str:
    """Time in s, and with gravity dimensionless as t sqrt(g/H), as text."""
    if dataset.attrs["gravity"] == 0.0:
        return rf"$t$ = {time:.3f} s"
    return rf"$t$ = {time:.3f} s    ($t\sqrt{{g/H}}$ = {time / time_scale(dataset):.2f})"


def run_title(dataset: xr.Dataset) -> str:
    """One line with case, method and resolution, and with the status of a run that is not complete."""
    parts = [
        str(dataset.attrs["title"]).capitalize(),
        wall_method(case_of(dataset)),
        f"{dataset.sizes['particle']} particles, spacing {1e3 * dataset.attrs['particle_spacing']:g} mm",
    ]
    if dataset.attrs["completed"] != "yes":
        parts.append(str(dataset.attrs["run_status"]))
    return "  ·  ".join(parts)


def draw_colour_bar(
    figure: "FigureBase", drawn: "ScalarMappable", axes: Any, field: Field, *, size: float, **options: Any
) -> None:
    """Draw the colour bar of ``drawn`` beside ``axes``, labelled in points of ``size``.

    The upper end is drawn as a triangle, as values may lie beyond it; so is the lower end unless it is zero.
    """
    extend = "max" if drawn.get_clim()[0] == 0.0 else "both"
    bar = figure.colorbar(drawn, ax=axes, pad=0.01, fraction=0.03, extend=extend, **options)
    bar.set_label(f"{field.label} ({field.unit})", fontsize=size)
    bar.ax.tick_params(labelsize=size - 1)


def vertical_axis(dataset: xr.Dataset) -> str:
    """Name of the vertical coordinate: ``y`` in 2-D, ``z`` in 3-D."""
    return "xyz"[int(dataset.attrs["dimension"]) - 1]


def moved(points: Array, dataset: xr.Dataset, body: int, time: float) -> Array:
    """Return where ``points`` (n, dim) of a ``body``, given as drawn, are at ``time`` (s), m.

    The position of the body is interpolated between samples, its rotation in 3-D along the shortest way.
    """
    times, position = dataset["probe_time"].values, dataset["body_position"].isel(body=body).values
    if not len(times):
        return points
    now = np.array([np.interp(time, times, coordinate) for coordinate in position.T])
    if points.shape[1] == 3 and len(times) > 1:
        from scipy.spatial.transform import Rotation, Slerp

        turning = Slerp(times, Rotation.from_rotvec(position[:, 3:]))
        now[3:] = turning(np.clip(time, times[0], times[-1])).as_rotvec()
    return to_world(points, now, dataset["body_centre"].isel(body=body).values)
