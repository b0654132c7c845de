"""Representation: HTML tables that objects show in notebooks, made and escaped by pandas."""

from collections.abc import Sequence
from html import escape


def html_table(title: str, columns: Sequence[str], rows: Sequence[Sequence[object]], *, about: str = "") -> str:
    """Return an HTML table under its ``title`` and a line ``about`` it.

    Parameters
    ----------
    columns
        headings; all empty for a table without headings.
    rows
        for each row one value per column.

    Examples
    --------
    >>> [text in html_table("a < b", ["name"], [["c & d"]]) for text in ("a &lt; b", "<td>c &amp; d</td>")]
    [True, True]
    """
    import pandas as pd

    frame = pd.DataFrame([[str(cell) for cell in row] for row in rows], columns=list(columns))
    with pd.option_context("display.max_colwidth", None):
        table = frame.to_html(index=False, header=any(columns), border=0, max_rows=None)
    table = table.replace("<th>", '<th style="text-align: left">')  # notebooks align headings to the right
    line = f"<div>{escape(about)}</div>" if about else ""
    return f"<div><b>{escape(title)}</b>{line}{table}</div>"
