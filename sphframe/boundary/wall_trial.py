"""Boundary: the functions of a wall treatment are tried in plain Python, where a mistake has a name and a place."""

import dataclasses
from typing import Any

import numpy as np

from sphframe.compiled.parts import check_result, checked_function
from sphframe.errors import BrokenPluginError
from sphframe.interfaces import (
    Edge,
    FluidSide,
    Interpolated,
    Neighbours,
    Seen,
    Separation,
    WallContext,
    WallParts,
    WallPoint,
    WallSide,
    WallTreatment,
)
from sphframe.physics import LoopParameters

_ARGUMENTS = {
    "assign": ("fluid", "wall", "constants", "velocity", "viscous_velocity"),
    "seen": ("fluid", "wall", "separation", "constants"),
    "force": ("wall", "separation", "constants"),
    "surface": ("fluid", "wall", "edge", "constants"),
    "rate": ("neighbours", "wall", "constants"),
}
_RETURNED = {
    "assign": "pressure and share",
    "seen": "a sphframe.Seen",
    "force": "the three components of an acceleration",
    "surface": "fx, fy and a divergence",
    "rate": "a number",
}


def checked_parts(treatment: WallTreatment, context: WallContext) -> WallParts:
    """Return the functions of ``treatment``, each of which takes its arguments and returns what it must.

    Raises
    ------
    BrokenPluginError
        when one does not.
    """
    parts: Any = treatment.parts(context)
    if not isinstance(parts, WallParts):
        hint = ": end it with 'return WallParts(...)'" if parts is None else ""
        raise BrokenPluginError(f"{type(treatment).__name__}.parts returned {parts!r:.80}; expected WallParts{hint}")
    given = _samples(context)
    for field in dataclasses.fields(parts):
        function = getattr(parts, field.name)
        if field.name not in _ARGUMENTS or function is None:
            continue
        checked_function(treatment, "parts", function, _ARGUMENTS[field.name])
        plain = getattr(function, "py_func", function)
        samples = given | given["points" if field.name in ("assign", "rate") else "sides"]
        try:
            with np.errstate(all="ignore"):
                result = plain(*(samples[name] for name in _ARGUMENTS[field.name]))
        except Exception:
            continue  # what Numba compiles need not run in plain Python
        check_result(treatment, "parts", plain, result, _RETURNED[field.name], _is_right(field.name, result))
    return parts


def _is_right(name: str, result: Any) -> bool:
    if name == "seen":
        return isinstance(result, Seen)
    return np.shape(result) == {"assign": (2,), "rate": ()}.get(name, (3,)) and result is not None


def _samples(context: WallContext) -> dict[str, Any]:
    """Arguments by name: a wall particle at (0, -1) behind the wall y = 0, a fluid particle at (0, 1)."""
    dim, up = context.dim, np.eye(context.dim)[1]
    zero, one = np.zeros(dim), np.ones(1)
    constants = LoopParameters.of(
        context.kernel, dim, smoothing_length=2.0, reference_density=1000.0, sound_speed=10.0, spacing=1.0, depth=1.0
    )
    numbers = dict.fromkeys(WallSide._fields, 0.0) | {"ny": 1.0, "distance": 1.0}
    wall = WallPoint(up, 1.0, 1.0, -2.0 * up, -np.eye(dim), zero, zero, 1000.0, -up, 0)
    neighbours = Neighbours(2.0 * up[None, :], 2.0 * one, -one, one, one, 1000.0 * one, zero[None, :])
    sides = {"fluid": FluidSide(1.0, 1000.0, 0.0, 0.0, 0.0), "wall": WallSide(**numbers)}
    return {
        "neighbours": neighbours,
        "separation": Separation(0.0, -2.0, 0.0, 4.0),
        "edge": Edge(1.0, -1.0, 1.0, 0.1, 0.1, 0.0),
        "constants": constants,
        "velocity": np.zeros(dim),
        "viscous_velocity": np.zeros(dim),
        "sides": sides,
        "points": {"fluid": Interpolated(0, 1, 1.0, 1.0, False, zero, zero), "wall": wall},
    }
