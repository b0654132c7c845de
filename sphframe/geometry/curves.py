"""Geometry: points of curves: expressions of a parameter, points from files, and checked areas and lines."""

import ast
import operator
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from sphframe.arrays import Array
from sphframe.input_files import text_of

_FUNCTIONS: dict[str, Callable[[Any], Any]] = {
    **{name: getattr(np, name) for name in ("sqrt", "exp", "log", "sin", "cos", "tan", "sinh", "cosh", "tanh", "abs")},
    **{name: getattr(np, name.replace("a", "arc", 1)) for name in ("asin", "acos", "atan")},
}
_OPERATORS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
}
_MOST_POINTS = 1_000_000


def evaluate(expression: str, t: Array) -> Array:
    """Return the values (n,) of an arithmetic ``expression`` of ``t`` (n,); nothing but arithmetic is carried out.

    Raises
    ------
    ValueError
        when the expression contains anything else than numbers, t, pi, ``+ - * / **`` and known functions.
    """
    try:
        with np.errstate(all="ignore"):
            return np.asarray(np.broadcast_to(_value(ast.parse(expression.strip(), mode="eval").body, t), t.shape))
    except (SyntaxError, RecursionError, MemoryError, OverflowError):
        raise ValueError(f"{expression!r} is not an expression of t, such as '0.1 * sin(2 * pi * t)'") from None


def _value(node: ast.expr, t: Array) -> Any:
    match node:
        case ast.Constant(value=float() | int() as number) if not isinstance(number, bool):
            return np.float64(number)
        case ast.Name(id="t"):
            return t
        case ast.Name(id="pi"):
            return np.float64(np.pi)
        case ast.UnaryOp(op=sign, operand=operand) if type(sign) in _OPERATORS:
            return _OPERATORS[type(sign)](_value(operand, t))
        case ast.BinOp(left=left, op=sign, right=right) if type(sign) in _OPERATORS:
            return _OPERATORS[type(sign)](_value(left, t), _value(right, t))
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](_value(argument, t))
    raise ValueError(
        f"{ast.unparse(node)!r} is not understood; an expression consists of numbers, t, pi, + - * / ** and the"
        f" functions {', '.join(_FUNCTIONS)} of one argument"
    )


def sampled(function: Callable[[Array], Sequence[Any]], start: float, stop: float, tolerance: float) -> Array:
    """Return points (n, 2) of a curve, close enough that their chords are at most ``tolerance`` (m) away from it.

    Parameters
    ----------
    function
        returns the coordinates (x, y) for an array of parameters t.
    start, stop
        the first and the last t.

    Raises
    ------
    ValueError
        where the curve is not finite, or jumps.

    Examples
    --------
    >>> len(sampled(lambda t: (np.cos(t), np.sin(t)), 0.0, np.pi, 0.01))
    17
    """

    def points(t: Array) -> Array:
        found = np.stack(np.broadcast_arrays(*function(t), t)[:2], axis=1).astype(np.float64)
        if not np.isfinite(found).all():
            raise ValueError(f"the curve is not finite at t = {t[~np.isfinite(found).all(axis=1)][0]:g}")
        return found

    if not start < stop:
        raise ValueError(f"a curve from t = {start:g} to {stop:g} is empty; give start < stop")
    t = np.linspace(start, stop, 17)
    while len(t) < _MOST_POINTS:
        between = t[:-1, None] + np.diff(t)[:, None] * [0.25, 0.5, 0.75]
        chord = np.diff(points(t), axis=0)
        offset = points(between.ravel()).reshape(-1, 3, 2) - points(t)[:-1, None]
        along = np.einsum("nki,ni->nk", offset, chord) / np.maximum((chord**2).sum(axis=1), 1e-300)[:, None]
        away = np.linalg.norm(offset - np.clip(along, 0.0, 1.0)[:, :, None] * chord[:, None], axis=2).max(axis=1)
        steps = np.diff(np.clip(along, 0.0, 1.0), axis=1, prepend=0.0, append=1.0)
        leaps = (steps.max(axis=1) > 0.9) & (np.linalg.norm(chord, axis=1) > tolerance)
        coarse = (away > tolerance) | leaps
        if not coarse.any():
            return points(t)
        if np.diff(t)[coarse].min() < 1e-12 * (stop - start):
            raise ValueError(f"the curve jumps at t = {t[:-1][coarse][0]:g}; a curve must be continuous")
        t = np.sort(np.concatenate([t, between[coarse, 1]]))
    raise ValueError(f"the curve needs more than {_MOST_POINTS:,} points; choose a larger tolerance or a simpler curve")


