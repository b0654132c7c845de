"""The dam break with every method: ``python -m validation.dam_break.run --output FOLDER --reference FOLDER``."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from sphframe import studies
from sphframe.analysis import plot_run, series_error, summary, time_scale
from validation.command import carry_out
from validation.dam_break.wall import PLATEAU, pressure_beside_wall, wall_pressure

METHODS = ("improved-shepard", "normalized", "shepard", "sfdi", "mls-linear", "mls-quadratic")
EXPERIMENT = "buchner2002_P1_second"


def tasks(quick: bool) -> list[studies.Task]:
    """Return one run for each method."""
    size = {"particle_spacing": 0.06, "until": 0.1} if quick else {"particle_spacing": 0.01}
    methods = ("improved-shepard", "mls-linear") if quick else METHODS
    return [studies.run_task(method, "dam-break", interpolator=method, **size) for method in methods]


def row(dataset: xr.Dataset, experiment: xr.DataArray | None) -> dict[str, studies.Cell]:
    """Return the key figures of a run; times over sqrt(H/g), pressures over rho g H."""
    known, p1 = summary(dataset), wall_pressure(dataset)
    first, second = p1.sel(t=slice(2.3, 3.2)), p1.sel(t=slice(5.0, 7.0))
    comparable = experiment is not None and p1.size and float(p1["t"][-1]) > PLATEAU.start
    plateau = dataset.sph.dimensionless("probe_pressure").sel(probe="P1", probe_time=PLATEAU)
    return {
        "method": known["interpolator"],
        "front arrives": known["front_arrival"]["dimensionless"] if known["front_arrival"] else math.nan,
        "first peak": float(first.max()) if first.size else math.nan,
        "plateau": float(plateau.mean()),
        "plateau, std": float(plateau.std()),
        "plateau at 0.2 H": pressure_beside_wall(dataset, 0.2),
        "second peak": float(second.max()) if second.size else math.nan,
        "RMS to experiment": series_error(p1, experiment)["rms"] if comparable else math.nan,
        "energy excess (%)": 100.0 * known["energy_excess"],
        "behind walls": known["particles_outside"],
        "fallback (% of wet ghosts)": studies.fallback_share(dataset),
        "to the end": studies.ended(dataset),
    }


def pressures(runs: Mapping[str, xr.Dataset], experiment: xr.DataArray | None) -> studies.Picture:
    """Draw the pressure at the sensor with all methods, and the measured one."""
    figure = studies.new_figure(10.0, 4.2)
    axes = figure.subplots()
    for method, dataset in runs.items():
        p1 = wall_pressure(dataset)
        axes.plot(*studies.thinned(p1["t"], p1), color=studies.colour(method), linewidth=0.9, label=method)
    if experiment is not None:
        axes.plot(experiment["t"], experiment, "k.", markersize=4, label="Buchner (2002), measured")
    studies.tidy(axes, xlim=(2.0, 7.0), ylim=(-0.2, 1.6), xlabel="t sqrt(g/H)", ylabel="p / (rho g H)")
    axes.legend(fontsize=8, frameon=False, ncols=2, loc="upper left")
    return studies.picture("wall_pressure", "Pressure at P1, running mean over 0.1 sqrt(H/g).", figure)


def chapter(runs: Mapping[str, xr.Dataset], reference: studies.Reference, quick: bool) -> studies.Chapter:
    """Return the table of key figures, the pressures at the sensor, and the particles at four times."""
    experiment, first = reference.get(EXPERIMENT), next(iter(runs.values()))
    rows = [row(dataset, experiment) for dataset in runs.values()]
    end = float(first["time"][-1])
    times = [t for t in np.array([1.6, 2.5, 4.5, 6.2]) * time_scale(first) if t <= end] or [end]
    particles = studies.picture("particles", "Particles at four times.", plot_run(first, times=times), raster=True)
    caption = "Dam break: times over sqrt(H/g), pressures over rho g H"
    table = studies.Table("key_figures", caption, rows)
    return studies.Chapter("dam-break", "Dam break", tables=[table], pictures=[pressures(runs, experiment), particles])


class DamBreak(studies.Study):
    """The dam break against a vertical wall, compared with the measured pressure."""

    title = "Validation: dam break against a vertical wall"
    source = (
        "Case of section 4.2 of Huang et al., Water 11 (2019) 1110, doi:10.3390/w11051110; experiment: Buchner 2002."
    )

    def sections(self) -> Sequence[studies.Section]:
        """Return the only section."""
        return [studies.Section("dam-break", tasks, chapter)]


if __name__ == "__main__":
    carry_out(DamBreak())
