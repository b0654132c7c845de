"""Studies: one case with several methods at several resolutions, as one dataset."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import sphframe
from sphframe.analysis import (
    convergence_order,
    pressure_scale,
    read_reference_series,
    rest_pressure,
    running_mean,
    summary,
)
from sphframe.cases import Case, load_case
from sphframe.errors import InputError, OutputError
from sphframe.output import open_dataset
from sphframe.output.files import replaced_as_a_whole
from sphframe.output.provenance import distributions, software
from sphframe.studies.chapter import Cell, Chapter, Picture, Table
from sphframe.studies.drawing import colour, new_figure, picture, thinned, tidy
from sphframe.studies.engine import Watch, carry_out
from sphframe.studies.report import write_report
from sphframe.studies.series import fallback_share
from sphframe.studies.tasks import RunTask

__all__ = ["Comparison", "compare"]

_SAMPLES = 2001
"""common times of the probes' pressures"""


@dataclass(frozen=True)
class Comparison:
    """What :func:`compare` found: the ``dataset`` over (interpolator, particle_spacing), and the ``report`` of it."""

    dataset: xr.Dataset
    report: Path


def compare(
    case: Case | str,
    interpolators: Sequence[str],
    spacings: Sequence[float] = (),
    *,
    output: Path,
    preset: str | None = None,
    parameters: Mapping[str, Any] | None = None,
    reference: Path | None = None,
    probe: str | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    watch: Watch = lambda progress: None,
) -> Comparison:
    """Run ``case`` with each method at each particle spacing, each once, and compare errors, costs and orders.

    The error is the RMS difference of the probes' pressures, over rho g H (Pa without gravity), from

    - ``reference``, a series of p/(rho g H) over t sqrt(g/H), at ``probe``, if one is given;
    - the state of rest, over the second half of the run, for ``hydrostatic-tank``;
    - else the same method's own at the finest spacing, running means over a hundredth of the run: self-convergence.

    The observed order is the power of the spacing by which the error falls, least squares over all spacings.

    Parameters
    ----------
    case, preset, parameters: as for :func:`sphframe.load_case`.
    interpolators: names of methods.
    spacings: m; by default the case's own.
    output: folder for ``comparison.nc``, ``report.html``, ``figures/``, ``tables/`` and ``runs/``.
    reference: file of a reference series, see :func:`sphframe.analysis.read_reference_series`.
    probe: the probe to compare with it; by default the first.
    workers, scheduler, watch: see :func:`sphframe.studies.engine.carry_out`.

    Returns
    -------
    A comparison whose ``dataset`` has, over (interpolator, particle_spacing), ``error``, ``wall_clock`` (s), ``steps``,
    ``particles``, ``cost`` (us a particle and step), ``energy_excess``, ``fallback`` (% of wet ghosts), ``completed``;
    ``order`` over (interpolator); and ``probe_pressure`` over (interpolator, particle_spacing, probe, probe_time), Pa,
    at common times.

    Raises
    ------
    InputError: a method, a spacing or a parameter is not valid; nothing has been run.
    OutputError: the folder cannot be written.
    SphframeError: what a run raised that is not a result of its own.
    """
    if len(set(interpolators)) != len(interpolators) or not interpolators:
        raise InputError(f"give each method once, such as improved-shepard,mls-linear, not {','.join(interpolators)}")
    given = {name: value for name, value in (parameters or {}).items() if name != "particle_spacing"}
    own = load_case(case, preset, given).particle_spacing
    chosen = sorted({float(s) for s in spacings} or {own}, reverse=True)
    tasks = {
        (method, spacing): RunTask.of(
            f"{method} {spacing:g}",
            load_case(case, preset, {**given, "interpolator.name": method, "particle_spacing": spacing}),
        )
        for method in interpolators
        for spacing in chosen
    }
    series = None if reference is None else read_reference_series(reference.parent, reference.stem)
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"cannot make the folder {output}: {error.strerror or error}; give another --output"
        ) from None
    files = carry_out(tasks.values(), output / "runs", workers=workers, scheduler=scheduler, watch=watch)
    runs = {key: open_dataset(files[task.label]) for key, task in tasks.items()}
    try:
        dataset = _gathered(runs, list(interpolators), chosen, series, probe)
    finally:
        for run in runs.values():
            run.close()
    with replaced_as_a_whole(output / "comparison.nc") as draft:
        dataset.to_netcdf(draft, engine="netcdf4")
    versions = dict[str, str]()
    for task in tasks.values():
        versions |= distributions(task.case())
    facts = {**dict(sorted(versions.items())), **software()}
    title = f"{dataset.attrs['title']}: {len(interpolators)} methods, {len(chosen)} resolutions"
    report = write_report(output, title, [_chapter(dataset)], facts={"sphframe": sphframe.__version__, **facts})
    return Comparison(dataset, report)


