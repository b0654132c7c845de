"""Solitary waves on fixed and movable seawalls: ``python -m validation.solitary_wave.run``."""

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

import sphframe
from sphframe.analysis import plot_run
from validation import study

HERE = Path(__file__).parent
Array = NDArray[np.float64]

EXACT = {
    0.1: {"speed": 1.0485482, "run_up": 0.205553, "force": 1.42443},
    0.3: {"speed": 1.137523, "run_up": 0.660213, "force": 2.3006},
}
"""exact potential flow by A/d: speed over sqrt(g d), run-up over d and force over rho g d^2 / 2 on a vertical wall"""

FLUME = "solitary-wave-fixed-wall"
HELD = {
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
GAUGES = tuple(0.5 * k for k in range(2, 16))


def crests(dataset: xr.Dataset) -> tuple[Array, Array, Array]:
    """Where the gauges are (m), when the incident crest passes each (s) and how high it is (m above still water).

    A parabola through the samples around the highest one takes out the noise of single particles.
    """
    t = dataset["probe_time"].values
    times, heights = [], []
    for elevation in (dataset["gauge_elevation"] - dataset.attrs["depth"]).values.T:
        wet = np.isfinite(elevation)  # a gauge is dry once the paddle has passed it
        peak = t[wet][np.argmax(elevation[wet])]
        near = wet & (np.abs(t - peak) < 0.6 * dataset.sph.time_scale)
        a, b, c = np.polyfit(t[near] - peak, elevation[near], 2)
        times.append(peak - b / (2.0 * a))
        heights.append(c - b * b / (4.0 * a))
    return dataset["gauge_x"].values, np.array(times), np.array(heights)


def seawall_force(dataset: xr.Dataset, by: str = "wall_force") -> xr.DataArray:
    """Horizontal force on the seawall over rho g d^2 / 2."""
    wall = "seawall" if "seawall" in dataset["wall"].values else "tank"
    still = 0.5 * dataset.attrs["depth"] * dataset.sph.pressure_scale
    return dataset[by].sel(wall=wall, space="x") / still


def vertical_figures(ratio: float, flume: xr.Dataset, travel: tuple[float, float], wall: xr.Dataset) -> dict[str, Any]:
    """Key figures of a wave of height ``ratio`` d: speed, loss in ``travel`` (m) of ``flume``; the rest at ``wall``."""
    depth, gravity = flume.attrs["depth"], flume.attrs["gravity"]
    x, t, height = crests(flume)
    on_the_way = (x >= travel[0]) & (x <= travel[1])
    speed = np.polyfit(t[on_the_way], x[on_the_way], 1)[0] / np.sqrt(gravity * depth)
    slope, start = np.polyfit(x[on_the_way] / depth, height[on_the_way] / depth, 1)
    sent = start + slope * travel[0] / depth
    run_up, force = wall["run_up"], seawall_force(wall)
    return {
        "A/d asked for": ratio,
        "A/d sent": float(sent),
        "speed": float(speed),
        "speed, error": float(100.0 * (speed / EXACT[ratio]["speed"] - 1.0)),
        "height lost over 20 d": float(-2000.0 * slope / sent) if travel[1] - travel[0] >= 20.0 * depth else np.nan,
        "run-up": float(run_up.max()) / depth,
        "run-up, error": 100.0 * (float(run_up.max()) / depth / EXACT[ratio]["run_up"] - 1.0),
        "force": float(force.max()),
        "force, error": 100.0 * (float(force.max()) / EXACT[ratio]["force"] - 1.0),
        "force by pressure": float(seawall_force(wall, "wall_force_by_pressure").max()),
        "force peaks after run-up by": float(force.idxmax() - run_up.idxmax()) / wall.sph.time_scale,
        "behind walls": int(max(data["particles_outside"].max() for data in (flume, wall))),
    }


def leaning_figures(name: str, dataset: xr.Dataset) -> dict[str, Any]:
    """Key figures of the paper's wall that leans by 120 degrees."""
    p = dataset["probe_pressure"]
    x, t, height = crests(dataset)
    speed, start = np.polyfit(t[3:-1], x[3:-1], 1)
    toe = float(np.max(x)) / 0.9
    arrival = (toe - start) / speed
    quiet = p.sel(probe_time=slice(0.05, arrival - 8.0 * dataset.attrs["depth"] / speed))
    return {
        "method": name,
        "completed": dataset.attrs["run_status"],
        "flume (m)": toe,
        "P0 before the wave (Pa)": float(quiet[:, 0].mean()),
        "P0 before the wave, std (Pa)": float(quiet[:, 0].std()),
        "P1 before the wave (Pa)": float(quiet[:, 1].mean()),
        "P1 before the wave, std (Pa)": float(quiet[:, 1].std()),
        "P0 largest (Pa)": float(p[:, 0].max()),
        "P1 largest (Pa)": float(p[:, 1].max()),
        "A/d sent": float(np.median(height[3:-1])) / dataset.attrs["depth"],
        "crest at the toe (s)": float(arrival),
        "crest at the toe by Rayleigh's c (s)": sphframe.load_case(FLUME, "paper").paddle().arrival_time(toe),
        "run-up": float(dataset["run_up"].max()) / dataset.attrs["depth"],
        "force": float(seawall_force(dataset).max()),
        "behind walls": int(dataset["particles_outside"].max()),
    }


def movable_figures(dataset: xr.Dataset) -> dict[str, Any]:
    """Key figures of the wall on a spring, with the balance of its work and energy."""
    t = dataset["probe_time"].values
    motion = {name: dataset[f"body_{name}"].sel(body="seawall", motion="x").values for name in ("position", "velocity")}
    x, u = motion["position"], motion["velocity"]
    force = seawall_force(dataset).values
    still = 0.5 * dataset.attrs["depth"] * dataset.sph.pressure_scale
    power = np.maximum(force - 1.1, 0.0) * still * u
    work = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(t))])
    energy = 0.5 * 250.0 * u**2 + 0.5 * 10.0 * x**2
    onset = float(t[np.argmax(x > 0.0)])
    quiet = (t > 0.05) & (t < onset - 0.5)
    return {
        "wall begins to move (s)": onset,
        "F before the wave": float(force[quiet].mean()),
        "F before the wave, std": float(force[quiet].std()),
        "F largest": float(force.max()),
        "F largest at (s)": float(t[force.argmax()]),
        "bed pressure largest at (s)": float(dataset["probe_pressure"][:, 0].idxmax()),
        "wall after 4 s (m)": 2.5 + float(np.interp(4.0, t, x)),
        "smallest displacement (m)": float(x.min()),
        "work over energy": float(work[-1] / energy[-1]),
        "behind walls": int(dataset["particles_outside"].max()),
    }


