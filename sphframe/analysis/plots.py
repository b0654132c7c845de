"""Analysis: pictures of a run. Needs matplotlib, which is imported on first use and never shows a window."""

import math
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from sphframe.analysis.fields import particles_at
from sphframe.analysis.scales import case_of, pressure_scale, time_scale
from sphframe.errors import InputError, OutputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import EllipseCollection
    from matplotlib.figure import Figure

__all__ = ["draw_particles", "draw_walls", "plot_run"]

Array = NDArray[np.float64]

_WALL_COLOUR = "#3b3b3b"
_FIELDS = {
    "pressure": ("pressure", "kPa", 1e-3, "viridis"),
    "speed": ("speed", "m/s", 1.0, "cividis"),
    "density": ("density", "kg/m³", 1.0, "viridis"),
}


def plot_run(
    dataset: xr.Dataset,
    path: str | os.PathLike[str] | None = None,
    *,
    field: str = "pressure",
    times: Sequence[float] | None = None,
    reference: xr.DataArray | None = None,
) -> "Figure":
    """Draw a run: the particles coloured by a field at several times, with the probes' histories and the energies.

    In 3-D the particles within one spacing of the vertical plane through the middle of the tank are shown.

    Parameters
    ----------
    dataset: the run, finished or still going.
    path: where to save the picture; the suffix chooses the format (.png, .pdf, .svg).
    field: ``pressure``, ``speed`` or ``density``.
    times: times in s; by default four, spread evenly over the run.
    reference: a series of p/(rho0 g H) over t sqrt(g/H), drawn beside the probes.

    Returns
    -------
    The figure.

    Raises
    ------
    InputError: matplotlib is not installed, the run has no frame, or the field or a time is unknown.
    OutputError: the picture cannot be written.
    """
    if field not in _FIELDS:
        raise InputError(f"no field {field!r} to draw; choose one of {', '.join(_FIELDS)}")
    figure_class = _figure_class()
    frames = [particles_at(dataset, time) for time in (_spread(dataset) if times is None else times)]
    view = _view(dataset, frames)
    (x0, x1), (y0, y1) = view
    columns = 1 if len(frames) == 1 else 2
    rows = math.ceil(len(frames) / columns)
    width = 10.0
    panel = (width - 1.6) / columns * (y1 - y0) / (x1 - x0) + 0.32
    panel = min(panel, 4.0)
    below = 2.5 if dataset.sizes["probe_time"] > 1 else 0.0
    figure = figure_class(figsize=(width, rows * panel + below + 0.6), dpi=150, layout="constrained")
    grid = figure.add_gridspec(2 if below else 1, 1, height_ratios=[rows * panel, below] if below else [1.0])
    upper = figure.add_subfigure(grid[0])
    label, unit, factor, colours = _FIELDS[field]
    low, high = _limits(dataset, frames, field, factor)
    panels = upper.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    drawn = None
    for axes, frame in zip(panels.flat, frames, strict=False):
        time = float(frame["time"])
        draw_walls(axes, dataset, time)
        drawn = draw_particles(axes, dataset, frame, frame[field].values * factor)
        drawn.set(cmap=colours, clim=(low, high))
        axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal")
        axes.set_title(_time_label(dataset, time), fontsize=9, loc="left", pad=3)
        axes.tick_params(labelsize=8, length=2)
        axes.spines[["top", "right"]].set_visible(False)
    for axes in panels.flat[len(frames) :]:
        axes.set_axis_off()
    for axes in panels[-1]:
        axes.set_xlabel("x (m)", fontsize=9)
    for axes in panels[:, 0]:
        axes.set_ylabel(f"{'xyz'[_dimension(dataset) - 1]} (m)", fontsize=9)
    assert drawn is not None
    bar = upper.colorbar(drawn, ax=panels, pad=0.01, fraction=0.03, aspect=30, extend="max" if low == 0.0 else "both")
    bar.set_label(f"{label} ({unit})", fontsize=9)
    bar.ax.tick_params(labelsize=8)
    if below:
        lower = figure.add_subfigure(grid[1])
        if "probe_pressure" in dataset:
            left, right = lower.subplots(1, 2, width_ratios=[1.7, 1.0])
            _draw_probes(left, dataset, reference)
        else:
            right = lower.subplots()
        _draw_energies(right, dataset)
    figure.suptitle(_title(dataset), fontsize=11)
    if path is not None:
        _save(figure, path)
    return figure