def _gathered(
    runs: Mapping[tuple[str, float], xr.Dataset],
    methods: list[str],
    spacings: list[float],
    reference: xr.DataArray | None,
    probe: str | None,
) -> xr.Dataset:
    shape = (len(methods), len(spacings))
    first = next(iter(runs.values()))
    names = [str(p) for p in first["probe"].values] if "probe_pressure" in first else []
    if probe is not None and probe not in names:
        raise InputError(f"the case has no probe {probe!r}; it has {', '.join(names) or 'none'}")
    end = max(float(r["probe_time"][-1]) for r in runs.values() if r.sizes["probe_time"])
    times = np.linspace(0.0, end, _SAMPLES)
    pressure = np.full((*shape, len(names), _SAMPLES), np.nan)
    numbers = {
        name: np.full(shape, np.nan) for name in ("wall_clock", "steps", "particles", "energy_excess", "fallback")
    }
    completed = np.zeros(shape, dtype=np.int8)
    error = np.full(shape, np.nan)
    for i, method in enumerate(methods):
        for j, spacing in enumerate(spacings):
            run = runs[method, spacing]
            known = summary(run)
            for name in ("wall_clock", "steps", "particles", "energy_excess"):
                numbers[name][i, j] = known.get(name, math.nan)
            numbers["fallback"][i, j] = fallback_share(run)
            completed[i, j] = run.attrs["completed"] == "yes"
            for k in range(len(names)):
                t = run["probe_time"].values
                pressure[i, j, k] = np.interp(times, t, run["probe_pressure"][:, k].values, right=math.nan)
            if completed[i, j] and names:
                error[i, j] = _error(run, runs[method, spacings[-1]], reference, probe or names[0])
    orders = np.array([_order(spacings, error[i]) for i in range(shape[0])])
    over = ("interpolator", "particle_spacing")
    kind = "reference series" if reference is not None else "state of rest"
    if reference is None and first.attrs["case_name"] != "hydrostatic-tank":
        kind = "finest spacing of the same method"
    unit = "1" if pressure_scale(first) else "Pa"
    return xr.Dataset(
        {
            "error": (over, error, {"units": unit, "long_name": f"RMS difference of probe pressures from the {kind}"}),
            "order": ("interpolator", orders, {"units": "1", "long_name": "observed order of convergence"}),
            "cost": (
                over,
                1e6 * numbers["wall_clock"] / (numbers["steps"] * numbers["particles"]),
                {"units": "us", "long_name": "wall-clock time a particle and step"},
            ),
            "wall_clock": (over, numbers["wall_clock"], {"units": "s", "long_name": "wall-clock time of the run"}),
            "steps": (over, numbers["steps"], {"units": "1", "long_name": "time steps"}),
            "particles": (over, numbers["particles"], {"units": "1", "long_name": "fluid particles"}),
            "energy_excess": (
                over, numbers["energy_excess"], {"units": "1", "long_name": "largest total energy over the first, -1"}
            ),
            "fallback": (over, numbers["fallback"], {"units": "%", "long_name": "wet ghosts that used the fallback"}),
            "completed": (over, completed, {"units": "1", "long_name": "1 for a run that came to its end"}),
            "probe_pressure": (
                (*over, "probe", "probe_time"), pressure, {"units": "Pa", "long_name": "pressure at the probe"}
            ),
        },
        coords={
            "interpolator": methods,
            "particle_spacing": ("particle_spacing", spacings, {"units": "m", "long_name": "particle spacing"}),
            "probe": names,
            "probe_time": ("probe_time", times, {"units": "s", "long_name": "time"}),
        },
        attrs={
            "title": str(first.attrs["title"]),
            "case_name": str(first.attrs["case_name"]),
            "pressure_scale": pressure_scale(first),
        },
    )  # fmt: skip


