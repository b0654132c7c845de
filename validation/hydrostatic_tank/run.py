"""Still water with every method and both lifts: ``python -m validation.hydrostatic_tank.run``."""

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from sphframe.analysis import pressure_scale, probe_statistics, rest_pressure, summary
from validation import study

HERE = Path(__file__).parent
LIFTS = ("balanced", "mirror")


def figures(dataset: xr.Dataset) -> dict[str, Any]:
    """Errors over the second half of the run, in per cent of rho g H."""
    scale = pressure_scale(dataset)
    probes = probe_statistics(dataset, expected=rest_pressure(dataset, dataset["probe_y"].values))
    error, noise = 100.0 * np.abs(probes["error"].values) / scale, 100.0 * probes["std"].values / scale
    half = dataset.sel(time=slice(0.5 * float(dataset["time"][-1]), None)).load()
    rest = rest_pressure(dataset, half["position"].isel(space=-1).values)
    known = summary(dataset)
    kinetic = dataset["kinetic_energy"].sel(probe_time=slice(probes.attrs["start"], None))
    return {
        "lift": known["hydrostatic_lift"],
        "method": known["interpolator"],
        "completed": known["completed"],
        "time": known["time"],
        "error_corner": float(error[0]),
        "error_wall": float(error[1:].max()),
        "noise_corner": float(noise[0]),
        "noise_wall": float(noise[1:].max()),
        "rms_field": 100.0 * float(np.sqrt(np.mean((half["pressure"].values - rest) ** 2))) / scale,
        "kinetic": float(kinetic.mean() / dataset["potential_energy"][0]),
        "fallback": 100.0 * (known["statuses"]["TOO_FEW"] + known["statuses"]["SINGULAR"]),
        "outside": known["particles_outside"],
        "steps": known["steps"],
        "seconds": known["wall_clock"],
    }


def row(found: dict[str, Any]) -> dict[str, str]:
    """One line of the README's table."""
    stable = found["completed"] == "yes" and found["outside"] == 0
    return {
        "lift": found["lift"],
        "method": found["method"],
        "mean, corner": f"{found['error_corner']:.2f}",
        "mean, wall": f"{found['error_wall']:.2f}",
        "std, corner": f"{found['noise_corner']:.2f}",
        "std, wall": f"{found['noise_wall']:.2f}",
        "RMS, fluid": f"{found['rms_field']:.2f}",
        "kinetic energy": f"{found['kinetic']:.1e}",
        "fallback": f"{found['fallback']:.2f}",
        "stable": "yes" if stable else f"no, ends at {found['time']:.2f} s",
    }


def draw(datasets: dict[tuple[str, str], xr.Dataset], path: Path) -> None:
    """Pressure at the probe in mid-height against time, one panel a lift."""
    figure = Figure(figsize=(10, 3.6), dpi=110, layout="constrained")
    for axes, lift in zip(figure.subplots(1, 2, sharey=True), LIFTS, strict=True):
        for (a_lift, method), dataset in datasets.items():
            if a_lift == lift:
                series = dataset["probe_pressure"].isel(probe=1)
                rest = rest_pressure(dataset, dataset["probe_y"].values[1])
                deviation = 100.0 * (series - rest) / pressure_scale(dataset)
                axes.plot(dataset["probe_time"], deviation, linewidth=0.7, label=method)
        axes.axhline(0.0, color="black", linewidth=0.6)
        axes.set(title=f"{lift} lift", xlabel="t (s)", ylim=(-4.0, 4.0))
        axes.grid(linewidth=0.4, alpha=0.4)
        axes.spines[["top", "right"]].set_visible(False)
    figure.axes[0].set_ylabel(r"$(p - p_{rest}) / (\rho g H)$, %")
    figure.axes[0].legend(fontsize=8, frameon=False, ncols=2, loc="lower right")
    figure.suptitle("Still water, pressure on the wall a third of the depth above the bed")
    figure.savefig(path)


def main() -> None:
    """Run the study."""
    options = study.parser(__doc__ or "", "output/hydrostatic_tank")
    options.add_argument("--until", type=float, default=5.0, help="s")
    options.add_argument("--lifts", nargs="+", default=LIFTS, choices=LIFTS)
    given = options.parse_args()
    datasets = {}
    for lift in given.lifts:
        for method in given.methods:
            datasets[lift, method] = study.dataset_of(
                "hydrostatic-tank",
                given.output / f"{method}_{lift}.nc",
                again=given.again,
                threads=given.threads,
                particle_spacing=given.particle_spacing,
                until=given.until,
                interpolator=method,
                hydrostatic_lift=lift,
            )
            print(study.table([row(figures(datasets[lift, method]))]), flush=True)
    found = [figures(dataset) for dataset in datasets.values()]
    text = study.table([row(one) for one in found])
    print(text)
    if not given.no_readme:
        study.replace_block(HERE / "README.md", "figures", text)
        study.write_csv(
            HERE / "key_figures.csv",
            found,
            "still water, second half of the run; error_, noise_, rms_ in % of rho g H; fallback in % of ghosts;"
            " kinetic over the initial potential energy; see README.md",
        )
        draw(datasets, HERE / "probe.png")


if __name__ == "__main__":
    main()
