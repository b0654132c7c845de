"""Studies: makes the league table: all runs that are not made yet, the dataset and the pages."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from sphframe.errors import InputError, PluginError
from sphframe.output.files import replaced_as_a_whole
from sphframe.simulation.components import Components
from sphframe.studies.engine import ProgressListener, carry_out
from sphframe.studies.league.entrants import Benchmarked, Method, installed_benchmarks, installed_methods
from sphframe.studies.league.pages import write_pages
from sphframe.studies.league.result import Outcome, ScoreTask
from sphframe.studies.league.standings import Standing, standings
from sphframe.studies.league.table import Key, league_dataset
from sphframe.studies.report import write_file
from sphframe.studies.tasks import software_of


@dataclass(frozen=True)
class League:
    """The table: its ``dataset``, see :func:`sphframe.studies.league.table.league_dataset`, and its first ``page``.

    ``standings``: median rank, numbers of benchmarks and cost of each method, by name, the lowest rank first.
    """

    dataset: xr.Dataset
    standings: Mapping[str, Standing]
    page: Path


def rank(
    *,
    output: Path,
    methods: Sequence[str] = (),
    benchmarks: Sequence[str] = (),
    quick: bool = False,
    repeats: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    on_progress: ProgressListener | None = None,
) -> League:
    """Run every method on every benchmark, rank the methods, and write dataset and pages into ``output``.

    A call that was interrupted continues when it is repeated: a finished run is never repeated.

    Parameters
    ----------
    output
        folder for ``index.html``, ``table.csv``, ``table.nc``, ``table.md``, ``provenance.json``, ``figures/`` and
        ``runs/``.
    methods, benchmarks
        names; by default all that are installed.
    quick
        run at the coarsest particle spacing of each benchmark alone, once.
    repeats
        number of runs at the coarsest spacing, with particles displaced at random by up to a fiftieth of a
        spacing in all but the first; by default 3, with ``quick`` 1. Differences within their spread are ties.
    workers, scheduler, on_progress
        see :func:`sphframe.studies.engine.carry_out`.

    Raises
    ------
    InputError
        a name is not known, or a number is out of range.
    OutputError
        the folder cannot be written.
    """
    count = repeats if repeats is not None else 1 if quick else 3
    if not 1 <= count <= 100:
        raise InputError(f"repeats = {count}: give a number of runs from 1 to 100")
    rows, columns = installed_methods(methods), installed_benchmarks(benchmarks)
    if not columns:
        raise InputError("no benchmark is installed; those of sphframe: pip install 'sphframe[flows]'")
    resolutions = 1 if quick else max(len(one.benchmark.spacings) for one in columns)
    tasks, refused = _tasks(rows, columns, resolutions, count)
    files = carry_out(tasks.values(), output / "runs", workers=workers, scheduler=scheduler, on_progress=on_progress)
    results = {key: _read(files[task.label]) for key, task in tasks.items()}
    found = {key: result.attrs for key, result in results.items()} | refused
    dataset = league_dataset(rows, columns, resolutions, count, found).assign_attrs(
        title="League table of wall treatments", repeats=count, quick="yes" if quick else "no"
    )
    facts = software_of(tasks.values())
    with replaced_as_a_whole(output / "table.nc") as draft:
        dataset.to_netcdf(draft, engine="netcdf4")
    provenance = json.dumps(_provenance(rows, columns, facts), indent=1) + "\n"
    write_file(output / "provenance.json", provenance.encode())
    standing = standings(dataset)
    page = write_pages(output, dataset, standing, rows, columns, results, facts)
    return League(dataset, standing, page)


def _tasks(
    methods: Sequence[Method], benchmarks: Sequence[Benchmarked], resolutions: int, repeats: int
) -> tuple[dict[Key, ScoreTask], dict[Key, Mapping[str, Any]]]:
    """Return the runs, and the results of those that are refused before they start."""
    tasks: dict[Key, ScoreTask] = {}
    refused: dict[Key, Mapping[str, Any]] = {}
    for method in methods:
        for one in benchmarks:
            for index, spacing in enumerate(one.benchmark.spacings[:resolutions]):
                for seed in range(repeats if index == 0 else 1):
                    key = (method.name, one.name, index, seed)
                    label = f"{one.name} {method.name} {spacing:g} {seed}"
                    try:
                        case = one.case(spacing, seed, method)
                        Components.of_case(case)
                        tasks[key] = ScoreTask(label, one.case_name, case.model_dump(mode="json"))
                    except PluginError as error:
                        refused[key] = {"outcome": str(Outcome.BROKEN), "message": str(error)}
                    except InputError as error:
                        refused[key] = {"outcome": str(Outcome.NOT_APPLICABLE), "message": str(error)}
    return tasks, refused


def _read(path: Path) -> xr.Dataset:
    with xr.open_dataset(path, engine="netcdf4") as dataset:
        return dataset.load()


def _provenance(
    methods: Sequence[Method], benchmarks: Sequence[Benchmarked], facts: Mapping[str, str]
) -> dict[str, Any]:
    """Return what the table was made with."""
    return {
        "software": dict(facts),
        "methods": {method.name: method.distribution for method in methods},
        "benchmarks": {
            one.name: {
                "case": one.case_name,
                "score": one.benchmark.score,
                "spacings": list(one.benchmark.spacings),
                "parameters": dict(one.benchmark.parameters),
            }
            for one in benchmarks
        },
    }
