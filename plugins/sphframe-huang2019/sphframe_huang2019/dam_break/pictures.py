"""Figures of the dam break."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from sphframe.analysis import particles_at, plot_run, pressure_scale, time_scale
from sphframe.studies import Picture, colour, draw_particles, draw_walls, new_figure, picture, tidy
from sphframe_huang2019.dam_break.far_wall import mean_profile, wall_and_depth
from sphframe_huang2019.dam_break.runs import BEST, label
from sphframe_huang2019.dam_break.sensor import EXPERIMENTS, SENSORS, events, sensor_pressure
from sphframe_huang2019.histories import draw_history
from sphframe_huang2019.variants import PAPER, Variant

__all__ = ["corner_pressures", "sensor_pressures", "snapshots", "wall_profiles"]


def snapshots(dataset: xr.Dataset) -> Picture:
    """Draw the free surface at four times, as Fig. 6, as far as the run came."""
    end = float(dataset["time"][-1])
    times = [t * time_scale(dataset) for t in (1.6, 2.43, 4.5, 5.98)]
    return picture(
        "dam_break_snapshots",
        "As Fig. 6: evolution of the free surface, improved Shepard with the mirror lift.",
        plot_run(dataset, times=[t for t in times if t <= end] or [end]),
        raster=True,
    )


def sensor_pressures(
    runs: Mapping[str, xr.Dataset],
    variants: Sequence[Variant],
    experiments: Mapping[str, xr.DataArray],
    name: str,
    caption: str,
) -> Picture:
    """Draw the pressure at both places of the sensor with ``variants``, as Fig. 7, and the measured series."""
    figure = new_figure(10.0, 7.0)
    for axes, (probe, place) in zip(figure.subplots(2, 1, sharex=True, sharey=True), SENSORS.items(), strict=True):
        for variant in variants:
            series = sensor_pressure(runs[label(variant)], probe)
            draw_history(axes, variant, series["t"], series)
        for (series_name, series), marker in zip(experiments.items(), ("o", "x"), strict=False):
            axes.plot(
                series["t"], series, marker, color="black", markersize=3, linewidth=0, label=EXPERIMENTS[series_name]
            )
        tidy(axes, xlim=(2.0, 7.0), ylim=(-0.3, 1.7), ylabel="p / (rho g H)", title=f"sensor {place}")
    figure.axes[1].set_xlabel("t sqrt(g/H)")
    figure.axes[0].legend(fontsize=8, frameon=False, ncols=3, loc="upper left")
    return picture(name, f"{caption}: pressure on the far wall, running means over 0.1 sqrt(H/g).", figure)


def wall_profiles(runs: Mapping[str, xr.Dataset], experiments: Mapping[str, xr.DataArray]) -> Picture:
    """Draw the mean pressure along the far wall, and the measured plateau at both places of the sensor."""
    figure = new_figure(6.0, 4.2)
    axes = figure.subplots()
    for variant in (*PAPER, BEST):
        line = "-" if variant.published else "--"
        heights, means = mean_profile(runs[label(variant)])
        axes.plot(means, heights, line, color=colour(variant.method), linewidth=1.0, label=variant.label)
    measured = [events(series)["plateau"] for series in experiments.values()]
    for height, marker, name in ((4.0 / 15.0, "o", "where the sensor is"), (4.0 / 15.0 - 0.075, "x", "shifted")):
        if measured:
            axes.plot(float(np.mean(measured)), height, marker, color="black", linewidth=0, label=f"Buchner, {name}")
    tidy(axes, xlabel="p / (rho g H)", ylabel="height / H", xlim=(-0.2, 1.4))
    axes.legend(fontsize=8, frameon=False)
    return picture(
        "dam_break_profile",
        "Mean pressure along the far wall during the plateau, 3.2 to 4.8. It depends strongly on the height.",
        figure,
    )


def corner_pressures(runs: Mapping[str, xr.Dataset]) -> Picture:
    """Draw the pressure near the far lower corner with three methods, as Fig. 8."""
    shown = [v for v in PAPER if v.method in ("normalized", "improved-shepard", "mls-quadratic")]
    figure = new_figure(10.0, 3.6)
    drawn = None
    for axes, variant in zip(figure.subplots(1, len(shown), sharey=True), shown, strict=True):
        dataset = runs[label(variant)]
        right, height = wall_and_depth(dataset)
        time = min(4.0 * time_scale(dataset), float(dataset["time"][-1]))
        frame = particles_at(dataset, time)
        draw_walls(axes, dataset, time)
        drawn = draw_particles(axes, dataset, frame, frame["pressure"].values / pressure_scale(dataset))
        drawn.set(cmap="viridis", clim=(0.0, 1.0))
        axes.set(xlim=(right - 0.8 * height, right + 0.03), ylim=(-0.03, 0.8 * height), aspect="equal", xlabel="x (m)")
        axes.set_title(f"{variant.label}\nt sqrt(g/H) = {time / time_scale(dataset):.2f}", fontsize=9)
    figure.axes[0].set_ylabel("y (m)")
    figure.colorbar(drawn, ax=figure.axes, label="p / (rho g H)", fraction=0.03, pad=0.01)
    return picture("dam_break_corner", "As Fig. 8: pressure near the corner.", figure, raster=True)
