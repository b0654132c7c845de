"""Analysis: the series of a run over time: probes, gauges, bodies, forces, and the energies with the work of bodies."""

import itertools
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from sphframe.analysis.figures import line_style, plain, printed_unit, tidy
from sphframe.analysis.scales import dimensional
from sphframe.analysis.work import work_of_bodies
from sphframe.arrays import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MOST_LINES = 8
"""drawn in a panel; further walls are left out, which its title says"""


def history_panels(dataset: xr.Dataset, references: Sequence[xr.DataArray] = ()) -> "list[Callable[[Axes], None]]":
    """Return the functions that draw one panel each, of what the run has: probes, gauges, bodies, forces, energies.

    Parameters
    ----------
    references
        series of p/(rho0 g H) over t sqrt(g/H), drawn together with the probes.
    """
    panels: list[Callable[[Axes], None]] = []
    if "probe_pressure" in dataset:
        panels.append(lambda axes: _draw_probes(axes, dataset, references))
    if "gauge_elevation" in dataset:
        panels.append(lambda axes: _draw_gauges(axes, dataset))
    if "body_position" in dataset:
        panels.append(lambda axes: _draw_bodies(axes, dataset))
    if "wall_force" in dataset:
        panels.append(lambda axes: _draw_forces(axes, dataset))
    return [*panels, lambda axes: _draw_energies(axes, dataset)]


def _draw_probes(axes: "Axes", dataset: xr.Dataset, references: Sequence[xr.DataArray]) -> None:
    series = dataset["probe_pressure"].load()
    for mark, one in zip(itertools.cycle("ox+^"), references, strict=False):
        drawn = dimensional(one, dataset)
        t, p = drawn[drawn.dims[0]].values, drawn.values * 1e-3
        style: dict[str, Any] = {"markersize": 3.0, "color": "black", "zorder": 4}
        axes.plot(
            t, p, mark, markerfacecolor="none", markeredgewidth=0.7, label=plain(str(one.name or "reference")), **style
        )
    lines = zip(map(str, series["probe"].values), series.values.T * 1e-3, strict=True)
    _draw_lines(axes, dataset, lines, "probe pressure (kPa)", from_zero=True)


def _draw_gauges(axes: "Axes", dataset: xr.Dataset) -> None:
    series = dataset["gauge_elevation"].load()
    lines = zip(map(str, series["gauge"].values), series.values.T, strict=True)
    _draw_lines(axes, dataset, lines, "surface elevation (m)")


def _draw_bodies(axes: "Axes", dataset: xr.Dataset) -> None:
    """Displacements in m, and in degrees on the right the angles, of the coordinates that change; else of all."""
    space, turns = dataset["space"].values.astype(str), dataset["body_angle"]
    coordinates: list[tuple[str, str, Any, float]] = [("body_position", axis, k, 1.0) for k, axis in enumerate(space)]
    if turns.ndim == 2:
        coordinates.append(("body_angle", "angle", None, float(np.degrees(1.0))))
    else:
        coordinates += [
            ("body_angle", f"angle about {axis}", k, float(np.degrees(1.0))) for k, axis in enumerate(space)
        ]
    known = [
        (f"{body} {axis}", (dataset[name].values[:, b] if k is None else dataset[name].values[:, b, k]) * factor, name)
        for b, body in enumerate(dataset["body"].values.astype(str))
        for name, axis, k, factor in coordinates
    ]
    moving = [one for one in known if np.ptp(one[1]) > 1e-6] or known[: len(space)]
    lengths = [(name, values) for name, values, variable in moving if variable == "body_position"]
    angles = [(name, values) for name, values, variable in moving if variable == "body_angle"]
    label = "displacement of bodies (m)"
    if lengths:
        _draw_lines(axes, dataset, lengths, label)
    if angles:
        other: Any = axes.twinx() if lengths else axes
        _draw_lines(other, dataset, angles, "angle of bodies (°)", start=len(lengths))
        if lengths:
            other.grid(visible=False)
            other.spines["right"].set_visible(True)
            other.get_legend().remove()
            _legend_above(axes, [*axes.get_lines(), *other.get_lines()])


