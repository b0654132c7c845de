"""CLI: ``sphframe compare``."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import xarray as xr
from rich.console import Console
from rich.table import Table
from rich.text import Text

from sphframe.cli.run import console_log
from sphframe.cli.studies_progress import shown_progress
from sphframe.cli.values import allow_imports_from_here
from sphframe.errors import InputError
from sphframe.studies import compare
from sphframe.studies.report import shown


def compare_command(
    case: str,
    *,
    interpolators: str,
    preset: str | None,
    parameters: Mapping[str, Any],
    reference: Path | None,
    probe: str | None,
    repeats: int,
    workers: int | None,
    scheduler: str | None,
    output: Path,
) -> None:
    """Compare methods over resolutions; print the table and the paths of the files that were written."""
    allow_imports_from_here([case, *interpolators.split(","), *parameters.values()])
    with shown_progress(console_log()) as on_progress:
        comparison = compare(
            case,
            [name.strip() for name in interpolators.split(",") if name.strip()],
            _numbers(parameters.get("particle_spacing")),
            output=output,
            preset=preset,
            parameters={name: value for name, value in parameters.items() if name != "particle_spacing"},
            reference=reference,
            probe=probe,
            repeats=repeats,
            workers=workers,
            scheduler=scheduler,
            on_progress=on_progress,
        )
    screen = Console(markup=False, highlight=False, soft_wrap=True)
    screen.print(_table(comparison.dataset))
    if comparison.dataset["waited"].any():
        screen.print("the machine was not idle: runs had to wait; compare processor times, not wall-clock times")
    screen.print(
        "cost: processor time per particle and step; the time of a run includes compilation, the cost does not"
    )
    screen.print(f"error: {comparison.dataset['error'].attrs['long_name']}", markup=False)
    for path in (output / "comparison.nc", comparison.report):
        screen.print(f"wrote {path}", markup=False)


def _table(dataset: xr.Dataset) -> Table:
    table = Table(box=None, pad_edge=False)
    table.add_column("method", no_wrap=True, min_width=max(len(str(name)) for name in dataset["interpolator"].values))
    for head in ("spacing (m)", "error", "order", "CPU time (s)", "cost (us)", "fallback (%)", "to the end"):
        table.add_column(head, overflow="fold", min_width=max(len(word) for word in head.split()))
    for method in dataset["interpolator"].values:
        for spacing in dataset["particle_spacing"].values:
            one = dataset.sel(interpolator=method, particle_spacing=spacing)
            numbers = (float(one[name]) for name in ("error", "order", "processor_time", "cost", "fallback"))
            done = "yes" if int(one["completed"]) else "no"
            table.add_row(Text(str(method)), f"{spacing:g}", *(shown(number) for number in numbers), done)
    return table


def _numbers(given: object) -> Sequence[float]:
    """Return the numbers of ``0.02,0.01``, of one number, or of a list."""
    if given is None:
        return ()
    try:
        if isinstance(given, str):
            return [float(text) for text in given.split(",")]
        return [float(value) for value in (given if isinstance(given, list) else [given])]  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise InputError(
            f"particle_spacing={given}: give numbers separated by commas, such as"
            " --set particle_spacing=0.02,0.01,0.005"
        ) from None
