"""Boundary: the share of each wall in the forces on ghosts in the corner between two walls.

The ghosts below a bed that continues behind a paddle also act on the fluid in front of the paddle. The component of
their force along the paddle's normal belongs to the paddle: without it, the force on a paddle that ends at the bed is
too small by the pressure on about half a particle spacing of its height. For walls at a right angle, both forces are
then exact in a uniform pressure. Corners within one wall need no shares, since only the sum of its ghosts' forces is
recorded.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sphframe.arrays import Array, IntArray
from sphframe.geometry import BoxWall, PolygonWall, directions_to_world, to_world
from sphframe.interfaces import Motion


class _End(NamedTuple):
    """Open end of a wall: its point, the direction of the wall's prolongation, and the normal out of the fluid."""

    wall: int
    point: Array
    onward: Array
    normal: Array


class Corners:
    """The open ends of polygonal ``walls``, carried by the bodies ``wall_body`` (walls,) about ``centres``."""

    def __init__(
        self, walls: Sequence[PolygonWall | BoxWall], wall_body: IntArray, centres: Array, reach: float
    ) -> None:
        self._wall_body, self._centres, self._reach = wall_body, centres, reach
        self._ends: list[_End] = []
        for index, wall in enumerate(walls if len(walls) > 1 else ()):
            if isinstance(wall, PolygonWall) and not wall.closed:
                start, end = wall.segments()
                for point, edge, sense in ((start[0], end[0] - start[0], -1.0), (end[-1], end[-1] - start[-1], 1.0)):
                    along = edge / np.linalg.norm(edge)
                    self._ends.append(_End(index, point, sense * along, np.array([along[1], -along[0]])))

    def shares(self, position: Array, wall: IntArray, motions: Sequence[Motion]) -> tuple[IntArray, Array]:
        """Find for each ghost the wall behind whose prolongation it lies at present.

        Parameters
        ----------
        position: of the ghosts (g, dim), m; ``wall`` (g,) which they belong to; ``motions`` of the bodies.

        Returns
        -------
        Index (g,) of the other wall, -1 where there is none, and that wall's normal (g, dim) out of the fluid.
        """
        other = np.full(len(wall), -1, np.int64)
        normals = np.zeros_like(position)
        for end in self._ends:
            point, onward, normal = end.point, end.onward, end.normal
            body = self._wall_body[end.wall]
            if body >= 0:
                position_of_body = motions[body].position
                point = to_world(point[None], position_of_body, self._centres[body])[0]
                onward, normal = directions_to_world(np.array([onward, normal]), position_of_body)
            offset = position - point
            beyond, behind = offset @ onward, offset @ normal
            here = (beyond > 0.0) & (beyond < self._reach) & (behind > 0.0) & (behind < self._reach)
            here &= wall != end.wall
            other[here], normals[here] = end.wall, normal
        return other, normals
