"""The dam break with every method: ``python -m validation.dam_break.run --reference FOLDER``."""

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from sphframe.analysis import plot_run, series_error, summary
from validation import study

HERE = Path(__file__).parent
REFERENCE = "buchner2002_P1_second"
PLATEAU = slice(3.2, 4.8)
WINDOW = 0.1
"""width of the running mean that takes out acoustic waves, over sqrt(H/g)"""


def wall_pressure(dataset: xr.Dataset) -> xr.DataArray:
    """P1 over rho g H, averaged over WINDOW around each of evenly spaced times t sqrt(g/H)."""
    p1 = dataset.sph.dimensionless("probe_pressure").sel(probe="P1")
    t, p = p1["probe_time"].values, p1.values
    even = np.arange(0.0, t[-1], 0.01)
    integral = np.concatenate([[0.0], np.cumsum(0.5 * (p[1:] + p[:-1]) * np.diff(t))])
    low, high = np.maximum(even - 0.5 * WINDOW, t[0]), np.minimum(even + 0.5 * WINDOW, t[-1])
    smooth = (np.interp(high, t, integral) - np.interp(low, t, integral)) / (high - low)
    return xr.DataArray(smooth, coords={"t": even}, name="P1")


def figures(dataset: xr.Dataset, reference: xr.DataArray | None) -> dict[str, Any]:
    """Key figures; times over sqrt(H/g), pressures over rho g H."""
    known = summary(dataset)
    p1 = wall_pressure(dataset)
    plateau = dataset.sph.dimensionless("probe_pressure").sel(probe="P1", probe_time=PLATEAU)
    arrival = known["front_arrival"]
    first = p1.sel(t=slice(2.3, 3.2))
    second = p1.sel(t=slice(5.0, 7.0))
    found = {
        "method": known["interpolator"],
        "completed": known["completed"],
        "end": known["time"] / dataset.sph.time_scale,
        "arrival": arrival["dimensionless"] if arrival else float("nan"),
        "first_peak": _largest(first),
        "plateau": float(plateau.mean()),
        "plateau_noise": float(plateau.std()),
        "plateau_lower": _pressure_beside_wall(dataset, 0.2),
        "second_peak": _largest(second),
        "energy_excess": 100.0 * known["energy_excess"],
        "energy_left": float(dataset["total_energy"][-1] / dataset["total_energy"][0]),
        "outside": known["particles_outside"],
        "fallback": 100.0 * (known["statuses"]["TOO_FEW"] + known["statuses"]["SINGULAR"]),
        "steps": known["steps"],
        "seconds": known["wall_clock"],
    }
    if reference is not None and p1.sizes["t"]:
        found["rms_to_experiment"] = series_error(p1, reference)["rms"]
    return found


def row(found: dict[str, Any]) -> dict[str, str]:
    """One line of the README's table."""
    cells = {
        "method": found["method"],
        "front arrives": f"{found['arrival']:.2f}",
        "first peak": f"{found['first_peak']:.2f}",
        "plateau": f"{found['plateau']:.3f} ± {found['plateau_noise']:.3f}",
        "at 0.2 H": f"{found['plateau_lower']:.2f}",
        "second peak": f"{found['second_peak']:.2f}",
        "RMS to experiment": f"{found['rms_to_experiment']:.3f}" if "rms_to_experiment" in found else "-",
        "energy excess": f"{found['energy_excess']:.3f}",
        "behind walls": f"{found['outside']}",
        "fallback": f"{found['fallback']:.2f}",
        "to t = 7": "yes" if found["completed"] == "yes" else f"no, ends at {found['end']:.2f}",
    }
    return {head: "-" if "nan" in cell else cell for head, cell in cells.items()}


def draw(datasets: dict[str, xr.Dataset], reference: xr.DataArray | None, path: Path) -> None:
    """Wall pressure of all methods beside the experiment."""
    figure = Figure(figsize=(10, 4.2), dpi=110, layout="constrained")
    axes = figure.subplots()
    for method, dataset in datasets.items():
        p1 = wall_pressure(dataset)
        axes.plot(p1["t"], p1, linewidth=0.9, label=method)
    if reference is not None:
        axes.plot(reference["t"], reference, ".", color="black", markersize=4, label="Buchner (2002), measured")
    axes.set(xlim=(2.0, 7.0), ylim=(-0.2, 1.6), xlabel=r"$t\sqrt{g/H}$", ylabel=r"$p / (\rho g H)$")
    axes.legend(fontsize=8, frameon=False, ncols=2, loc="upper left")
    axes.grid(linewidth=0.4, alpha=0.4)
    axes.spines[["top", "right"]].set_visible(False)
    figure.suptitle("Dam break: pressure on the far wall (P1), running mean over 0.1 √(H/g)")
    figure.savefig(path)


def main() -> None:
    """Run the study."""
    options = study.parser(__doc__ or "", "output/dam_break")
    options.add_argument("--reference", type=Path, help=f"folder that holds {REFERENCE}.csv (not part of sphframe)")
    given = options.parse_args()
    reference = study.reference_of(given.reference, REFERENCE)
    datasets = {}
    for method in given.methods:
        datasets[method] = study.dataset_of(
            "dam-break",
            given.output / f"{method}.nc",
            again=given.again,
            threads=given.threads,
            particle_spacing=given.particle_spacing,
            interpolator=method,
        )
        print(study.table([row(figures(datasets[method], reference))]), flush=True)
    found = [figures(dataset, reference) for dataset in datasets.values()]
    text = study.table([row(one) for one in found])
    print(text)
    if not given.no_readme:
        study.replace_block(HERE / "README.md", "figures", text)
        study.write_csv(
            HERE / "key_figures.csv",
            found,
            "dam break; times over sqrt(H/g), pressures over rho g H, energy_excess and fallback in %; see README.md",
        )
        draw(datasets, reference, HERE / "wall_pressure.png")
        first = next(iter(datasets.values()))
        if reference is not None:
            reference = reference.rename("Buchner (2002), measured")
        plot_run(first, times=_moments(first), reference=reference).savefig(HERE / "particles.png", dpi=90)


def _pressure_beside_wall(dataset: xr.Dataset, height: float) -> float:
    """Mean p/(rho g H) of the particles within 3 spacings of the far wall and 2 of ``height`` H, over the plateau."""
    spacing, depth = float(dataset.attrs["particle_spacing"]), float(dataset.attrs["depth"])
    frames = dataset[["position", "pressure"]].sel(
        time=slice(PLATEAU.start * dataset.sph.time_scale, PLATEAU.stop * dataset.sph.time_scale)
    )
    far = float(dataset["outline_node"].isel(space=0).max()) - frames["position"].isel(space=0)
    above = frames["position"].isel(space=-1) - height * depth
    beside = frames["pressure"].where((far < 3.0 * spacing) & (np.abs(above) < 2.0 * spacing))
    return float(beside.mean("particle").mean() / dataset.sph.pressure_scale)


def _largest(series: xr.DataArray) -> float:
    return float(series.max()) if series.sizes["t"] else float("nan")


def _moments(dataset: xr.Dataset) -> list[float]:
    """1.6, 2.5, 4.5 and 6.2 sqrt(H/g), as far as the run goes."""
    end = float(dataset["time"][-1])
    return [t for t in np.array([1.6, 2.5, 4.5, 6.2]) * dataset.sph.time_scale if t <= end] or [end]


if __name__ == "__main__":
    main()