def draw_movable(movable: xr.Dataset, held: xr.Dataset, path: Path) -> None:
    """Force on the seawall and its displacement, held and movable."""
    figure = Figure(figsize=(9, 3.4), dpi=100, layout="constrained")
    left, right = figure.subplots(1, 2)
    for dataset, label in ((held, "fixed"), (movable, "movable")):
        force = seawall_force(dataset)
        left.plot(force["probe_time"], force, label=label, linewidth=1.0)
    left.set(xlabel="t (s)", ylabel="F* = F / F static", xlim=(1.5, 4.5))
    left.legend(frameon=False)
    shift = movable["body_position"].sel(body="seawall", motion="x") / movable.attrs["depth"]
    right.plot(shift["probe_time"], shift, color="C1", label="movable")
    right.axhline(0.0, color="C0", linewidth=1.0, label="fixed")
    right.set(xlabel="t (s)", ylabel="x* = X / d", xlim=(1.5, 4.5))
    right.legend(frameon=False)
    figure.savefig(path)


def draw_vertical(datasets: dict[float, xr.Dataset], reference: Path | None, path: Path) -> None:
    """Run-up and force on a vertical wall, beside exact potential flow where a folder with it was named."""
    figure = Figure(figsize=(9, 3.4), dpi=100, layout="constrained")
    left, right = figure.subplots(1, 2)
    for k, (ratio, dataset) in enumerate(datasets.items()):
        run_up, force = dataset["run_up"] / dataset.attrs["depth"], seawall_force(dataset)
        t = (run_up["probe_time"] - float(run_up.idxmax())) / dataset.sph.time_scale
        left.plot(t, run_up, color=f"C{k}", linewidth=1.0, label=f"A/d = {ratio}")
        right.plot(t, force, color=f"C{k}", linewidth=1.0)
        if reference is not None:
            exact = np.loadtxt(reference / f"solitary_wall_A{ratio:.2f}_history.csv", delimiter=",")
            left.plot(exact[:, 0], exact[:, 1], "k--", linewidth=0.8)
            right.plot(exact[:, 0], exact[:, 2], "k--", linewidth=0.8)
    left.set(xlabel="(t - t of largest run-up) sqrt(g/d)", ylabel="run-up / d", xlim=(-6, 4))
    right.set(xlabel="(t - t of largest run-up) sqrt(g/d)", ylabel="F / (rho g d^2 / 2)", xlim=(-6, 4))
    left.legend(frameon=False)
    figure.savefig(path)


