"""Studies: runs one case with several methods at several resolutions and compares the results."""

import contextlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from sphframe.analysis import read_reference_series
from sphframe.analysis.exact import references_by_name
from sphframe.analysis.reference import shipped_references
from sphframe.analysis.scales import dimensional
from sphframe.cases import Case, load_case
from sphframe.errors import InputError
from sphframe.output import open_dataset
from sphframe.output.files import replaced_as_a_whole
from sphframe.registry import available
from sphframe.studies.comparison_chapter import comparison_chapter
from sphframe.studies.comparison_dataset import comparison_dataset
from sphframe.studies.engine import ProgressListener, carry_out
from sphframe.studies.ensemble import displaced, ensemble_variables
from sphframe.studies.report import write_report
from sphframe.studies.tasks import RunTask, software_of


@dataclass(frozen=True)
class Comparison:
    """What :func:`compare` returns.

    Attributes
    ----------
    dataset
        over (interpolator, particle_spacing): ``error``, ``processor_time`` (s), ``steps``, ``particles``,
        ``cost`` (us per particle and step), ``energy_excess``, ``fallback`` (% of wet ghosts) and ``completed``;
        ``order`` over (interpolator); ``probe_pressure`` over (interpolator, particle_spacing, probe, probe_time), Pa,
        at times that are common to all runs.
    report
        path of the page.
    """

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
    repeats: int = 1,
    workers: int | None = None,
    scheduler: str | None = None,
    on_progress: ProgressListener | None = None,
) -> Comparison:
    """Run ``case`` once with each method at each particle spacing, and compare errors, costs and observed orders.

    The error is the RMS difference of the pressure at ``probe``, over rho g H (Pa without gravity), from ``reference``
    if it is given. Otherwise it is the first error of a case with an exact solution
    (:meth:`sphframe.cases.ExactCase.errors`); for ``hydrostatic-tank`` the RMS difference of the probes' pressures from
    the state of rest, over the second half of the run; and else from the same method at the finest spacing, both as
    running means over a hundredth of the run.
    The observed order is the power of the spacing with which the error falls, by least squares over all spacings.

    Parameters
    ----------
    case, preset, parameters
        as for :func:`sphframe.load_case`.
    interpolators
        names of methods: interpolators for the ghosts of the wall treatment of the case, or other wall treatments.
    spacings
        m; by default the spacing of the case.
    output
        folder for ``comparison.nc``, ``report.html``, ``report.md``, ``figures/``, ``tables/`` and ``runs/``.
    reference
        file of a series of p/(rho g H) over t sqrt(g/H), see :func:`sphframe.analysis.read_reference_series`. Without
        it the report shows the series that the case ships, if there is one.
    probe
        name of the probe that is compared with the reference; by default the first.
    repeats
        number of runs with each method at each spacing. The particles start displaced at random, by up to a
        fiftieth of a spacing, in all but the first; the dataset then holds ``peak`` and ``impulse`` of each probe in
        each run, and the report their 95 % bands and which methods differ significantly.
    workers, scheduler, on_progress
        see :func:`sphframe.studies.engine.carry_out`.

    Raises
    ------
    InputError
        a method, a spacing or a parameter is not valid.
    OutputError
        the folder cannot be written.
    SphframeError
        a run could not be made. A run that is stopped by its guards raises nothing: it is a result.
    """
    if not 1 <= repeats <= 1000:
        raise InputError(f"repeats = {repeats}: give a number of runs from 1 to 1000")
    tasks = _tasks(case, interpolators, spacings, preset, parameters or {}, repeats)
    series = None if reference is None else read_reference_series(reference.parent, reference.stem)
    files = carry_out(tasks.values(), output / "runs", workers=workers, scheduler=scheduler, on_progress=on_progress)
    with contextlib.ExitStack() as stack:
        runs = {key: stack.enter_context(open_dataset(files[task.label])) for key, task in tasks.items()}
        dataset = comparison_dataset({key[:2]: run for key, run in runs.items() if key[2] == 0}, series, probe)
        first = next(iter(runs.values()))
        probes = [str(name) for name in dataset["probe"].values]
        drawn = references_by_name(shipped_references(first) if series is None else [], first, probes)
        if series is not None and probes:
            drawn[probe or probes[0]].append(dimensional(series, first))
        if repeats > 1:
            dataset = dataset.assign(ensemble_variables(runs))
    with replaced_as_a_whole(output / "comparison.nc") as draft:
        dataset.to_netcdf(draft, engine="netcdf4")
    sizes = dataset["error"].sizes
    title = f"{dataset.attrs['title']}: {sizes['interpolator']} methods, {sizes['particle_spacing']} resolutions"
    report = write_report(output, title, [comparison_chapter(dataset, drawn)], facts=software_of(tasks.values()))
    return Comparison(dataset, report)


def _tasks(
    case: Case | str,
    interpolators: Sequence[str],
    spacings: Sequence[float],
    preset: str | None,
    parameters: Mapping[str, Any],
    repeats: int,
) -> dict[tuple[str, float, int], RunTask]:
    """Return the runs by method, particle spacing and number of the repeat, the largest spacing first."""
    if len(set(interpolators)) != len(interpolators) or not interpolators:
        raise InputError(f"give each method once, such as improved-shepard,mls-linear, not {','.join(interpolators)}")
    given = {name: value for name, value in parameters.items() if name != "particle_spacing"}
    chosen = sorted({float(s) for s in spacings} or {load_case(case, preset, given).particle_spacing}, reverse=True)
    treatments = {entry.name for entry in available("wall_treatments")}

    def run(method: str, spacing: float, seed: int) -> Case:
        kind = "wall_treatment" if method in treatments else "interpolator"
        chosen_method = {f"{kind}.name": method, "particle_spacing": spacing}
        return load_case(case, preset, {**given, **displaced(seed), **chosen_method})

    return {
        (method, spacing, seed): RunTask.of(
            f"{method} {spacing:g}" + (f" {seed}" if seed else ""), run(method, spacing, seed)
        )
        for method in interpolators
        for spacing in chosen
        for seed in range(repeats)
    }
