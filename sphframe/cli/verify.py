"""CLI: ``sphframe verify``."""

import json
import sys
from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from sphframe.cli.values import allow_imports_from_here
from sphframe.errors import InputError

if TYPE_CHECKING:
    from sphframe.testing import Report
    from sphframe.testing.verification import Result

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
_WALL_COLUMNS = {
    "C": ("exact_constant",),
    "H": ("exact_hydrostatic",),
    "S": ("exact_shear",),
    "D": ("exact_normal",),
    "J": ("conjugate",),
    "M": ("momentum",),
}
_MARKS = {
    "kept": ("yes", "green"),
    "held": ("(yes)", "yellow"),
    "broken": ("BROKEN", "bold red"),
    "absent": ("-", "dim"),
    "expected": ("expected", "yellow"),
}
_BROKEN = ("broken: ", "bold red")
_SHOWN = 3
"""number of broken properties of a component that are explained"""


def verify_command(
    names: Sequence[str], *, as_json: bool, as_markdown: bool, order: bool = False, junit: Path | None = None
) -> None:
    """Verify components; exit with 1 when one violates its declared traits."""
    raise typer.Exit(verify(names, as_json=as_json, as_markdown=as_markdown, order=order, junit=junit))


def verify(
    names: Sequence[str] = (),
    *,
    as_json: bool = False,
    as_markdown: bool = False,
    order: bool = False,
    junit: Path | None = None,
) -> int:
    """Check components against their declared traits, and print a table and every failure.

    Parameters
    ----------
    names
        as for :func:`sphframe.testing.verify`; all interpolation methods and wall treatments by default.
    as_json, as_markdown
        print JSON, or tables in Markdown, in place of tables of text.
    order
        measure orders of convergence near walls instead, see :func:`sphframe.testing.measure_order`.
    junit
        where the results are also written as JUnit XML.

    Returns
    -------
    int
        The exit code: 1 when a component violates its declared traits, 0 otherwise.

    Raises
    ------
    InputError
        when the packages that the suite needs are not installed, or both forms are asked for.
    """
    if as_json and as_markdown:
        raise InputError("--json and --markdown exclude each other: choose one")
    if find_spec("hypothesis") is None:
        raise InputError("the verification suite needs hypothesis: python -m pip install 'sphframe[testing]'")
    allow_imports_from_here(names)
    reports_of: Any
    show: Any
    if order:
        from sphframe.cli.verify_order import print_orders as show
        from sphframe.testing import verify_order as reports_of
    else:
        from sphframe.testing import verify as reports_of

        show = _print
    console = Console(markup=False, highlight=False)
    if console.is_terminal and not as_json:
        with console.status("verifying") as status:
            reports = list(reports_of(names, progress=lambda text: status.update(f"verifying {text}")))
    else:
        reports = list(reports_of(names))
    if junit is not None:
        from sphframe.testing.junit import write_junit

        write_junit(reports, junit)
    if as_json:
        print(json.dumps([report.as_data() for report in reports], indent=2))
    else:
        show(reports, as_markdown)
    return int(any(report.broken for report in reports))


def _print(reports: "Sequence[Report]", as_markdown: bool) -> None:
    console = Console(markup=False, highlight=False, soft_wrap=True, width=None if sys.stdout.isatty() else 160)
    for kind, headings, rows_of, legend in _TABLES:
        chosen = [report for report in reports if report.kind == kind]
        rows = [row for report in chosen for row in rows_of(report)]
        if chosen and as_markdown:
            print(markdown(headings, rows))
        elif chosen:
            table = Table(*headings, box=None, pad_edge=False)
            for row in rows:
                table.add_row(*row)
            console.print(table)
            console.print(
                f"{legend}yes: declared and held; (yes): held though not declared; -: not declared; BROKEN: see below\n"
            )
    for report in reports:
        if report.kind not in ("interpolators", "wall_treatments"):
            console.print(Text(_line(report)))
    for report in reports:
        if report.error is not None:
            console.print(Text.assemble(_BROKEN, f"{report.name}: {report.error}\n"))
        for text in _failures(report):
            console.print(Text.assemble(_BROKEN, text))
    count = sum(report.broken for report in reports)
    verdict = f"{count} of {len(reports)} violate" if count else f"all {len(reports)} have"
    console.print(f"{verdict} their declared traits")


