"""Boundary: particles behind walls of triangles are put back on them.

A particle at x behind a wall is put on the nearest point c of the triangles, and the component of its velocity relative
to the wall in the direction of n = (x - c)/|x - c| is set to zero if it is positive (:mod:`sphframe.boundary.contact`).
Beside curved walls whose radius is a few spacings, planes at the feet of ghosts do not tell what is behind.
"""

from collections.abc import Sequence

import numpy as np

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.geometry import WallGroup, to_body_frame, to_world, turning_velocities
from sphframe.geometry.box_walls import BoxWalls
from sphframe.geometry.solid_walls import SolidWalls
from sphframe.interfaces import Motion
from sphframe.particles import Columns, Periods


class SolidContacts:
    """Contacts of particles with the ``groups`` of walls that the bodies ``group_body`` carry, -1 at rest.

    ``centres`` (bodies, 3) of the bodies as drawn, m. With ``periods``, planes at the feet of ghosts are used instead.
    """

    def __init__(self, groups: Sequence[WallGroup], group_body: IntArray, centres: Array, periods: Periods) -> None:
        solid = any(isinstance(group, SolidWalls) for group in groups) and not np.any(periods.repeats)
        self._groups = [
            (group, int(body))
            for group, body in zip(groups, group_body, strict=True)
            if solid and isinstance(group, SolidWalls | BoxWalls)
        ]
        self._centres = centres

    @property
    def needed(self) -> bool:
        """Whether any wall is given by triangles."""
        return bool(self._groups)

    def put_back(self, rows: Array, may_be_behind: BoolArray, motions: Sequence[Motion]) -> int:
        """Put particles back that are behind walls, of those that ``may_be_behind`` (n,); return their number."""
        if not self._groups or not np.any(may_be_behind):
            return 0
        columns, count, marked = Columns.of(3), 0, np.flatnonzero(may_be_behind)
        for group, body in self._groups:
            points = rows[marked, columns.position]
            at, centre = (motions[body].position, self._centres[body]) if body >= 0 else (np.zeros(6), np.zeros(3))
            behind, foot = group.feet_behind(to_body_frame(points, at, centre) if body >= 0 else points)
            if not np.any(behind):
                continue
            here, foot = marked[behind], foot[behind]
            velocity: Array = np.zeros_like(foot)
            if body >= 0:
                foot = to_world(foot, at, centre)
                speed = motions[body].velocity
                velocity = speed[:3] + turning_velocities(speed[3:], foot - centre - at[:3])
            offset = points[behind] - foot
            normal = offset / np.linalg.norm(offset, axis=1)[:, None]
            into = np.einsum("ij,ij->i", rows[here, columns.velocity] - velocity, normal)
            rows[here, columns.position] = foot
            rows[here, columns.velocity] -= np.maximum(into, 0.0)[:, None] * normal
            count += len(here)
        return count
