"""A solitary wave on a seawall on a spring, and on the same wall at rest."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from sphframe import studies
from sphframe.analysis import plot_run, pressure_scale
from validation.solitary_wave.waves import FLUME, seawall_force

AT_REST: dict[str, Any] = {
    "depth": 0.2,
    "wave_height": 0.06,
    "tank_length": 2.5,
    "particle_spacing": 0.008,
    "sound_speed": 10.0 * (9.81 * 0.2) ** 0.5,
    "time_step": 5e-4,
    "hydrostatic_lift": "mirror",
    "ghost_velocity": "interpolated",
    "until": 4.0,
    "probe_interval": 0.002,
    "frame_interval": 0.1,
}
MASS, STIFFNESS = 250.0, 10.0
"""of the wall, kg/m and N/m"""


def tasks(quick: bool) -> list[studies.Task]:
    """Return the run of the movable wall, and that of the wall at rest."""
    coarse: dict[str, Any] = {"particle_spacing": 0.04, "time_step": None, "until": 1.0} if quick else {}
    movable = {"frame_interval": 0.1, **coarse}
    return [
        studies.run_task("movable", "solitary-wave-movable-wall", "paper", **movable),
        studies.run_task("at rest", FLUME, **{**AT_REST, **coarse}),
    ]


def row(movable: xr.Dataset, at_rest: xr.Dataset) -> dict[str, studies.Cell]:
    """Return the key figures; forces F over the static one, and the wall's work over its energy."""
    t = movable["probe_time"].values
    x, u = (movable[f"body_{name}"].sel(body="seawall", space="x").values for name in ("position", "velocity"))
    force = seawall_force(movable).values
    power = np.maximum(force - 1.1, 0.0) * 0.5 * float(movable.attrs["depth"]) * pressure_scale(movable) * u
    work = float(np.sum(0.5 * (power[1:] + power[:-1]) * np.diff(t)))
    energy = float(0.5 * MASS * u[-1] ** 2 + 0.5 * STIFFNESS * x[-1] ** 2)
    onset = float(t[np.argmax(x > 0.0)])
    quiet = force[(t > 0.05) & (t < onset - 0.5)]
    return {
        "wall begins to move (s)": onset,
        "F before the wave": float(quiet.mean()) if quiet.size else None,
        "F before the wave, std": float(quiet.std()) if quiet.size else None,
        "F largest": float(force.max()),
        "F largest at (s)": float(t[force.argmax()]),
        "bed pressure largest at (s)": float(movable["probe_pressure"][:, 0].idxmax()),
        "wall after 4 s (m)": 2.5 + float(np.interp(4.0, t, x)),
        "smallest displacement (m)": float(x.min()),
        "work over energy": work / energy if energy else None,
        "F largest, wall at rest": float(seawall_force(at_rest).max()),
        "fallback (% of wet ghosts)": studies.fallback_share(movable),
        "behind walls": int(movable["particles_outside"].max()),
        "to the end": studies.ended(movable),
    }


def histories(movable: xr.Dataset, at_rest: xr.Dataset) -> studies.Picture:
    """Draw the force on the seawall and its displacement."""
    figure = studies.new_figure(9.0, 3.4)
    left, right = figure.subplots(1, 2)
    for dataset, label in ((at_rest, "at rest"), (movable, "movable")):
        force = seawall_force(dataset)
        left.plot(*studies.thinned(force["probe_time"], force), label=label, linewidth=1.0)
    shift = movable["body_position"].sel(body="seawall", space="x") / movable.attrs["depth"]
    right.axhline(0.0, color="C0", linewidth=1.0, label="at rest")
    right.plot(*studies.thinned(shift["probe_time"], shift), color="C1", label="movable")
    for axes, name in ((left, "F* = F / F static"), (right, "x* = X / d")):
        studies.tidy(axes, xlabel="t (s)", ylabel=name, xlim=(1.5, 4.5))
        axes.legend(frameon=False)
    return studies.picture("movable_wall", "Force and displacement of the seawall, movable and at rest.", figure)


def chapter(runs: Mapping[str, xr.Dataset], reference: studies.Reference, quick: bool) -> studies.Chapter:
    """Return the table of forces and motion, their histories, and the particles at four times."""
    movable, at_rest = runs["movable"], runs["at rest"]
    table = studies.Table("key_figures_movable", "Movable wall: F over F static", [row(movable, at_rest)])
    end = float(movable["time"][-1])
    times = [t for t in (2.0, 2.4, 2.8, 4.0) if t <= end] or [end]
    particles = studies.picture("particles", "Particles at four times.", plot_run(movable, times=times), raster=True)
    pictures = [histories(movable, at_rest), particles]
    return studies.Chapter("movable-wall", "Movable wall", tables=[table], pictures=pictures)


SECTION = studies.Section("movable-wall", tasks, chapter)