def draw_leaning(datasets: dict[str, xr.Dataset], path: Path) -> None:
    """Pressure at P0 and P1 on the leaning wall, every method."""
    figure = Figure(figsize=(9, 3.4), dpi=100, layout="constrained")
    for k, axes in enumerate(figure.subplots(1, 2)):
        for name, dataset in datasets.items():
            p = dataset["probe_pressure"][:, k]
            axes.plot(p["probe_time"], p / 1000.0, linewidth=0.8, label=name)
        axes.set(xlabel="t (s)", ylabel=f"P{k} (kPa)")
    axes.legend(frameon=False)
    figure.savefig(path)


def main() -> None:
    """Run what is not there yet and rewrite tables and pictures."""
    made = study.parser(__doc__ or "", "solitary-wave-runs")
    made.add_argument("--reference", type=Path, default=None, help="folder with solitary_wall_A0.10_history.csv, ...")
    made.add_argument("--paper-length", type=float, default=10.0, help="m, length of the leaning wall's flume")
    made.add_argument(
        "--paper-time-step", type=float, default=None, help="s; by default adaptive, longer than the paper's"
    )
    made.set_defaults(methods=("improved-shepard", "mls-linear", "sfdi"))
    arguments = made.parse_args()

    def dataset(case: str, name: str, preset: str | None = None, **parameters: Any) -> xr.Dataset:
        wanted = sphframe.load_case(case, preset, parameters)
        path = arguments.output / f"{name}.nc"
        return study.dataset_of(wanted, path, again=arguments.again, threads=arguments.threads)

    movable = dataset("solitary-wave-movable-wall", "movable", "paper", frame_interval=0.1)
    held = dataset(FLUME, "held", **HELD)
    long = dataset(FLUME, "vertical-0.3", tank_length=8.0, frame_interval=0.25, gauge_positions=GAUGES)
    near = dataset(FLUME, "vertical-0.3-near", tank_length=4.0, frame_interval=0.25)
    low = dataset(FLUME, "vertical-0.1", tank_length=4.0, wave_height=0.025, frame_interval=0.25)
    leaning = {
        method: dataset(
            FLUME,
            f"leaning-{method}",
            "paper",
            tank_length=arguments.paper_length,
            time_step=arguments.paper_time_step,
            frame_interval=0.1,
            interpolator=method,
        )
        for method in arguments.methods
    }
    tables = {
        "vertical": [
            vertical_figures(0.3, long, (2.0, 7.0), near),
            vertical_figures(0.1, low, (0.8, 2.4), low),
        ],
        "leaning": [leaning_figures(name, dataset) for name, dataset in leaning.items()],
        "movable": [movable_figures(movable) | {"F largest, fixed wall": float(seawall_force(held).max())}],
    }
    for name, rows in tables.items():
        heads = [str(found.get("A/d asked for", found.get("method", "movable"))) for found in rows]
        lines = [
            {"figure": key, **{head: _text(found[key]) for head, found in zip(heads, rows, strict=True)}}
            for key in rows[0]
            if key not in ("A/d asked for", "method")
        ]
        print(study.table(lines))
        if not arguments.no_readme:
            study.replace_block(HERE / "README.md", name, study.table(lines))
            study.write_csv(HERE / f"key_figures_{name}.csv", rows, f"solitary wave, {name} wall; lengths over d")
    if not arguments.no_readme:
        draw_movable(movable, held, HERE / "movable_wall.png")
        draw_vertical({0.3: near, 0.1: low}, arguments.reference, HERE / "vertical_wall.png")
        draw_leaning(leaning, HERE / "leaning_wall.png")
        plot_run(movable, times=(2.0, 2.4, 2.8, 4.0), path=HERE / "particles.png")


def _text(value: object) -> str:
    if isinstance(value, float):
        return "-" if np.isnan(value) else f"{value:.4g}"
    return str(value)


if __name__ == "__main__":
    main()