def points_of_csv(path: Path) -> list[list[float]]:
    """Return the points in a CSV file with one ``x, y`` a line; comments (``#``) and a line of headings are left out.

    Raises
    ------
    ValueError
        when the file cannot be read, or a line is not two numbers.
    """
    try:
        lines = text_of(path).splitlines()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it is not a text in UTF-8"
        raise ValueError(f"cannot read {path}: {reason.lower()}") from None
    points: list[list[float]] = []
    headings = 0
    for number, line in enumerate(lines, start=1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        try:
            x, y = map(float, line.split(","))
            points.append([x, y])
        except ValueError:
            headings += 1
            if points or headings > 1:
                raise ValueError(
                    f"line {number} of {path}, {line.strip()!r}, is not two numbers; write one point x, y in m a line,"
                    " with decimal points"
                ) from None
    return points


def area_within(points: Any) -> shapely.Polygon:
    """Return the polygon with the corners ``points`` (n, 2).

    Raises
    ------
    ValueError
        when corners are repeated or enclose no area, or the outline crosses or touches itself.
    """
    corners = _distinct(points, 3, "joins its last point to its first by itself")
    polygon = shapely.Polygon(corners)
    if (polygon if polygon.is_valid else polygon.convex_hull).area <= 1e-12 * np.ptp(corners, axis=0).max() ** 2:
        raise ValueError("the points lie on one line, or run back along it; give corners that enclose an area")
    if not polygon.is_valid:
        place = shapely.is_valid_reason(polygon).partition("[")[2].rstrip("]").replace(" ", ", ")
        raise ValueError(f"the outline crosses or touches itself at ({place}); order the points along it")
    return polygon


def line_through(points: Any) -> shapely.LineString:
    """Return the open line through ``points`` (n, 2).

    Raises
    ------
    ValueError
        when points are repeated, or the line crosses or touches itself; it may end where it starts.
    """
    line = shapely.LineString(_distinct(points, 2, "is drawn by a polygon"))
    if not line.is_simple:
        ends = {line.coords[0], line.coords[-1]}
        nodes = (part.coords[0] for part in shapely.get_parts(shapely.union_all(line)))
        x, y = next((node for node in nodes if node not in ends), line.coords[0])
        raise ValueError(f"the line crosses or touches itself at ({x:g}, {y:g}); order the points along it")
    return line


def _distinct(points: Any, fewest: int, closed_by: str) -> Array:
    corners = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    if len(corners) < fewest:
        raise ValueError(f"{len(corners)} points are too few; give {fewest} or more")
    same = np.all(corners == np.roll(corners, 1, axis=0), axis=1)
    same[0] &= fewest == 3
    if same.any():
        k = int(np.flatnonzero(same)[0])
        hint = f"; a closed outline {closed_by}" if k == 0 else ""
        raise ValueError(
            f"point {k} equals the one before it, {tuple(corners[k].tolist())}; give each point once{hint}"
        )
    return corners


def unit_circle(tolerance: float) -> Array:
    """Return a regular polygon (n, 2) with the area of the unit circle, at most ``tolerance`` away from it."""
    count = 4 * max(int(np.ceil(np.pi / 4.0 / np.arccos(max(1.0 - tolerance, 0.0)))), 4)
    angle = 2.0 * np.pi * np.arange(count) / count
    radius = np.sqrt(2.0 * np.pi / count / np.sin(2.0 * np.pi / count))
    return np.asarray(radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))
