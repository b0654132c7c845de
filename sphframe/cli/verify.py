"""CLI: ``sphframe verify``."""

import json
import sys
from collections.abc import Sequence
from importlib.util import find_spec
from typing import TYPE_CHECKING

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from sphframe.cli.values import allow_imports_from_here
from sphframe.errors import InputError

if TYPE_CHECKING:
    from sphframe.testing import Report

_COLUMNS = {
    "sum is one": ("partition_of_unity",),
    "not negative": ("non_negative",),
    "in range": ("range_restricted",),
    "linear": ("linear_reproduction",),
    "quadratic": ("quadratic_reproduction",),
    "at particles": ("interpolates_particles",),
    "rotation": ("rotation_invariance",),
    "volumes": ("volume_independence",),
    "continuous": ("continuity",),
}
_MARKS = {
    "kept": ("yes", "green"),
    "held": ("(yes)", "yellow"),
    "broken": ("BROKEN", "bold red"),
    "absent": ("-", "dim"),
}
_BROKEN = ("broken: ", "bold red")


def verify_command(names: Sequence[str], *, as_json: bool) -> None:
    """Verify components; exit with 1 when one violates its declared traits."""
    raise typer.Exit(verify(names, as_json=as_json))


def verify(names: Sequence[str] = (), *, as_json: bool = False) -> int:
    """Check components against their declared traits, and print a table and every failure.

    Parameters
    ----------
    names: as for :func:`sphframe.testing.verify`; all installed interpolation methods by default.
    as_json: print JSON in place of the table.

    Returns
    -------
    The exit code: 1 when a component violates its declared traits, 0 otherwise.

    Raises
    ------
    InputError: when the packages that the suite needs are not installed.
    """
    if find_spec("hypothesis") is None:
        raise InputError("the verification suite needs hypothesis: python -m pip install 'sphframe[testing]'")
    allow_imports_from_here(names)
    from sphframe.testing import verify as reports_of

    if as_json:
        reports = list(reports_of(names))
        print(json.dumps([report.as_data() for report in reports], indent=2))
        return int(any(report.broken for report in reports))

    console = Console(markup=False, highlight=False)
    if console.is_terminal:
        with console.status("verifying") as status:
            reports = list(reports_of(names, progress=lambda text: status.update(f"verifying {text}")))
    else:
        reports = list(reports_of(names))
    _print(reports)
    return int(any(report.broken for report in reports))


def _print(reports: "Sequence[Report]") -> None:
    console = Console(markup=False, highlight=False, soft_wrap=True, width=None if sys.stdout.isatty() else 160)
    methods = [report for report in reports if report.kind == "interpolators"]
    if methods:
        console.print(_table(methods))
        console.print("yes: declared and held; (yes): held though not declared; -: not declared; BROKEN: see below\n")
    for report in reports:
        if report.kind != "interpolators":
            console.print(Text(_line(report)))
    for report in reports:
        if report.error is not None:
            console.print(Text.assemble(_BROKEN, f"{report.name}: {report.error}\n"))
        for result in report.results:
            if result.verdict == "broken":
                console.print(Text.assemble(_BROKEN, f"{report.name}, {result.check}\n{result.failure}\n"))
    count = sum(report.broken for report in reports)
    verdict = f"{count} of {len(reports)} violate" if count else f"all {len(reports)} have"
    console.print(f"{verdict} their declared traits")


def _table(reports: "Sequence[Report]") -> Table:
    """A row per interpolation method, a column per trait."""
    table = Table(box=None, pad_edge=False)
    for column in ("method", *_COLUMNS, "all else"):
        table.add_column(column)
    in_columns = {name for names in _COLUMNS.values() for name in names}
    for report in reports:
        verdicts = report.verdicts()
        cells = [_cell([verdicts[n] for n in names if n in verdicts]) for names in _COLUMNS.values()]
        cells.append(_cell([verdict for name, verdict in verdicts.items() if name not in in_columns]))
        if report.error is not None:
            cells = [Text(*_MARKS["broken"])] * len(cells)
        table.add_row(Text(report.name), *cells)
    return table


def _line(report: "Report") -> str:
    verdicts = report.verdicts()
    broken = [name for name, verdict in verdicts.items() if verdict == "broken"]
    return f"{report.name}: {'broken: ' + ', '.join(broken) if broken else 'holds ' + ', '.join(verdicts)}"


def _cell(verdicts: Sequence[str]) -> Text:
    for verdict in ("broken", "absent", "kept", "held"):
        if verdict in verdicts:
            return Text(*_MARKS[verdict])
    return Text("")