def draw_particles(axes: "Axes", dataset: xr.Dataset, frame: xr.Dataset, values: Array) -> "EllipseCollection":
    """Draw the particles of ``frame`` as discs of one spacing, coloured by ``values`` (particles,).

    In 3-D only those within one spacing of the middle plane are drawn. Particles without a finite value are drawn in
    the colour of the walls, so that they are not overlooked.
    """
    from matplotlib.collections import EllipseCollection

    position = frame["position"].values
    spacing = float(dataset.attrs["particle_spacing"])
    if position.shape[1] == 3:
        width = dataset["outline_node"].isel(space=1)
        near = np.abs(position[:, 1] - 0.5 * float(width.min() + width.max())) < spacing
        position, values = position[near][:, [0, 2]], values[near]
    # slightly more than the spacing, so that a lattice at rest shows no gaps
    collection = EllipseCollection(
        [1.1 * spacing],
        [1.1 * spacing],
        [0.0],
        units="xy",
        offsets=position,
        offset_transform=axes.transData,
        linewidths=0,
        array=np.ma.masked_invalid(values),
        zorder=2,
    )
    axes.add_collection(collection, autolim=False)
    return collection


def draw_walls(axes: "Axes", dataset: xr.Dataset, time: float) -> None:
    """Draw the walls where they are at ``time``; in 3-D their outlines seen along y."""
    nodes = dataset["outline_node"].values
    ends = np.cumsum(dataset["outline_node_count"].values)
    bodies = dataset["wall_body"].values
    vertical = nodes.shape[1] - 1
    for end, count, wall in zip(
        ends, dataset["outline_node_count"].values, dataset["outline_wall"].values, strict=True
    ):
        line = nodes[end - count : end]
        if bodies[wall] >= 0:
            line = line + _displacement(dataset, int(bodies[wall]), time)[: nodes.shape[1]]
        axes.plot(line[:, 0], line[:, vertical], color=_WALL_COLOUR, linewidth=1.6, solid_capstyle="round", zorder=3)


def _displacement(dataset: xr.Dataset, body: int, time: float) -> Array:
    moved = dataset["body_position"].isel(body=body).values
    return np.array([np.interp(time, dataset["probe_time"].values, moved[:, k]) for k in range(moved.shape[1])])


def _figure_class() -> type["Figure"]:
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise InputError("pictures need matplotlib: install it with pip install 'sphframe[plot]'") from None
    return Figure


def _dimension(dataset: xr.Dataset) -> int:
    return int(dataset.attrs["dimension"])


def _spread(dataset: xr.Dataset) -> list[float]:
    times = dataset["time"].values
    count = len(times)
    if count <= 1:
        return [float(t) for t in times] or [0.0]
    return [float(times[k]) for k in sorted({round(part * (count - 1)) for part in (0.25, 0.5, 0.75, 1.0)})]


