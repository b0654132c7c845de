"""Boundary: the share of each wall in the forces on ghosts in the corner between two walls.

The force on a ghost in a corner is the sum of a part along the normal of the first wall and one along that of the
second; each wall bears its own part. For walls in a uniform pressure, both forces are then exact. In a corner between
walls of the same group (:mod:`sphframe.geometry.ghosts`) these ghosts are known from the start.

Between walls of different groups it is otherwise: the ghosts below a bed that continues behind a paddle also act on the
fluid in front of the paddle. The component of their force along the paddle's normal belongs to the paddle: without it,
the force on a paddle that ends at the bed is too small by the pressure on about half a particle spacing of its height.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sphframe.arrays import Array, IntArray
from sphframe.geometry import GhostPoints, WallGroup, directions_to_world, to_world
from sphframe.interfaces import Motion


class Shares(NamedTuple):
    """Second wall (g,) of each ghost, -1 where there is none; its part of a force F is (F.dual) normal, (g, dim)."""

    wall: IntArray
    normal: Array
    dual: Array


class Corners:
    """Corners of the walls of ``groups``, whose ghosts ``drawn`` have a ``body`` (g,), as walls have; ``centres``, m.

    Walls of another group within ``reach`` (m) beyond their ends take part in the force on a ghost.
    """

    def __init__(
        self, groups: Sequence[WallGroup], drawn: GhostPoints, body: IntArray, wall_body: IntArray, centres: Array,
        reach: float,
    ) -> None:  # fmt: skip
        self._drawn = Shares(drawn.other, drawn.other_normal, drawn.other_dual)
        self._body, self._wall_body, self._centres, self._reach = body, wall_body, centres, reach
        self._ends = [end for group in groups for end in group.ends()] if len(groups) > 1 else []
        self._turning = [k for k in range(len(centres)) if np.any(drawn.other[self._body == k] >= 0)]

    def shares(self, position: Array, motions: Sequence[Motion]) -> Shares:
        """Return the shares of second walls in the forces on ghosts at ``position`` (g, dim), m, at present."""
        if not self._ends and not self._turning:
            return self._drawn
        wall, normal, dual = self._drawn.wall.copy(), self._drawn.normal.copy(), self._drawn.dual.copy()
        for k in self._turning:
            own = self._body == k
            for vectors in (normal, dual):
                vectors[own] = directions_to_world(vectors[own], motions[k].position)
        for index, point, onward, outward in self._ends:
            carrier = self._wall_body[index]
            if carrier >= 0:
                place = motions[carrier].position
                point = to_world(point[None], place, self._centres[carrier])[0]
                onward, outward = directions_to_world(np.array([onward, outward]), place)
            offset = position - point
            beyond, behind = offset @ onward, offset @ outward
            here = (beyond > 0.0) & (beyond < self._reach) & (behind > 0.0) & (behind < self._reach)
            here &= self._body != carrier
            wall[here], normal[here], dual[here] = index, outward, outward
        return Shares(wall, normal, dual)
