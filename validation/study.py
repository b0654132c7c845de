"""What the validation cases share: run each variant once, keep its file, put the figures into the README."""

import argparse
import csv
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import xarray as xr

import sphframe
from sphframe.analysis import read_reference_series
from sphframe.errors import InputError, SphframeError
from sphframe.output.files import replaced_as_a_whole
from sphframe.simulation import Simulation

METHODS = ("improved-shepard", "normalized", "shepard", "sfdi", "mls-linear", "mls-quadratic")
"""The paper's boundary interpolation methods."""


def parser(description: str, default_output: str) -> argparse.ArgumentParser:
    """Return the command-line options that every validation case has."""
    made = argparse.ArgumentParser(description=description)
    made.add_argument("--output", type=Path, default=Path(default_output), help="scratch folder for the runs' files")
    made.add_argument("--particle-spacing", type=float, default=0.01, help="m")
    made.add_argument("--threads", type=int, default=None)
    made.add_argument("--methods", nargs="+", default=METHODS, metavar="NAME")
    made.add_argument("--again", action="store_true", help="run again what has been run")
    made.add_argument("--no-readme", action="store_true", help="print the figures, leave README.md and figures alone")
    return made


class _Patience:
    """Says once a minute how far a run has come."""

    def __init__(self, label: str) -> None:
        self.label, self.told = label, time.monotonic()

    @sphframe.hookimpl
    def sphframe_step_completed(self, simulation: Simulation) -> None:
        if time.monotonic() - self.told > 60.0:
            self.told = time.monotonic()
            print(f"  {self.label}: t = {simulation.time:.3f} s of {simulation.case.until:g} s", flush=True)


def dataset_of(
    case: sphframe.Case | str, path: Path, *, again: bool, threads: int | None, **parameters: Any
) -> xr.Dataset:
    """Run ``case`` into ``path`` unless a completed run of the same case is there; return what there is of it.

    A run that goes wrong is told and its file returned as far as it came: the table shows it.
    """
    wanted = sphframe.load_case(case, overrides=parameters)
    if path.exists() and not again:
        dataset = sphframe.open_dataset(path)
        if dataset.attrs["run_status"] != "running" and sphframe.load_case(path).model_dump() == wanted.model_dump():
            return dataset
    path.parent.mkdir(parents=True, exist_ok=True)
    print(f"running {path.stem}", flush=True)
    try:
        return sphframe.run(wanted, output=path, overwrite=True, threads=threads, hooks=[_Patience(path.stem)]).dataset
    except SphframeError as error:
        print(f"  {path.stem} failed: {error}", file=sys.stderr, flush=True)
        if not path.exists():
            raise
        return sphframe.open_dataset(path)


def reference_of(folder: Path | None, name: str) -> xr.DataArray | None:
    """The reference series, or None with a word about it when no folder was named."""
    if folder is None:
        print(f"no --reference folder: the comparison with {name} is left out")
        return None
    try:
        return read_reference_series(folder, name)
    except InputError as error:
        print(error, file=sys.stderr)
        return None


def table(rows: Sequence[Mapping[str, str]]) -> str:
    """Rows of texts as a Markdown table, the first row's keys being the heads."""
    heads = list(rows[0])
    widths = [max(len(head), *(len(row[head]) for row in rows)) for head in heads]
    lines = [heads, ["-" * width for width in widths], *([row[head] for head in heads] for row in rows)]
    return "\n".join(
        "| " + " | ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)) + " |" for line in lines
    )


def write_csv(path: Path, rows: Sequence[Mapping[str, Any]], comment: str) -> None:
    """Write the key figures in full precision below a header that says what they are."""
    with path.open("w", newline="", encoding="utf-8") as file:
        file.write(f"# {comment}\n")
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(
            {key: f"{value:.6g}" if isinstance(value, float) else value for key, value in row.items()} for row in rows
        )


def replace_block(readme: Path, name: str, text: str) -> None:
    """Replace what stands between ``<!-- name -->`` and ``<!-- /name -->`` in a README."""
    content = readme.read_text(encoding="utf-8")
    start, end = f"<!-- {name} -->", f"<!-- /{name} -->"
    before, _, rest = content.partition(start)
    _, _, after = rest.partition(end)
    with replaced_as_a_whole(readme) as draft:
        draft.write_text(f"{before}{start}\n{text}\n{end}{after}", encoding="utf-8")
