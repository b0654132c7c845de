"""Boundary: the sides of walls that hide what is behind them, carried by rigid bodies.

A thin wall that stands on a wall of another body, or is sunk into it, has ghosts behind the surface of that wall. Their
mirror points x_M lie behind it, too, and are reflected in its nearest point f, x_M := 2 f - x_M, from where they see
the fluid on their side. That wall bears the part of the force on these ghosts that is normal to it.

The shares with which a thin wall hides what is behind it change over dx beside its end
(:mod:`sphframe.neighbours.sight`). Where the end stands on another wall, or within s < dx of it, it is therefore moved
into that wall by (1 - s/dx) c, with c = dx/2 for a line; the end of a solid is moved out of sight.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numba
import numpy as np

from sphframe.arrays import Array, IntArray
from sphframe.boundary.corners import Shares
from sphframe.geometry import Sides, to_world
from sphframe.geometry.charts import BEYOND, THICK
from sphframe.interfaces import Motion
from sphframe.neighbours import Sight


class WallSides:
    """The ``sides`` of walls as drawn, carried by the bodies with the indices ``body`` (k,), -1 at rest.

    Thin walls among those of several bodies are continued beyond their ends by ``reach``, m.

    Attributes
    ----------
    sight
        the sides at present, and the charts of the ghosts.
    passable
        (g,) whether each ghost lies behind the continuation of a wall beyond its end.
    """

    def __init__(self, sides: Sides, body: IntArray, centres: Array, spacing: float, reach: float) -> None:
        several = bool(np.any(body != body[0]))
        side, end = np.nonzero(sides.tips if several else np.zeros_like(sides.tips))
        further = _continued(sides.ends[side], end, reach)
        self._drawn, self._body, self._centres = np.vstack([sides.ends, further]), np.append(body, body[side]), centres
        self._wall, self._reach = sides.wall, reach
        smooth: Array = spacing * np.vstack([sides.tips, np.zeros((len(side), 2))])
        beyond = np.append(np.zeros(len(body), np.int64), np.where(end == 1, 1, -1))
        chart, thin = np.append(sides.chart, sides.chart[side]), np.append(sides.thin, np.zeros(len(side), np.bool_))
        thin_ghosts = sides.kind != THICK
        self.sight = Sight(
            self._drawn.copy(), smooth, chart, thin, beyond, self._body, spacing, sides.ghost_chart, thin_ghosts
        )
        self.passable = sides.kind == BEYOND
        self._between = np.flatnonzero(thin_ghosts & several)
        self._second, self._outward = np.full(len(thin_ghosts), -1), np.zeros((len(thin_ghosts), 2))
        self._tips = _tips(
            self._drawn, self._body, side, end, np.where(sides.tips[side, end] > 0, 0.5 * spacing, reach + spacing)
        )
        self._spacing = spacing
        self.move([])

    def move(self, motions: Sequence[Motion]) -> None:
        """Carry the sides to where ``motions`` of the bodies have brought them."""
        ends = self.sight.ends
        ends[:] = self._drawn
        for k, motion in enumerate(motions):
            own = self._body == k
            if np.any(own):
                points = to_world(self._drawn[own].reshape(-1, 2), motion.position, self._centres[k])
                ends[own] = points.reshape(-1, 4)
        _close(ends.reshape(-1, 2, 2), len(self._wall), self._body, self.sight.thin, self._tips, self._spacing)

    def reflect(self, ghost_body: IntArray, mirror: Array, reflection: Array) -> None:
        """Reflect ``mirror`` (g, 2) and ``reflection`` (g, 2, 2) of ghosts behind thick walls of other bodies there."""
        _reflect(
            self._between, ghost_body, mirror, reflection, self.sight.ends[: len(self._wall)], self._body,
            self.sight.thin, self._wall, self._reach, self._second, self._outward,
        )  # fmt: skip

    def share(self, shares: Shares, normal: Array) -> Shares:
        """Return ``shares`` with those of the walls in which ghosts were reflected; ``normal`` (g, 2) of the ghosts."""
        dual = self._outward - np.einsum("gi,gi->g", self._outward, normal)[:, None] * normal
        size = np.einsum("gi,gi->g", self._outward, dual)[:, None]
        here = (self._second >= 0)[:, None] & (size > 0.05)  # else both walls have the same normal
        return Shares(
            np.where(here[:, 0], self._second, shares.wall),
            np.where(here, self._outward, shares.normal),
            np.where(here, dual / np.maximum(size, 0.05), shares.dual),
        )


def _continued(ends: Array, at: IntArray, reach: float) -> Array:
    """Return sides (k, 4) that continue those of ``ends`` (k, 4) by ``reach``, m, at their start (0) or end (1)."""
    start, end = ends[:, :2], ends[:, 2:]
    onward = reach * (end - start) / np.hypot(*(end - start).T)[:, None]
    first, last = np.hstack([start - onward, start]), np.hstack([end, end + onward])
    return np.where((at == 1)[:, None], last, first)


class _Tips(NamedTuple):
    """Ends of thin walls: their ``side`` (t,) and ``end`` (t,), 0 or 1, and the longest ``way`` (t,) to move them, m.

    ``point`` (t,) is the number of the place; all ends there, ``there`` (m, 3): number, side and end, move together.
    """

    side: IntArray
    end: IntArray
    way: Array
    point: IntArray
    there: IntArray


def _tips(ends: Array, body: IntArray, side: IntArray, end: IntArray, way: Array) -> _Tips:
    place = np.column_stack([ends.reshape(-1, 2).round(9), np.repeat(body, 2)])
    _, number = np.unique(place, axis=0, return_inverse=True)
    number = number.reshape(-1, 2)
    point = number[side, end]
    row, at = np.nonzero(np.isin(number, point))
    return _Tips(side, end, way, point, np.column_stack([number[row, at], row, at]))


@numba.njit(cache=True, error_model="numpy")
def _close(ends, count, side_body, thin, tips, spacing):  # type: ignore[no-untyped-def]
    """Move ``tips`` in ``ends`` (k, 2, 2) that are near thick ones of the first ``count`` sides, of other bodies."""
    moved = np.zeros((2 * ends.shape[0], 2))
    for t in range(tips.side.shape[0]):
        side, end, point = tips.side[t], tips.end[t], tips.point[t]
        x, y = ends[side, end]
        ux, uy = x - ends[side, 1 - end, 0], y - ends[side, 1 - end, 1]
        length = math.hypot(ux, uy)
        ux, uy = ux / length, uy / length
        gap = spacing
        for k in range(count):
            ax, ay = ends[k, 0]
            ex, ey = ends[k, 1, 0] - ax, ends[k, 1, 1] - ay
            length = math.hypot(ex, ey)
            ex, ey = ex / length, ey / length
            steepness = ux * ey - uy * ex
            if thin[k] or side_body[k] == side_body[side] or steepness < 0.2:
                continue
            distance = (ex * (y - ay) - ey * (x - ax)) / steepness
            along = ex * (x + distance * ux - ax) + ey * (y + distance * uy - ay)
            if -1e-6 * spacing < along < length + 1e-6 * spacing and distance > -spacing:
                gap = min(gap, max(distance, 0.0))
        way = (1.0 - gap / spacing) * tips.way[t]
        if way > math.hypot(moved[point, 0], moved[point, 1]):
            moved[point, 0], moved[point, 1] = way * ux, way * uy
    for m in range(tips.there.shape[0]):
        point, side, end = tips.there[m]
        ends[side, end, 0] += moved[point, 0]
        ends[side, end, 1] += moved[point, 1]


@numba.njit(cache=True, error_model="numpy")
def _reflect(  # type: ignore[no-untyped-def]
    ghosts, ghost_body, mirror, reflection, ends, side_body, thin, wall, reach, second, outward
):
    """Reflect ``mirror`` points of ``ghosts`` that lie within ``reach`` behind walls; write ``second`` and ``outward``.

    ``second`` (g,) is the wall, -1 where there is none, and ``outward`` (g, 2) the unit vector from there to the point.
    """
    for g in ghosts:
        second[g] = -1
        x, y = mirror[g]
        nearest = reach
        behind = False
        in_corner = False
        for k in range(ends.shape[0]):
            if side_body[k] == ghost_body[g] or thin[k]:
                continue
            ax, ay, bx, by = ends[k]
            ex, ey = bx - ax, by - ay
            length2 = ex * ex + ey * ey
            along = min(max(((x - ax) * ex + (y - ay) * ey) / length2, 0.0), 1.0)
            dx, dy = x - (ax + along * ex), y - (ay + along * ey)
            distance = math.hypot(dx, dy)
            if distance > nearest + 1e-9 * reach:
                continue
            depth = (dx * ey - dy * ex) / math.sqrt(length2)
            in_both = distance <= nearest - 1e-9 * reach or behind  # in a corner, it is behind both sides
            behind = in_both and depth > 1e-9 * distance
            nearest = distance
            if behind:
                second[g] = wall[k]
                outward[g, 0], outward[g, 1] = dx / distance, dy / distance
                in_corner = depth < 0.95 * distance
        if not behind:
            second[g] = -1
            continue
        nx, ny = outward[g]
        mirror[g, 0] -= 2.0 * nearest * nx
        mirror[g, 1] -= 2.0 * nearest * ny
        for d in range(2):
            sx, sy = reflection[g, 0, d], reflection[g, 1, d]
            across = 2.0 * (sx * nx + sy * ny)
            reflection[g, 0, d] = -sx if in_corner else sx - across * nx
            reflection[g, 1, d] = -sy if in_corner else sy - across * ny
