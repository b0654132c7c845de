"""Bodies: a body that follows a measured displacement."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Literal, final

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator, PPoly

from sphframe.arrays import Array
from sphframe.errors import InputError
from sphframe.input_files import text_of
from sphframe.interfaces.rigid_body import Motion, RigidBody, Surroundings

_LENGTHS = {"m": 1.0, "cm": 0.01, "mm": 0.001}
_ANGLES = {"rad": 1.0, "deg": math.pi / 180.0}
_UNITS: dict[str, dict[str, float]] = {
    "time": {"s": 1.0, "ms": 0.001, "min": 60.0},
    **dict.fromkeys(("x", "y", "z"), _LENGTHS),
    **dict.fromkeys(("angle", "rx", "ry", "rz"), _ANGLES),
}
"""what each column may hold, with the factors from its units to SI units"""
_COORDINATES = {"x": 0, "y": 1, "z": 2, "angle": 2, "rx": 3, "ry": 4, "rz": 5}
_DEFAULT = (("time", "s"), ("x", "m"), ("y", "m"))
_SEPARATOR = re.compile(r"\s*,\s*|[\s;]+")
_DECLARATION = re.compile(r"\s*(\w+)\s*[(\[]\s*(\w+)\s*[)\]]\s*")


@final
@dataclass(frozen=True)
class DisplacementSeries(RigidBody):
    """A body that follows the displacement in a file.

    The file holds one line for each time: numbers with decimal points, separated by commas, semicolons or blanks, ``#``
    before comments. The displacement is measured from the first line, where the body is drawn. The body is at rest
    before the first and after the last line.

    Source: F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984), doi:10.1137/0905021.

    Attributes
    ----------
    path
        of the file; a case file looks for it in its own folder first.
    centre
        of rotation, m.
    interpolation
        between the lines, never beyond two neighbouring values, and at rest where these are equal.

        ``"monotone"``: cubic Hermite polynomials with the slopes of Fritsch and Butland (PCHIP), zero at both ends.
        The velocity is continuous; the acceleration, and with it the pressure on the wall, is linear between the times
        of the file and jumps at them, by less the denser they are.

        ``"linear"``: the velocity is constant between the times and jumps at them, without an impulse on the fluid's
        pressure: the acceleration is taken as zero.
    columns
        what the columns hold, in their order, with their units, such as ``{time = "s", x = "mm", angle = "deg"}``.
        Names: time; x, y, z; angle (2-D); one of rx, ry, rz (3-D). Units: s, ms, min;
        m, cm, mm; rad, deg. By default those of a comment ``# time (s), x (m)`` above the numbers, or else time, x and
        y in SI units.
    contents
        text of the file. It is read from ``path`` when a case is loaded, and kept with the case in the output
        file, so that a resumed or repeated run moves as the first one did even if the file has changed since.

    Raises
    ------
    InputError
        when the file cannot be read, is not such a table, or its times do not increase.
    """

    path: Path | None = None
    centre: tuple[float, ...] = (0.0, 0.0)
    interpolation: Literal["monotone", "linear"] = "monotone"
    columns: dict[str, str] | None = None
    contents: str | None = field(default=None, repr=False)

    rotates_in_3d: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if self.path is None and self.contents is None:
            raise InputError("a displacement series needs a path, the file with its numbers")
        if self.interpolation not in ("monotone", "linear"):
            raise InputError(f"interpolation = {self.interpolation!r} must be 'monotone' or 'linear'")
        name = str(self.path or "contents")
        text = read_text(Path(str(self.path))) if self.contents is None else self.contents
        table, header = numbers_of(name, text)
        columns = self.columns or header or _default_columns(name, table)
        time, displacement = _in_si_units(name, table, columns)
        object.__setattr__(self, "_names", columns.keys() & _COORDINATES)
        object.__setattr__(self, "_pieces", _interpolated(time, displacement, self.interpolation))

    @classmethod
    def with_contents(cls, options: Mapping[str, Any], folder: Path) -> dict[str, Any]:
        """Return ``options`` with the text of the file at ``path``, which is looked for in ``folder`` first."""
        return with_text(options, folder)

    def placed(self, surroundings: Surroundings) -> "DisplacementSeries":
        """Return the body, whose columns must be those of the dimension."""
        misplaced = vars(self)["_names"] & ({"z", "rx", "ry", "rz"} if surroundings.dimension == 2 else {"angle"})
        if misplaced:
            raise InputError(f"{', '.join(sorted(misplaced))}: no coordinate in {surroundings.dimension}-D")
        return self

    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the motion of the series at ``time``; the three coordinates of the plane, or six in space."""
        pieces: tuple[PPoly, PPoly, PPoly] = vars(self)["_pieces"]
        first, last = pieces[0].x[[0, -1]]
        inside = 1.0 if first <= time < last else 0.0
        x, u, a = (np.array(piece(min(max(time, first), last)))[: len(position)] for piece in pieces)
        return Motion(x, inside * u, inside * a)