def _failures(report: "Report") -> list[str]:
    """Return a text for each of the first failures, those of both dimensions together, and the names of the others."""
    found: dict[str, list[Result]] = {}
    for result in report.results:
        if result.verdict == "broken":
            found.setdefault(result.check.name, []).append(result)
    texts = []
    for first, *others in list(found.values())[:_SHOWN]:
        also = f"(also in {others[0].check.dim}-D)\n" if others else ""
        why = first.failure or f"it was expected to fail ({first.expected}), but holds"
        texts.append(f"{report.name}, {first.check}\n{why}\n{also}")
    rest = list(found)[_SHOWN:]
    if rest:
        texts.append(f"{report.name}, also {', '.join(rest)}; sphframe verify --json explains each\n")
    return texts


def markdown(headings: Sequence[str], rows: "Sequence[Sequence[Text]]") -> str:
    """Return a table in Markdown."""
    lines = [headings, ["---"] * len(headings), *([cell.plain for cell in row] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def method_rows(report: "Report") -> list[list[Text]]:
    """Return the row of an interpolation method, a column per trait."""
    verdicts = report.verdicts()
    in_columns = {name for names in _COLUMNS.values() for name in names}
    rest = [verdict for name, verdict in verdicts.items() if name not in in_columns]
    ends = (*report.responses[:1], *report.responses[-1:])
    measured = [[one.noise for one in ends], [one.outlier for one in ends]]
    return [
        [
            Text(report.name),
            *_cells(report, _COLUMNS),
            _cell(rest) if report.error is None else _cell(["broken"]),
            *(Text(" / ".join(f"{value:.2f}" for value in values)) for values in measured),
        ]
    ]


def treatment_rows(report: "Report") -> list[list[Text]]:
    """Return the rows of a wall treatment, one per kernel: its traits, and its errors in the first two layers."""
    name, traits = Text(report.name), _cells(report, _WALL_COLUMNS)
    rows = []
    for kernel, residuals in report.measured.items():
        measured = [" / ".join(f"{round(value, 3) + 0.0:.3f}" for value in pair) for pair in residuals]
        rows.append([name, *traits, Text(kernel), *map(Text, measured)])
        name, traits = Text(""), [Text("")] * len(traits)
    return rows or [[name, *traits, *[Text("")] * 5]]


def _cells(report: "Report", columns: Mapping[str, tuple[str, ...]]) -> list[Text]:
    if report.error is not None:
        return [_cell(["broken"])] * len(columns)
    verdicts = report.verdicts()
    return [_cell([verdicts[n] for n in names if n in verdicts]) for names in columns.values()]


def _line(report: "Report") -> str:
    verdicts = report.verdicts()
    broken = [name for name, verdict in verdicts.items() if verdict == "broken"]
    return f"{report.name}: {'broken: ' + ', '.join(broken) if broken else 'holds ' + ', '.join(verdicts)}"


def _cell(verdicts: Sequence[str]) -> Text:
    for verdict in ("broken", "expected", "absent", "kept", "held"):
        if verdict in verdicts:
            return Text(*_MARKS[verdict])
    return Text("")


METHOD_HEADINGS = ("method", *_COLUMNS, "all else", "noise", "one outlier")
TREATMENT_HEADINGS = ("treatment", *_WALL_COLUMNS, "kernel", "uniform", "hydrostatic", "normal", "shear")
_TABLES = (
    (
        "interpolators",
        METHOD_HEADINGS,
        method_rows,
        "noise, one outlier: parts of the errors of all particles and of a single one that reach ghosts half a spacing"
        " and 2.5 spacings behind a wall (sphframe.testing.GhostResponse)\n",
    ),
    (
        "wall_treatments",
        TREATMENT_HEADINGS,
        treatment_rows,
        "C: uniform pressure, H: still water, S: shear, D: normal velocity are exact; J: no work of walls at rest; M:"
        " momentum is conserved; errors in the layers 1 / 2 as in sphframe.testing.WallResiduals\n",
    ),
)