def _draw_forces(axes: "Axes", dataset: xr.Dataset) -> None:
    """Forces of the fluid, by reaction, on moving walls and named parts; where there are none, on all walls."""
    names: dict[str, Any] = {"wall": dataset["wall"].values.astype(str)}
    chosen = [("wall", int(k)) for k in np.flatnonzero(dataset["wall_body"].values >= 0)]
    if "part_force" in dataset:
        names["part"] = dataset["part"].values.astype(str)
        chosen += [("part", k) for k in range(dataset.sizes["part"])]
    chosen = chosen or [("wall", k) for k in range(dataset.sizes["wall"])]
    space = dataset["space"].values.astype(str)
    lines = [
        (f"{names[where][k]} {axis}", dataset[f"{where}_force"].values[:, k, m])
        for where, k in chosen
        for m, axis in enumerate(space)
        if m in (0, len(space) - 1)
    ]
    unit = printed_unit(dataset["wall_force"].attrs["units"])
    factor, prefix = _prefix(max((float(np.abs(v).max(initial=0.0)) for _, v in lines), default=0.0))
    shown = [(name, values * factor) for name, values in lines[:_MOST_LINES]]
    _draw_lines(axes, dataset, shown, f"force of the fluid ({prefix}{unit})")
    if len(lines) > _MOST_LINES:
        axes.set_title(f"{_MOST_LINES} of {len(lines)} forces", fontsize=9, loc="right")


def _draw_energies(axes: "Axes", dataset: xr.Dataset) -> None:
    """Kinetic energy, changes of the others, and the work that bodies have done, which the total should follow."""
    energies = {name: dataset[f"{name}_energy"].values for name in ("kinetic", "potential", "internal", "total")}
    changes = {name: values - (values[0] if name != "kinetic" else 0.0) for name, values in energies.items()}
    styles: dict[str, dict[str, Any]] = {"total": {"color": "black", "linestyle": "--"}}
    work = work_of_bodies(dataset)
    if work is not None:
        changes["work of bodies"], styles["work of bodies"] = (
            work,
            {"color": "0.45", "linestyle": ":", "linewidth": 2.0},
        )
    factor, prefix = _prefix(max(float(np.nanmax(np.abs(values))) for values in changes.values()))
    labels = {"potential": "change of potential", "internal": "change of internal", "total": "change of total"}
    unit = printed_unit(dataset["total_energy"].attrs["units"])
    lines = [(labels.get(name, name), values * factor) for name, values in changes.items()]
    by_label = {labels.get(name, name): style for name, style in styles.items()}
    _draw_lines(axes, dataset, lines, f"energy ({prefix}{unit})", styles=by_label)


def _draw_lines(
    axes: "Axes",
    dataset: xr.Dataset,
    lines: "Iterable[tuple[str, Array]]",
    label: str,
    *,
    from_zero: bool = False,
    start: int = 0,
    styles: dict[str, dict[str, Any]] | None = None,
) -> None:
    """Draw series over the samples' times in full; the limits show every value, and zero if ``from_zero``.

    A series that lies on an earlier one is dashed and above it, so that both are seen.
    """
    t = dataset["probe_time"].values
    before: list[Array] = []
    for k, (name, values) in enumerate(lines):
        style = {"linewidth": 1.1 if k == 0 else 0.9, "zorder": 3 - 0.1 * k, **line_style(start + k)}
        if any(np.nanmax(np.abs(values - other), initial=0.0) <= 0.02 * np.ptp(other) for other in before):
            style |= {"linestyle": (0, (4, 4)), "zorder": 3.5}
        before.append(values)
        axes.plot(t, values, label=plain(name), **(style | (styles or {}).get(name, {})))
    drawn = np.concatenate([np.asarray(line.get_ydata(), dtype=np.float64) for line in axes.get_lines()])
    drawn = drawn[np.isfinite(drawn)] if np.isfinite(drawn).any() else np.zeros(1)
    low, high = float(drawn.min()), float(drawn.max())
    low, high = (min(low, 0.0), max(high, 0.0)) if from_zero else (low, high)
    span = high - low
    if not span > 1e-9 * max(abs(high), abs(low)):  # a constant series
        span = 0.1 * abs(high) or 1.0
        high, low = high + 0.5 * span, low - (0.0 if low == 0.0 else 0.5 * span)
    axes.set(xlim=(0.0, float(t[-1]) if t[-1] > 0.0 else 1.0), ylim=(low - 0.05 * span, high + 0.08 * span))
    axes.set_xlabel("t (s)", fontsize=10)
    axes.set_ylabel(label, fontsize=10)
    _legend_above(axes, axes.get_lines())
    tidy(axes)


def _legend_above(axes: "Axes", lines: Sequence[Any]) -> None:
    """Explain ``lines`` above the axes, where the legend hides none of them."""
    place: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "borderaxespad": 0.1}
    columns = (4 if len(lines) > 6 else 3) if axes.get_figure(root=True).get_figwidth() >= 6.0 else 2  # type: ignore[union-attr]
    axes.legend(handles=lines, fontsize=8, frameon=False, ncols=columns, handlelength=1.8, columnspacing=1.2, **place)


def _prefix(largest: float) -> tuple[float, str]:
    """Return a factor for values up to ``largest``, and the prefix of their unit."""
    return (1e-3, "k") if largest >= 1e3 else (1e3, "m") if 0.0 < largest < 1.0 else (1.0, "")
