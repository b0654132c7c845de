"""Studies: writes a report as one self-contained HTML page and as Markdown, with figures and tables as files beside it.

In the HTML page all text is escaped: a name from a case, a plugin or a file is shown as it is and never interpreted.
In the Markdown only the characters that would begin an HTML element or end a cell of a table are escaped.
"""

import base64
import csv
import io
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from sphframe.errors import InputError, OutputError
from sphframe.output.files import replaced_as_a_whole
from sphframe.studies.chapter import Cell, Chapter, Picture, Table, Verdict

_MIME = {"svg": "image/svg+xml", "png": "image/png"}


def write_report(
    folder: Path, title: str, chapters: Sequence[Chapter], *, preface: Sequence[str] = (), facts: Mapping[str, str]
) -> Path:
    """Write ``report.html``, ``report.md``, ``figures/`` and ``tables/`` into ``folder``; return the path of the page.

    Parameters
    ----------
    preface
        paragraphs at the top.
    facts
        what computed the results, by name.

    Raises
    ------
    InputError
        jinja2 is not installed.
    OutputError
        a file cannot be written.
    """
    claims = _table_of_claims(chapters)
    content = {
        "title": title,
        "preface": preface,
        "chapters": chapters,
        "claims": claims.rows,
        "facts": facts,
        "counts": _count_verdicts(chapters),
    }
    page, markdown = render("report.html.j2", content), render("report.md.j2", content)
    _write_figures_and_tables(folder, chapters, claims)
    write_file(folder / "report.md", markdown.encode())
    path = folder / "report.html"
    write_file(path, page.encode())
    return path


def _table_of_claims(chapters: Sequence[Chapter]) -> Table:
    """Return the claims of all chapters as one table."""
    rows: list[dict[str, Cell]] = [
        {
            "where": claim.where,
            "claim": claim.statement,
            "verdict": claim.verdict.value,
            "paper": claim.published,
            "measured": claim.measured,
            "reason": claim.reason,
        }
        for chapter in chapters
        for claim in chapter.claims
    ]
    return Table("claims", "Claims", rows)


def _count_verdicts(chapters: Sequence[Chapter]) -> dict[str, int]:
    """Return the number of claims with each verdict, by the verdict's name."""
    found = Counter(claim.verdict for chapter in chapters for claim in chapter.claims)
    return {verdict.value: found[verdict] for verdict in Verdict}


def render(template: str, content: Mapping[str, Any]) -> str:
    """Fill in a template. Text is escaped where the template makes HTML, and only there."""
    if find_spec("jinja2") is None:
        raise InputError("the report needs jinja2: install it with python -m pip install 'sphframe[reproduce]'")
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("sphframe.studies", "templates"),
        autoescape=template.endswith(".html.j2"),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters.update(shown=shown, data_uri=_data_uri, cell=_markdown_cell, text=_markdown_text)
    return environment.get_template(template).render(content)


def _write_figures_and_tables(folder: Path, chapters: Sequence[Chapter], claims: Table) -> None:
    for chapter in chapters:
        for picture in chapter.pictures:
            write_file(folder / "figures" / f"{picture.name}.{picture.suffix}", picture.content)
    for table in [*(table for chapter in chapters for table in chapter.tables), claims]:
        if table.rows:
            write_file(folder / "tables" / f"{table.name}.csv", _csv(table).encode())


def shown(cell: Cell) -> str:
    """Return the text that a report shows for a cell of a table.

    >>> shown(0.123456), shown(12345.6), shown(float("nan")), shown(7), shown("yes"), shown(None)
    ('0.1235', '1.235e+04', '-', '7', 'yes', '-')
    """
    if cell is None or (isinstance(cell, float) and math.isnan(cell)):
        return "-"
    return f"{cell:.4g}" if isinstance(cell, float) else str(cell)


def _markdown_text(text: str) -> str:
    """Return ``text`` for Markdown, with ``<`` escaped so that no HTML element begins in it.

    >>> _markdown_text("the paper's <script>")
    "the paper's \\\\<script>"
    """
    return text.replace("<", "\\<")


def _markdown_cell(text: str) -> str:
    """Return ``text`` on one line and without the character that ends a cell of a Markdown table."""
    return " ".join(_markdown_text(text).replace("|", "\\|").split())


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


def write_file(path: Path, content: bytes) -> None:
    """Replace the file ``path``; the old content stays until the new one is written completely."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with replaced_as_a_whole(path) as draft:
            draft.write_bytes(content)
    except OSError as error:
        raise OutputError(
            f"cannot write {path}: {error.strerror or error}; free some space or check the folder"
        ) from None