def with_text(options: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return ``options`` with the ``contents`` of the file at their ``path``, which is looked for in ``folder`` first.

    Raises
    ------
    InputError
        when the file cannot be read.
    """
    if options.get("contents") is not None or not isinstance(options.get("path"), str | Path):
        return dict(options)
    path = Path(options["path"])
    return {**options, "contents": read_text(folder / path if (folder / path).is_file() else path)}


def read_text(path: Path) -> str:
    """Return the text of a file.

    Raises
    ------
    InputError
        when it cannot be read.
    """
    try:
        return text_of(path)
    except (OSError, ValueError) as error:
        raise InputError(f"cannot read the series {path}: {error}") from None


def numbers_of(name: str, text: str) -> tuple[Array, dict[str, str] | None]:
    """Return the numbers of a file, and its columns with their units if a comment above the numbers declares them."""
    rows: list[list[float]] = []
    header = None
    for number, line in enumerate(text.lstrip("\ufeff").splitlines(), 1):
        content, _, comment = line.partition("#")
        content = content.strip().rstrip(",;")
        if not content:
            found = [_DECLARATION.fullmatch(part) for part in comment.split(",")]
            if not rows and all(found):
                header = {match[1]: match[2] for match in found if match}
            continue
        if re.search(r"\d,\d", content) and re.search(r"[^\s,;][\s;]+[^\s,;]", content):
            raise InputError(
                f"{name}, line {number}: {content!r} has commas within its columns; write numbers with decimal points"
            )
        try:
            rows.append([float(cell) for cell in _SEPARATOR.split(content)])
        except ValueError as error:
            raise InputError(f"{name}, line {number}: {error}; put '#' before lines that are not numbers") from None
        if len(rows[-1]) != len(rows[0]):
            raise InputError(f"{name}, line {number}: {len(rows[-1])} columns; expected {len(rows[0])} as above it")
    if len(rows) < 2:
        raise InputError(f"{name}: {len(rows)} lines of numbers; a motion needs 2 or more")
    return np.array(rows), header


def _default_columns(name: str, table: Array) -> dict[str, str]:
    width = table.shape[1]
    if width not in (2, 3):
        raise InputError(
            f"{name} has {width} columns and does not say what they hold; write a comment above the numbers, such as"
            ' "# time (s), x (m), y (m), angle (rad)", or give the option columns = {time = "s", x = "m", ...}'
        )
    return dict(_DEFAULT[:width])


def _in_si_units(name: str, table: Array, columns: Mapping[str, str]) -> tuple[Array, Array]:
    """Return times (n,) in s and displacements (n, 6) from the first line, in m and rad."""
    for column, unit in columns.items():
        if column not in _UNITS or unit not in _UNITS[column]:
            known = ", ".join(_UNITS.get(column, _UNITS))
            what = f"unit {unit!r} of column {column!r}" if column in _UNITS else f"column {column!r}"
            raise InputError(f"{name}: {what} is not known; choose one of {known}")
    if "time" not in columns or len(columns) != table.shape[1]:
        raise InputError(
            f"{name}: {table.shape[1]} columns of numbers, but the declared ones are {', '.join(columns)}; declare"
            " every column once, one of them time"
        )
    if "angle" in columns and columns.keys() & {"z", "rx", "ry", "rz"}:
        raise InputError(f"{name}: angle belongs to two dimensions, z, rx, ry and rz to three; declare one kind")
    time, displacement = np.empty(0), np.zeros((len(table), 6))
    if len(columns.keys() & {"rx", "ry", "rz"}) > 1:
        raise InputError(f"{name}: a series turns about one axis; declare one of rx, ry and rz")
    for values, (column, unit) in zip(table.T, columns.items(), strict=True):
        scaled = values * _UNITS[column][unit]
        if column == "time":
            time = scaled
        else:
            displacement[:, _COORDINATES[column]] = scaled - scaled[0]
    if not np.all(np.isfinite(table)):
        raise InputError(f"{name}: a number is not finite; leave its line out")
    if not np.all(np.diff(time) > 0.0):
        raise InputError(f"{name}: the times must increase from line to line")
    return time, displacement


def _interpolated(time: Array, displacement: Array, interpolation: str) -> Sequence[PPoly]:
    """Return position, velocity and acceleration as piecewise polynomials."""
    if interpolation == "linear":
        slopes = np.diff(displacement, axis=0) / np.diff(time)[:, None]
        position = PPoly(np.array([slopes, displacement[:-1]]), time)
        return position, position.derivative(), PPoly(np.zeros((1, *slopes.shape)), time)
    slopes = PchipInterpolator(time, displacement).derivative()(time)
    slopes[[0, -1]] = 0.0
    position = CubicHermiteSpline(time, displacement, slopes)
    return position, position.derivative(), position.derivative(2)
