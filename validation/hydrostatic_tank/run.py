"""Still water with every method and both lifts: ``python -m validation.hydrostatic_tank.run --output FOLDER``."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from sphframe import studies
from sphframe.analysis import pressure_scale, probe_statistics, rest_pressure, summary
from validation.command import carry_out

METHODS = ("improved-shepard", "normalized", "shepard", "sfdi", "mls-linear", "mls-quadratic")
LIFTS = ("balanced", "mirror")


def tasks(quick: bool) -> list[studies.Task]:
    """Return one run for each lift and method."""
    size = {"particle_spacing": 0.05, "until": 0.1} if quick else {"particle_spacing": 0.01, "until": 5.0}
    methods = ("improved-shepard", "mls-linear") if quick else METHODS
    return [
        studies.run_task(f"{method}, {lift}", "hydrostatic-tank", interpolator=method, hydrostatic_lift=lift, **size)
        for lift in LIFTS
        for method in methods
    ]


def row(dataset: xr.Dataset) -> dict[str, studies.Cell]:
    """Return the errors over the second half of a run, in per cent of rho g H."""
    known, percent = summary(dataset), 100.0 / pressure_scale(dataset)
    probes = probe_statistics(dataset, expected=rest_pressure(dataset, dataset["probe_y"].values))
    mean, deviation = percent * np.abs(probes["error"].values), percent * probes["std"].values
    half = dataset.sel(time=slice(0.5 * float(dataset["time"][-1]), None)).load()
    error = half["pressure"].values - rest_pressure(dataset, half["position"].isel(space=-1).values)
    kinetic = dataset["kinetic_energy"].sel(probe_time=slice(probes.attrs["start"], None)).mean()
    return {
        "lift": known["hydrostatic_lift"],
        "method": known["interpolator"],
        "mean, corner (%)": float(mean[0]),
        "mean, wall (%)": float(mean[1:].max()),
        "std, corner (%)": float(deviation[0]),
        "std, wall (%)": float(deviation[1:].max()),
        "RMS, fluid (%)": percent * float(np.sqrt(np.mean(error**2))),
        "kinetic energy": float(kinetic / dataset["potential_energy"][0]),
        "fallback (% of wet ghosts)": studies.fallback_share(dataset),
        "behind walls": known["particles_outside"],
        "to the end": studies.ended(dataset),
    }


def histories(runs: Mapping[str, xr.Dataset]) -> studies.Picture:
    """Draw the pressure at the probe at a third of the depth, one panel for each lift."""
    figure = studies.new_figure(10.0, 3.6)
    for axes, lift in zip(figure.subplots(1, 2, sharey=True), LIFTS, strict=True):
        for dataset in runs.values():
            known = summary(dataset)
            if known["hydrostatic_lift"] == lift:
                method = known["interpolator"]
                rest = rest_pressure(dataset, dataset["probe_y"].values[1])
                deviation = 100.0 * (dataset["probe_pressure"].isel(probe=1) - rest) / pressure_scale(dataset)
                style = {"color": studies.colour(method), "linewidth": 0.7, "label": method}
                axes.plot(*studies.thinned(dataset["probe_time"], deviation), **style)
        studies.tidy(axes, title=f"{lift} lift", xlabel="t (s)", ylim=(-4.0, 4.0))
    figure.axes[0].set_ylabel("(p - p at rest) / (rho g H), %")
    figure.axes[0].legend(fontsize=8, frameon=False, ncols=2, loc="lower right")
    return studies.picture("probe", "Pressure on the wall, a third of the depth above the bed.", figure)


def chapter(runs: Mapping[str, xr.Dataset], reference: studies.Reference, quick: bool) -> studies.Chapter:
    """Return the table of errors and the pressures at a probe."""
    rows = [row(dataset) for dataset in runs.values()]
    table = studies.Table("key_figures", "Still water, second half of the run", rows)
    return studies.Chapter("hydrostatic-tank", "Still water in a tank", tables=[table], pictures=[histories(runs)])


class StillWater(studies.Study):
    """Still water in a tank: what moves is an error of the wall boundary."""

    title = "Validation: still water in a tank"
    source = "Case of section 4.1 of Huang et al., Water 11 (2019) 1110, doi:10.3390/w11051110."

    def sections(self) -> Sequence[studies.Section]:
        """Return the only section."""
        return [studies.Section("hydrostatic-tank", tasks, chapter)]


if __name__ == "__main__":
    carry_out(StillWater())
