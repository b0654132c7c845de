"""Studies: the contents of a section of a report: tables, pictures, and verdicts on published claims."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Literal

Cell = str | float | int | None
"""value in a table; None and NaN mean that it is not known"""


@dataclass(frozen=True)
class Table:
    """A table. ``name`` is that of its CSV file, without suffix. A table without rows is left out of the report."""

    name: str
    caption: str
    rows: Sequence[Mapping[str, Cell]]

    @property
    def heads(self) -> list[str]:
        """Heads of the columns: all keys of all rows."""
        return list(dict.fromkeys(head for row in self.rows for head in row))


@dataclass(frozen=True)
class Picture:
    """A figure as the content of an image file. ``name`` is that of the file, without suffix."""

    name: str
    caption: str
    content: bytes = field(repr=False)
    suffix: Literal["svg", "png"] = "svg"


class Verdict(Enum):
    """Result of checking a claim."""

    REPRODUCED = "reproduced"
    NOT_REPRODUCED = "not reproduced"
    NOT_CHECKABLE = "not checkable"


@dataclass(frozen=True)
class Claim:
    """A published statement with the published and the measured value, the verdict, and the reason for the verdict.

    ``where`` is the place of the statement, such as a figure or a section.
    """

    where: str
    statement: str
    published: str
    measured: str
    verdict: Verdict
    reason: str

    @classmethod
    def judged(cls, where: str, statement: str, published: str, measured: str, holds: bool, reason: str) -> "Claim":
        """Return a claim that was checked by measurement."""
        verdict = Verdict.REPRODUCED if holds else Verdict.NOT_REPRODUCED
        return cls(where, statement, published, measured, verdict, reason)

    @classmethod
    def open(cls, where: str, statement: str, published: str, reason: str, measured: str = "-") -> "Claim":
        """Return a claim that cannot be checked."""
        return cls(where, statement, published, measured, Verdict.NOT_CHECKABLE, reason)


@dataclass(frozen=True)
class Chapter:
    """A section of the report."""

    name: str
    title: str
    paragraphs: Sequence[str] = ()
    tables: Sequence[Table] = ()
    pictures: Sequence[Picture] = ()
    claims: Sequence[Claim] = ()
    absent: Sequence[str] = ()
    """reference series that were not available, with the reason"""
