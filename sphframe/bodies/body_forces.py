"""Bodies: accelerations of the fluid: uniform and constant, or a uniform series in time."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, final

import numpy as np

from sphframe.arrays import Array
from sphframe.bodies.displacement_series import numbers_of, read_text, with_text
from sphframe.errors import InputError
from sphframe.interfaces.body_force import BodyForce


@final
@dataclass(frozen=True)
class UniformForce(BodyForce):
    """A constant ``vector`` of acceleration, m/s^2.

    Attributes
    ----------
    vector
        (dim,) m/s^2; zero by default.
    """

    vector: tuple[float, ...] = ()

    def placed(self, dimension: int, gravity: Array) -> "UniformForce":
        """Return the force, whose vector must have one component for each dimension."""
        if len(self.vector) != dimension or not np.all(np.isfinite(self.vector)):
            raise InputError(f"{[*self.vector]} must be a vector of {dimension} finite numbers, in m/s2")
        return self

    def acceleration(self, time: float) -> Array:
        """Return the vector."""
        return np.array(self.vector, dtype=np.float64)


@final
@dataclass(frozen=True)
class ForceSeries(BodyForce):
    """An acceleration that is linear between the times of a table, and zero before and after it.

    Attributes
    ----------
    path
        of a file with one line for each time: time (s), then one component (m/s^2) for each dimension, separated by
        commas, semicolons or blanks, ``#`` before comments.
    table
        the same numbers, in place of a file: ``[[0.0, 0.0, 0.0], [1.0, 0.5, 0.0]]``.
    contents
        text of the file, which is read when a case is loaded and kept with the case.

    Raises
    ------
    InputError
        when the file cannot be read, is not such a table, or its times do not increase.
    """

    path: Path | None = None
    table: tuple[tuple[float, ...], ...] | None = None
    contents: str | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        if sum(given is not None for given in (self.table, self.contents or self.path)) != 1:
            raise InputError("a series of accelerations needs either a path, the file with its numbers, or a table")
        name = "table" if self.table is not None else str(self.path or "contents")
        if self.table is not None:
            lines = "\n".join(" ".join(map(repr, row)) for row in self.table)
        else:
            lines = read_text(Path(str(self.path))) if self.contents is None else self.contents
        rows, _ = numbers_of(name, lines)
        if not (np.all(np.isfinite(rows)) and np.all(np.diff(rows[:, 0]) > 0.0)):
            raise InputError(f"{name}: the numbers must be finite, and the times increase from line to line")
        object.__setattr__(self, "_rows", rows)

    @classmethod
    def with_contents(cls, options: Mapping[str, Any], folder: Path) -> dict[str, Any]:
        """Return ``options`` with the text of the file at ``path``, which is looked for in ``folder`` first."""
        return with_text(options, folder)

    def placed(self, dimension: int, gravity: Array) -> "ForceSeries":
        """Return the series, which must have one column for each dimension."""
        columns = vars(self)["_rows"].shape[1]
        if columns != dimension + 1:
            raise InputError(f"the series has {columns} columns; expected the time and {dimension} components")
        return self

    def acceleration(self, time: float) -> Array:
        """Return the interpolated vector."""
        rows: Array = vars(self)["_rows"]
        return np.array([np.interp(time, rows[:, 0], column, left=0.0, right=0.0) for column in rows[:, 1:].T])