def _view(dataset: xr.Dataset, frames: Sequence[xr.Dataset]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Limits of x and height that show the walls, but not much more air than the water needs."""
    nodes = dataset["outline_node"].values
    positions = np.concatenate([frame["position"].values for frame in frames])
    x0, x1 = nodes[:, 0].min(), max(nodes[:, 0].max(), positions[:, 0].max())
    y0 = nodes[:, -1].min()
    # a few drops of spray do not set the scale
    top = max(float(np.nanpercentile(positions[:, -1], 99.8)), float(dataset.attrs["depth"]))
    y1 = min(y0 + 1.15 * (top - y0), max(float(nodes[:, -1].max()), top))
    margin = 0.015 * (x1 - x0)
    return (float(x0 - margin), float(x1 + margin)), (float(y0 - margin), float(y1 + margin))


def _limits(dataset: xr.Dataset, frames: Sequence[xr.Dataset], field: str, factor: float) -> tuple[float, float]:
    if field == "pressure" and pressure_scale(dataset) > 0.0:
        return 0.0, pressure_scale(dataset) * factor
    values = np.concatenate([frame[field].values for frame in frames]) * factor
    low, high = np.nanpercentile(values, [0.5, 99.5])
    return (0.0 if field == "speed" else float(low)), float(high if high > low else low + 1.0)


def _time_label(dataset: xr.Dataset, time: float) -> str:
    return rf"$t$ = {time:.3f} s    ($t\sqrt{{g/H}}$ = {time / time_scale(dataset):.2f})"


def _title(dataset: xr.Dataset) -> str:
    case = case_of(dataset)
    parts = [
        str(dataset.attrs["title"]).capitalize(),
        f"{case['interpolator']['name']}, {case['hydrostatic_lift']} lift",
        f"{dataset.sizes['particle']} particles, spacing {1e3 * dataset.attrs['particle_spacing']:g} mm",
    ]
    if dataset.attrs["completed"] != "yes":
        parts.append(str(dataset.attrs["run_status"]))
    return "  ·  ".join(parts)


def _draw_probes(axes: "Axes", dataset: xr.Dataset, reference: xr.DataArray | None) -> None:
    pressure = dataset["probe_pressure"].load()
    t = pressure["probe_time"].values
    names = [str(name) for name in pressure["probe"].values]
    for k, name in enumerate(names):
        axes.plot(t, pressure.isel(probe=k).values * 1e-3, linewidth=0.9, label=name, zorder=3 - 0.1 * k)
    shown = pressure.values[t > 0.02 * t[-1]] if len(t) > 50 else pressure.values
    high = float(np.nanpercentile(shown, 99.8)) * 1e-3
    low = min(0.0, float(np.nanpercentile(shown, 0.2)) * 1e-3)
    if reference is not None:
        scale = pressure_scale(dataset) * 1e-3
        axes.plot(
            reference[reference.dims[0]].values * time_scale(dataset),
            reference.values * scale,
            ".",
            color="black",
            markersize=3,
            label=str(reference.name or "reference"),
            zorder=4,
        )
        high = max(high, float(reference.max()) * scale)
    axes.set(xlim=(0.0, t[-1]), ylim=(low - 0.05 * (high - low), high + 0.08 * (high - low)))
    axes.set_xlabel("t (s)", fontsize=9)
    axes.set_ylabel("probe pressure (kPa)", fontsize=9)
    axes.legend(fontsize=8, frameon=False, ncols=2, loc="best")
    _tidy(axes)


def _draw_energies(axes: "Axes", dataset: xr.Dataset) -> None:
    t = dataset["probe_time"].values
    start = float(dataset["total_energy"][0]) or 1.0
    for name, style in (("kinetic", "-"), ("potential", "-"), ("internal", "-"), ("total", "--")):
        colour = "black" if name == "total" else None
        axes.plot(t, dataset[f"{name}_energy"].values / start, style, linewidth=1.1, label=name, color=colour)
    axes.set(xlim=(0.0, t[-1]), ylim=(-0.03, 1.35))
    axes.set_xlabel("t (s)", fontsize=9)
    axes.set_ylabel("energy / initial total", fontsize=9)
    axes.legend(fontsize=8, frameon=False, ncols=2, loc="upper right")
    _tidy(axes)


def _tidy(axes: "Axes") -> None:
    axes.tick_params(labelsize=8, length=2)
    axes.grid(linewidth=0.4, alpha=0.4)
    axes.spines[["top", "right"]].set_visible(False)


def _save(figure: Any, path: str | os.PathLike[str]) -> None:
    try:
        figure.savefig(path)
    except (OSError, ValueError) as error:
        raise OutputError(f"cannot write the picture {path}: {error}; choose another name, ending in .png") from None
