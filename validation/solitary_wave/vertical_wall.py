"""Solitary waves on a vertical wall, compared with exact potential flow."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from sphframe import studies
from sphframe.analysis import time_scale
from validation.solitary_wave.waves import FLUME, crests, seawall_force

EXACT = {
    0.1: {"speed": 1.0485482, "run_up": 0.205553, "force": 1.42443},
    0.3: {"speed": 1.137523, "run_up": 0.660213, "force": 2.3006},
}
"""exact potential flow by A/d: speed over sqrt(g d), run-up over d and force over rho g d^2 / 2 on a vertical wall"""
PARAMETERS: dict[str, dict[str, Any]] = {
    "vertical 0.3, long flume": {"tank_length": 8.0, "gauge_positions": tuple(0.5 * k for k in range(2, 16))},
    "vertical 0.3": {"tank_length": 4.0},
    "vertical 0.1": {"tank_length": 4.0, "wave_height": 0.025},
}
"""of the runs, by their labels"""


def tasks(quick: bool) -> list[studies.Task]:
    """Return the waves of 0.3 d in a long flume, for speed and loss, and of 0.3 d and 0.1 d in short ones."""
    labels = list(PARAMETERS)[1:] if quick else PARAMETERS
    coarse: dict[str, Any] = {"particle_spacing": 0.05} if quick else {}
    return [studies.run_task(label, FLUME, **PARAMETERS[label], frame_interval=0.25, **coarse) for label in labels]


def row(ratio: float, flume: xr.Dataset, travel: tuple[float, float], wall: xr.Dataset) -> dict[str, studies.Cell]:
    """Return the key figures: speed and loss in ``flume`` over ``travel`` (m), the others in ``wall``."""
    depth, gravity = float(flume.attrs["depth"]), float(flume.attrs["gravity"])
    x, t, height = crests(flume)
    on_the_way = (x >= travel[0]) & (x <= travel[1])
    speed = float(np.polyfit(t[on_the_way], x[on_the_way], 1)[0] / np.sqrt(gravity * depth))
    slope, start = np.polyfit(x[on_the_way] / depth, height[on_the_way] / depth, 1)
    sent = float(start + slope * travel[0] / depth)
    run_up, force, exact = wall["run_up"] / depth, seawall_force(wall), EXACT[ratio]
    found = {"speed": speed, "run-up": float(run_up.max()), "force": float(force.max())}
    errors = {f"{name}, error (%)": 100.0 * (found[name] / exact[name.replace("-", "_")] - 1.0) for name in found}
    return {
        "A/d asked for": ratio,
        "A/d sent": sent,
        "height lost over 20 d (%)": -2000.0 * float(slope) / sent if np.ptp(travel) >= 20.0 * depth else None,
        **found,
        **errors,
        "force by pressure": float(seawall_force(wall, "wall_force_by_pressure").max()),
        "force peaks after run-up by": float(force.idxmax() - run_up.idxmax()) / time_scale(wall),
        "fallback (% of wet ghosts)": studies.fallback_share(wall),
        "behind walls": int(max(dataset["particles_outside"].max() for dataset in (flume, wall))),
        "to the end": studies.ended(wall),
    }


def histories(runs: Mapping[str, xr.Dataset], reference: studies.Reference) -> studies.Picture:
    """Draw run-up and force, and those of exact potential flow where they are given."""
    figure = studies.new_figure(9.0, 3.4)
    panels = figure.subplots(1, 2)
    for k, (label, dataset) in enumerate((name, runs[name]) for name in ("vertical 0.3", "vertical 0.1")):
        run_up = dataset["run_up"] / dataset.attrs["depth"]
        t = (run_up["probe_time"] - float(run_up.idxmax())) / time_scale(dataset)
        ratio = label.split()[-1]
        for column, (axes, series) in enumerate(zip(panels, (run_up, seawall_force(dataset)), strict=True), start=1):
            axes.plot(*studies.thinned(t, series), color=f"C{k}", linewidth=1.0, label=f"A/d = {ratio}")
            exact = reference.get(f"solitary_wall_A{float(ratio):.2f}_history", column)
            if exact is not None:
                axes.plot(exact[exact.dims[0]], exact, "k--", linewidth=0.8)
    for axes, name in zip(panels, ("run-up / d", "F / (rho g d^2 / 2)"), strict=True):
        studies.tidy(axes, xlabel="(t - t of largest run-up) sqrt(g/d)", ylabel=name, xlim=(-6, 4))
    panels[0].legend(frameon=False)
    return studies.picture("vertical_wall", "Run-up and force on a vertical wall; dashed: exact.", figure)


def chapter(runs: Mapping[str, xr.Dataset], reference: studies.Reference, quick: bool) -> studies.Chapter:
    """Return the table of speeds, run-ups and forces, and their histories."""
    short, low = runs["vertical 0.3"], runs["vertical 0.1"]
    flume, travel = (short, (0.8, 2.4)) if quick else (runs["vertical 0.3, long flume"], (2.0, 7.0))
    rows = [row(0.3, flume, travel, short), row(0.1, low, (0.8, 2.4), low)]
    caption = "Vertical wall: lengths over d, speeds over sqrt(g d), times over sqrt(d/g), forces over rho g d^2 / 2"
    table = studies.Table("key_figures_vertical", caption, rows)
    return studies.Chapter("vertical-wall", "Vertical wall", tables=[table], pictures=[histories(runs, reference)])


SECTION = studies.Section("vertical-wall", tasks, chapter)
