"""CLI: ``sphframe verify --order``."""

import math
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table
from rich.text import Text

from sphframe.cli.verify import markdown

if TYPE_CHECKING:
    from sphframe.testing import Fit, OrderReport

COLUMNS = {
    "pressure": "pressure",
    "divergence": "divergence",
    "viscosity": "viscosity",
    "shear": "shear",
    "slip_divergence": "divergence, slip",
    "slip_viscosity": "viscosity, slip",
    "density_gradient": "density gradient",
}
HEADINGS = ("component", "", *COLUMNS.values())
_LEGEND = (
    "measured: order of the error near a straight wall on the lattice, with 95 % confidence; error: with 32 spacings\n"
    "elsewhere: lowest order at circular and wavy walls, and with particles jittered, nearer or farther\n"
    "promised: at the straight wall; elsewhere. exact: no error but round-off. See sphframe.testing.order\n"
)


def print_orders(reports: "Sequence[OrderReport]", as_markdown: bool) -> None:
    """Print a table of orders, and every promise that does not hold."""
    console = Console(markup=False, highlight=False, soft_wrap=True, width=None if sys.stdout.isatty() else 160)
    rows = [row for report in reports for row in order_rows(report)]
    if as_markdown:
        print(markdown(HEADINGS, rows))
    else:
        table = Table(*HEADINGS, box=None, pad_edge=False)
        for row in rows:
            table.add_row(*row)
        console.print(table)
        console.print(_LEGEND)
    for report in reports:
        for failure in report.failures():
            console.print(Text.assemble(("broken: ", "bold red"), f"{report.name}: {failure}"))
    count = sum(report.broken for report in reports)
    console.print(f"{count} of {len(reports)} break" if count else f"all {len(reports)} keep", "their promised orders")


def order_rows(report: "OrderReport") -> list[list[Text]]:
    """Return the rows of a component: measured order, error, lowest order elsewhere, and promise of each operator."""
    rows = [[Text(heading)] for heading in ("measured", "error", "elsewhere", "promised")]
    for operator in COLUMNS:
        promise = getattr(report.promised, operator, None)
        promised = "-" if promise is None else f"{promise.straight:g}; {_number(promise.anywhere)}"
        cells = ["", "", "", promised]
        if operator in report.fits:
            straight, lowest = report.straight(operator), report.lowest(operator)
            cells[:2] = _order(straight), f"{straight.error:.2g}"
            cells[2] = "" if lowest is None else _order(lowest[1])
        broken = any(failure.startswith(f"{operator.replace('_', ' ')}:") for failure in report.failures())
        for row, cell in zip(rows, cells, strict=True):
            row.append(Text(cell, "bold red" if broken else ""))
    return [[Text(report.name if k == 0 else ""), *row] for k, row in enumerate(rows)]


def _number(order: float | None) -> str:
    return "-" if order is None else f"{order:g}"


def _order(fit: "Fit") -> str:
    return "exact" if math.isinf(fit.order) else f"{round(fit.order, 2) + 0.0:.2f} ± {fit.spread:.2f}"
