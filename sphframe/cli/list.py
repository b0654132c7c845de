"""CLI: ``sphframe list``."""

from rich.console import Console
from rich.table import Table
from rich.text import Text

from sphframe.registry import KINDS, available


def list_command(kind: str | None) -> None:
    """Print the components of one kind or of all kinds, with the distributions that provide them."""
    table = Table(box=None, pad_edge=False)
    for heading in ("kind", "name", "from", ""):
        table.add_column(heading, overflow="fold")
    for one in [kind] if kind else KINDS:
        for entry in available(one):
            origin = f"{entry.distribution} {entry.version}"
            table.add_row(one, entry.name, origin, Text(entry.error or "", style="red"))
    Console(markup=False, highlight=False).print(table)