def _error(run: xr.Dataset, finest: xr.Dataset, reference: xr.DataArray | None, probe: str) -> float:
    scale = pressure_scale(run) or 1.0
    if reference is not None:
        return float(run.sph.error("probe_pressure", reference, probe=probe)["rms"])
    t, p = run["probe_time"].values, run["probe_pressure"].values
    if run.attrs["case_name"] == "hydrostatic-tank":
        rest = rest_pressure(run, run["probe_y"].values)
        return float(np.sqrt(np.mean((p[t >= 0.5 * t[-1]] - rest) ** 2)) / scale)
    if run is finest or finest.attrs["completed"] != "yes":
        return math.nan
    other, window = finest["probe_pressure"].values, 0.01 * t[-1]
    squares = []
    for k in range(p.shape[1]):
        one = running_mean(t, p[:, k], window, 0.2 * window)
        two = running_mean(finest["probe_time"].values, other[:, k], window, 0.2 * window)
        squares.append(np.mean((one.values - np.interp(one["t"], two["t"], two)) ** 2))
    return float(np.sqrt(np.mean(squares)) / scale)


def _order(spacings: list[float], errors: np.ndarray[Any, Any]) -> float:
    known = np.isfinite(errors) & (errors > 0.0)
    return convergence_order(np.array(spacings)[known], errors[known]) if known.sum() > 1 else math.nan


def _chapter(dataset: xr.Dataset) -> Chapter:
    rows: list[dict[str, Cell]] = []
    for method in dataset["interpolator"].values:
        for spacing in dataset["particle_spacing"].values:
            one = dataset.sel(interpolator=method, particle_spacing=spacing)
            rows.append(
                {
                    "method": str(method),
                    "particle spacing (m)": float(spacing),
                    "particles": int(one["particles"]),
                    "error": float(one["error"]),
                    "observed order": float(one["order"]),
                    "wall clock (s)": float(one["wall_clock"]),
                    "us a particle and step": float(one["cost"]),
                    "energy above its start (%)": 100.0 * float(one["energy_excess"]),
                    "fallback (% of wet ghosts)": float(one["fallback"]),
                    "to the end": "yes" if int(one["completed"]) else "no",
                }
            )
    return Chapter(
        "comparison",
        "Comparison",
        [
            f"The error is the {dataset['error'].attrs['long_name']}"
            + (" over rho g H." if dataset["error"].attrs["units"] == "1" else ", in Pa.")
            + " The wall-clock time is that of a run beside others on the same machine: compare costs in it roughly,"
            " and measure them with sphframe reproduce --only cost.",
        ],
        [Table("comparison", "Error and cost of each method at each resolution", rows)],
        [_curves(dataset), *([_histories(dataset)] if dataset.sizes["probe"] else [])],
    )


def _curves(dataset: xr.Dataset) -> Picture:
    figure = new_figure(10.0, 4.0)
    left, right = figure.subplots(1, 2)
    for method in dataset["interpolator"].values:
        one = dataset.sel(interpolator=method)
        style: dict[str, Any] = {"color": colour(str(method)), "marker": "o", "markersize": 4, "linewidth": 1.0}
        order = float(one["order"])
        label = str(method) if math.isnan(order) else f"{method}, order {order:.2f}"
        error = one["error"].where(one["error"] > 0.0)
        if error.notnull().any():
            left.plot(one["particle_spacing"], error, label=label, **style)
        right.plot(one["particle_spacing"], one["wall_clock"], label=str(method), **style)
    tidy(left, xscale="log", yscale="log" if left.lines else "linear", xlabel="particle spacing (m)", ylabel="error")
    tidy(right, xscale="log", yscale="log", xlabel="particle spacing (m)", ylabel="wall clock (s)")
    if left.lines:
        left.legend(fontsize=8, frameon=False)
    right.legend(fontsize=8, frameon=False)
    return picture("comparison", "Error and cost against resolution.", figure)


def _histories(dataset: xr.Dataset) -> Picture:
    names = [str(p) for p in dataset["probe"].values][:4]
    figure = new_figure(10.0, 2.4 * len(names) + 0.8)
    panels = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
    for axes, name in zip(panels, names, strict=True):
        for method in dataset["interpolator"].values:
            one = dataset["probe_pressure"].isel(particle_spacing=-1).sel(interpolator=method, probe=name)
            axes.plot(*thinned(one["probe_time"], one), color=colour(str(method)), linewidth=0.8, label=str(method))
        tidy(axes, title=name, ylabel="p (Pa)")
    panels[-1].set_xlabel("t (s)")
    panels[0].legend(fontsize=8, frameon=False, ncols=3)
    return picture("comparison_probes", "Pressure at the probes, finest resolution.", figure)
