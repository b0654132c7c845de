"""Studies: carries out a study, from its runs to the report."""

import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path

import xarray as xr

from sphframe.errors import InputError
from sphframe.output import open_dataset
from sphframe.registry.nearest import did_you_mean
from sphframe.studies.chapter import Chapter, Table
from sphframe.studies.engine import ProgressListener, carry_out
from sphframe.studies.report import write_report
from sphframe.studies.section import Section
from sphframe.studies.series import Reference
from sphframe.studies.study import Study, installed_study
from sphframe.studies.tasks import software_of

_QUICK = (
    "This is the quick version, at coarse resolutions and for short times. It shows that everything works; its numbers"
    " and verdicts differ from those of the whole study."
)


def reproduce(
    study: Study | str,
    *,
    output: Path,
    only: Sequence[str] = (),
    quick: bool = False,
    reference: Path | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    on_progress: ProgressListener | None = None,
) -> Path:
    """Carry out the runs of a study that are not done yet, and write the report; return its path.

    A call that was interrupted continues when it is repeated: a finished run is never repeated, an unfinished one goes
    on from its last checkpoint, and the report is the same as without the interruption.

    Parameters
    ----------
    study
        a study, or the name of an installed one.
    output
        folder for ``report.html``, ``report.md``, ``figures/``, ``tables/`` and ``runs/``.
    only
        names of sections; all by default.
    quick
        run at coarse resolutions and for short times, which takes minutes.
    reference
        folder of reference series, see :func:`sphframe.analysis.read_reference_series`. Series that are not
        there are left out, and the report names them.
    workers, scheduler, on_progress
        see :func:`sphframe.studies.engine.carry_out`.

    Raises
    ------
    InputError
        a section is unknown, or something is not installed.
    PluginError
        the study is not installed or cannot be used.
    OutputError
        the folder cannot be written.
    SphframeError
        a run raised an error that is not a result in itself.
    """
    chosen_study = installed_study(study) if isinstance(study, str) else study
    sections = _chosen(chosen_study.sections(), only)
    series = Reference(reference)
    tasks = {section.name: section.tasks(quick) for section in sections}
    every = [task for own in tasks.values() for task in own]
    files = carry_out(every, output / "runs", workers=workers, scheduler=scheduler, on_progress=on_progress)
    return write_report(
        output,
        chosen_study.title,
        [
            _chapter(section, {task.label: files[task.label] for task in tasks[section.name]}, series, quick)
            for section in sections
        ],
        preface=[chosen_study.source, *([_QUICK] if quick else [])],
        facts=software_of(every),
    )


def _chosen(sections: Sequence[Section], only: Sequence[str]) -> list[Section]:
    names = [section.name for section in sections]
    for name in only:
        if name not in names:
            raise InputError(f"there is no section {name!r}{did_you_mean(name, names)}; choose from {', '.join(names)}")
    return [section for section in sections if not only or section.name in only]


def _chapter(section: Section, files: Mapping[str, Path], series: Reference, quick: bool) -> Chapter:
    """Write the chapter of a section from the files of its runs, with a table of the runs that were stopped."""
    runs = {label: _open(path) for label, path in files.items()}
    try:
        series.absent.clear()
        chapter = section.chapter(runs, series, quick)
        stopped = _stopped(section.name, runs)
    finally:
        for dataset in runs.values():
            dataset.close()
    return dataclasses.replace(chapter, tables=[*chapter.tables, stopped], absent=tuple(series.absent))


def _stopped(section: str, runs: Mapping[str, xr.Dataset]) -> Table:
    """Return a table of the runs that stopped early, with the messages of their guards."""
    rows = [
        {"run": label, "message": dataset.attrs["run_message"]}
        for label, dataset in runs.items()
        if dataset.attrs.get("completed", "yes") != "yes"
    ]
    return Table(f"{section.replace('-', '_')}_stopped", "Runs that were stopped by their guards", rows)


def _open(path: Path) -> xr.Dataset:
    try:
        return open_dataset(path)
    except InputError:
        with xr.open_dataset(path, engine="netcdf4") as dataset:  # measured times, which are not the output of a run
            return dataset.load()
