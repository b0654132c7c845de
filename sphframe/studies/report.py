"""Studies: writes chapters as one self-contained page, with every figure and table as a file of its own, and as
Markdown beside these.

All text passes through jinja2's escaping: names that come from cases, plugins or files are shown, never interpreted.
"""

import base64
import csv
import io
import math
from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path

from sphframe.errors import InputError, OutputError
from sphframe.output.files import replaced_as_a_whole
from sphframe.studies.chapter import Cell, Chapter, Picture, Table, Verdict

__all__ = ["shown", "write_report"]

_MIME = {"svg": "image/svg+xml", "png": "image/png"}


def write_report(
    folder: Path, title: str, chapters: Sequence[Chapter], *, preface: Sequence[str] = (), facts: Mapping[str, str]
) -> Path:
    """Write ``report.html``, ``report.md``, ``figures/`` and ``tables/`` into ``folder``; return the page.

    Parameters
    ----------
    preface: paragraphs at the top.
    facts: what computed the results, by name.

    Raises
    ------
    InputError: jinja2 is not installed.
    OutputError: a file cannot be written.
    """
    if find_spec("jinja2") is None:
        raise InputError("the report needs jinja2: python -m pip install 'sphframe[reproduce]'")
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("sphframe.studies", "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters.update(shown=shown, data_uri=_data_uri, cell=_markdown_cell)
    claims = [claim for chapter in chapters for claim in chapter.claims]
    claim_rows: list[dict[str, Cell]] = [
        {
            "where": claim.where,
            "claim": claim.statement,
            "verdict": claim.verdict.value,
            "paper": claim.published,
            "measured": claim.measured,
            "reason": claim.reason,
        }
        for claim in claims
    ]
    page, markdown = (
        environment.get_template(f"{name}.j2").render(
            title=title,
            preface=preface,
            chapters=chapters,
            claims=claim_rows,
            facts=facts,
            counts={verdict.value: sum(claim.verdict is verdict for claim in claims) for verdict in Verdict},
        )
        for name in ("report.html", "report.md")
    )
    for chapter in chapters:
        for picture in chapter.pictures:
            _write(folder / "figures" / f"{picture.name}.{picture.suffix}", picture.content)
        for table in chapter.tables:
            if table.rows:
                _write(folder / "tables" / f"{table.name}.csv", _csv(table).encode())
    if claims:
        _write(folder / "tables" / "claims.csv", _csv(Table("claims", "", claim_rows)).encode())
    _write(folder / "report.md", markdown.encode())
    path = folder / "report.html"
    _write(path, page.encode())
    return path


def shown(cell: Cell) -> str:
    """Return a table's cell as it is shown.

    >>> shown(0.123456), shown(12345.6), shown(float("nan")), shown(7), shown("yes"), shown(None)
    ('0.1235', '1.235e+04', '-', '7', 'yes', '-')
    """
    if cell is None or (isinstance(cell, float) and math.isnan(cell)):
        return "-"
    return f"{cell:.4g}" if isinstance(cell, float) else str(cell)


def _markdown_cell(text: str) -> str:
    """Text that stays in its cell of a table."""
    return " ".join(text.replace("|", "\\|").split())


def _data_uri(picture: Picture) -> str:
    return f"data:{_MIME[picture.suffix]};base64,{base64.b64encode(picture.content).decode()}"


def _csv(table: Table) -> str:
    file = io.StringIO()
    writer = csv.DictWriter(file, table.heads, lineterminator="\n")
    writer.writeheader()
    writer.writerows(
        {head: f"{cell:.6g}" if isinstance(cell, float) else cell for head, cell in row.items()} for row in table.rows
    )
    return file.getvalue()


def _write(path: Path, content: bytes) -> None:
    """Replace ``path`` by ``content``: what was there stays until all is written."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with replaced_as_a_whole(path) as draft:
            draft.write_bytes(content)
    except OSError as error:
        raise OutputError(
            f"cannot write {path}: {error.strerror or error}; free some space or check the folder"
        ) from None
