"""Bodies: a body that follows a measured displacement."""

from dataclasses import dataclass
from pathlib import Path
from typing import final

import numpy as np
from scipy.interpolate import make_interp_spline

from sphframe.arrays import Array
from sphframe.errors import InputError
from sphframe.interfaces.rigid_body import Motion, RigidBody


@final
@dataclass(frozen=True)
class DisplacementSeries(RigidBody):
    """A body that follows the displacement in a file.

    The file holds numbers in columns, separated by commas or blanks, ``#`` before comments: time (s), x (m) and,
    optionally, y (m) and angle (rad) in 2-D or y and z (m) in 3-D. A quintic spline goes through all of them,
    so that velocity and acceleration are smooth; it begins and ends at rest, and the body rests outside the series.
    The displacement is measured from the first line, where the body is drawn.

    Attributes
    ----------
    path: of the file.
    centre: of rotation, m.

    Raises
    ------
    InputError: when the file cannot be read, has fewer than 6 lines or other than 2 to 4 columns, or its times do not
        increase.
    """

    path: Path
    centre: tuple[float, ...] = (0.0, 0.0)

    def __post_init__(self) -> None:
        series = _read(Path(self.path))
        time, displacement = series[:, 0], np.zeros((len(series), 3))
        displacement[:, : series.shape[1] - 1] = series[:, 1:] - series[0, 1:]
        at_rest = [(1, np.zeros(3)), (2, np.zeros(3))]
        spline = make_interp_spline(time, displacement, k=5, bc_type=(at_rest, at_rest))
        object.__setattr__(self, "_splines", (spline, spline.derivative(1), spline.derivative(2)))
        object.__setattr__(self, "_span", (float(time[0]), float(time[-1])))

    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the motion of the series at ``time``."""
        first, last = vars(self)["_span"]
        x, u, a = (np.asarray(part(min(max(time, first), last))) for part in vars(self)["_splines"])
        if not first <= time <= last:
            u, a = np.zeros(3), np.zeros(3)
        return Motion(x, u, a)


def _read(path: Path) -> Array:
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise InputError(f"cannot read the displacement series {path}: {error}") from None
    lines = [line.partition("#")[0].replace(",", " ").split() for line in text.splitlines()]
    rows = [row for row in lines if row]
    widths = {len(row) for row in rows}
    try:
        series = np.array([[float(cell) for cell in row] for row in rows]) if len(widths) == 1 else None
    except ValueError as error:
        raise InputError(f"{path}: {error}; put '#' before lines that are not numbers") from None
    if series is None or series.shape[1] not in (2, 3, 4):
        raise InputError(f"{path}: lines of {sorted(widths)} columns; expected time and 1 to 3 displacements in each")
    if len(series) < 6:
        raise InputError(f"{path}: {len(series)} lines; a smooth motion needs 6 or more")
    if not np.all(np.isfinite(series)):
        raise InputError(f"{path}: a number is not finite; leave its line out")
    if not np.all(np.diff(series[:, 0]) > 0.0):
        raise InputError(f"{path}: the times in the first column must increase from line to line")
    return series
