"""A solitary wave on the wall that leans outward by 120 degrees, with three methods."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from sphframe import studies
from sphframe.analysis import summary
from sphframe.cases import load_case
from validation.solitary_wave.waves import FLUME, crests, seawall_force

METHODS = ("improved-shepard", "mls-linear", "sfdi")


def tasks(quick: bool) -> list[studies.Task]:
    """Return the runs, in a flume of 3 m and with adaptive time steps."""
    own: dict[str, Any] = {"tank_length": 3.0, "time_step": None, "frame_interval": 0.1}
    if quick:
        own |= {"tank_length": 2.0, "particle_spacing": 0.05}
    methods = METHODS[:1] if quick else METHODS
    return [studies.run_task(f"leaning {method}", FLUME, "paper", interpolator=method, **own) for method in methods]


def row(dataset: xr.Dataset) -> dict[str, studies.Cell]:
    """Return the key figures of a run; pressures in Pa, lengths over d, forces over rho g d^2 / 2."""
    pressure, depth = dataset["probe_pressure"], float(dataset.attrs["depth"])
    x, t, height = crests(dataset)
    speed, start = np.polyfit(t[3:-1], x[3:-1], 1)
    toe = float(np.max(x)) / 0.9
    arrival = float((toe - start) / speed)
    quiet = pressure.sel(probe_time=slice(0.05, arrival - 8.0 * depth / speed))
    return {
        "method": summary(dataset)["interpolator"],
        "flume (m)": toe,
        **{f"P{k} before the wave (Pa)": float(quiet[:, k].mean()) for k in range(2)},
        **{f"P{k} before the wave, std (Pa)": float(quiet[:, k].std()) for k in range(2)},
        **{f"P{k} largest (Pa)": float(pressure[:, k].max()) for k in range(2)},
        "A/d sent": float(np.median(height[3:-1])) / depth,
        "crest at the toe (s)": arrival,
        "crest at the toe by Rayleigh's c (s)": float(load_case(FLUME, "paper").paddle().arrival_time(toe)),  # type: ignore[attr-defined]
        "run-up": float(dataset["run_up"].max()) / depth,
        "force": float(seawall_force(dataset).max()),
        "fallback (% of wet ghosts)": studies.fallback_share(dataset),
        "behind walls": int(dataset["particles_outside"].max()),
        "to the end": studies.ended(dataset),
    }


def pressures(runs: Mapping[str, xr.Dataset]) -> studies.Picture:
    """Draw the pressures at P0 and P1."""
    figure = studies.new_figure(9.0, 3.4)
    for k, axes in enumerate(figure.subplots(1, 2)):
        for dataset in runs.values():
            method, p = summary(dataset)["interpolator"], dataset["probe_pressure"][:, k] / 1000.0
            axes.plot(*studies.thinned(p["probe_time"], p), color=studies.colour(method), linewidth=0.8, label=method)
        studies.tidy(axes, xlabel="t (s)", ylabel=f"P{k} (kPa)")
    axes.legend(frameon=False)
    return studies.picture("leaning_wall", "Pressure at P0 and P1 on the leaning wall.", figure)


def chapter(runs: Mapping[str, xr.Dataset], reference: studies.Reference, quick: bool) -> studies.Chapter:
    """Return the table of pressures and run-ups, and the pressures over time."""
    table = studies.Table(
        "key_figures_leaning",
        "Wall leaning outward by 120 degrees: pressures in Pa, lengths over d, forces over rho g d^2 / 2",
        [row(dataset) for dataset in runs.values()],
    )
    return studies.Chapter("leaning-wall", "Leaning wall", tables=[table], pictures=[pressures(runs)])


SECTION = studies.Section("leaning-wall", tasks, chapter)
