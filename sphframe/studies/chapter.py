"""Studies: what a section has to say: tables, pictures and judgements of the paper's claims."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Literal

__all__ = ["Cell", "Chapter", "Claim", "Picture", "Table", "Verdict"]

Cell = str | float | int | None
"""None and NaN: not known"""


@dataclass(frozen=True)
class Table:
    """Rows by column; ``name`` is that of its CSV file. A table without rows is left out."""

    name: str
    caption: str
    rows: Sequence[Mapping[str, Cell]]

    @property
    def heads(self) -> list[str]:
        """The columns: all that any row has."""
        return list(dict.fromkeys(head for row in self.rows for head in row))


@dataclass(frozen=True)
class Picture:
    """A figure as the content of its file; ``name`` is the file's, without suffix."""

    name: str
    caption: str
    content: bytes = field(repr=False)
    suffix: Literal["svg", "png"] = "svg"


class Verdict(Enum):
    """What became of a claim."""

    REPRODUCED = "reproduced"
    NOT_REPRODUCED = "not reproduced"
    NOT_CHECKABLE = "not checkable"


@dataclass(frozen=True)
class Claim:
    """What the paper says at ``where``, its number and ours, and the reason for the verdict."""

    where: str
    statement: str
    published: str
    measured: str
    verdict: Verdict
    reason: str

    @classmethod
    def judged(cls, where: str, statement: str, published: str, measured: str, holds: bool, reason: str) -> "Claim":
        """Return a claim that was measured, and holds or not."""
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
    """reference series that were not given, with the reason"""
