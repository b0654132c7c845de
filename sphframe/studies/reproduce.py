"""Studies: the paper from its cases to the report."""

import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path

import xarray as xr

import sphframe
from sphframe.errors import InputError, OutputError
from sphframe.output import open_dataset
from sphframe.output.provenance import distributions, software
from sphframe.registry.nearest import did_you_mean
from sphframe.studies.chapter import Table
from sphframe.studies.engine import Watch, carry_out
from sphframe.studies.report import write_report
from sphframe.studies.sections import SECTIONS, Section
from sphframe.studies.series import Reference

__all__ = ["reproduce"]

TITLE = "Huang et al. (2019), Water 11, 1110, computed anew"
_SOURCE = (
    "X. Huang, W. Chen, Z. Hu, X. Zheng, S. Jin, X. Zhang: Application Research of an Efficient and Stable Boundary"
    " Processing Method for the SPH Method. Water 11 (2019) 1110, doi:10.3390/w11051110. Every run of the paper's"
    " sections was made anew with each method that the paper compares, by its mirror lift, and with this project's own"
    " variants beside them. What is printed wrong or not given there is settled in the documentation of the cases and"
    " methods."
)
_QUICK = (
    "This is the quick version, at coarse resolutions and for short times: it shows that everything works, and its"
    " numbers and verdicts are not those of the paper's resolutions."
)


def reproduce(
    output: Path,
    *,
    only: Sequence[str] = (),
    quick: bool = False,
    reference: Path | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    watch: Watch = lambda progress: None,
    sections: Mapping[str, Section] = SECTIONS,
) -> Path:
    """Run what is missing of the paper's sections and write the report; return its path.

    Interrupted at any moment and called again, it continues where it stopped: a finished run is never repeated, an
    unfinished one goes on from its last checkpoint, and the report is the same as without the interruption.

    Parameters
    ----------
    output: folder for ``report.html``, ``figures/``, ``tables/`` and ``runs/``.
    only: names of sections; all by default.
    quick: coarse and short, in minutes.
    reference: folder of reference series, see :func:`sphframe.analysis.read_reference_series`; what it lacks is left
        out, and the report says so.
    workers, scheduler, watch: see :func:`sphframe.studies.engine.carry_out`.
    sections: all sections there are.

    Raises
    ------
    InputError: a section is unknown, or something is not installed.
    OutputError: the folder cannot be written.
    SphframeError: what a run raised that is not a result of its own.
    """
    unknown = [name for name in only if name not in sections]
    if unknown:
        raise InputError(
            f"there is no section {unknown[0]!r}{did_you_mean(unknown[0], sections)}; choose of {', '.join(sections)}"
        )
    chosen = {name: section for name, section in sections.items() if not only or name in only}
    series = Reference(reference)
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"cannot make the folder {output}: {error.strerror or error}; give another --output"
        ) from None
    tasks = {name: section.tasks(quick) for name, section in chosen.items()}
    every = [task for own in tasks.values() for task in own]
    files = carry_out(every, output / "runs", workers=workers, scheduler=scheduler, watch=watch)
    chapters, versions = [], dict[str, str]()
    for name, section in chosen.items():
        opened = {task.label: _open(files[task.label]) for task in tasks[name]}
        try:
            series.absent.clear()
            chapter = section.chapter(opened, series, quick)
            stopped = _stopped(name, opened)
        finally:
            for dataset in opened.values():
                dataset.close()
        chapters.append(dataclasses.replace(chapter, tables=[*chapter.tables, stopped], absent=tuple(series.absent)))
        for task in tasks[name]:
            versions |= distributions(task.case())
    return write_report(
        output,
        TITLE,
        chapters,
        preface=[_SOURCE, *([_QUICK] if quick else [])],
        facts={"sphframe": sphframe.__version__, **dict(sorted(versions.items())), **software()},
    )


def _stopped(section: str, runs: Mapping[str, xr.Dataset]) -> Table:
    """The runs that did not come to their end, and what they said."""
    rows = [
        {"run": label, "what it said": dataset.attrs["run_message"]}
        for label, dataset in runs.items()
        if dataset.attrs.get("completed", "yes") != "yes"
    ]
    return Table(f"{section.replace('-', '_')}_stopped", "Runs that were stopped by their guards", rows)


def _open(path: Path) -> xr.Dataset:
    try:
        return open_dataset(path)
    except InputError:
        with xr.open_dataset(path, engine="netcdf4") as dataset:  # of measured times
            return dataset.load()
