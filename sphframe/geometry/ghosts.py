"""Geometry: the ghost particles and mirror points that walls need.

A ghost particle at x_G outside the fluid belongs to the nearest point c of its wall. Its mirror point is
x_M = 2 c - x_G, inside the fluid, and its reflection matrix S turns the velocity of the fluid relative to the wall at
the mirror point into that of the ghost for free slip: S = 1 - 2 n n^T next to a face; the product of the faces'
reflections where c lies on an edge or corner, which for two faces of a plane is the point reflection S = -1.

Source: S. Marrone et al. (2011), doi:10.1016/j.cma.2010.12.016; X. Huang et al. (2019), doi:10.3390/w11051110,
section 2.2.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.geometry.walls import TOLERANCE, Wall


@dataclass(frozen=True)
class GhostPoints:
    """Fixed ghost particles, in m, as drawn (before any body moves).

    ``position`` (g, dim), ``mirror`` (g, dim), ``reflection`` (g, dim, dim) for free slip, ``wall`` (g,) index of the
    wall that each belongs to.
    """

    position: Array
    mirror: Array
    reflection: Array
    wall: IntArray


def wall_ghosts(walls: tuple[Wall, ...], spacing: float, layers: int) -> GhostPoints:
    """Place the ghosts of all ``walls``: layers at (k + 1/2) spacings behind each, corners filled.

    A position is left out if another face of the same wall is nearer to it, if it is not behind its wall, or if an
    earlier ghost is closer than half a spacing.
    """
    dimension = walls[0].dimension
    positions, mirrors, reflections, owners = [], [], [], []
    for index, wall in enumerate(walls):
        position = wall.candidates(spacing, layers)
        foot, reflection = wall.nearest(position)
        depth = np.linalg.norm(position - foot, axis=1)
        reach = math.sqrt(dimension) * layers * spacing
        keep = wall.is_behind(position) & (depth > 0.2 * spacing) & (depth < reach)
        positions.append(position[keep])
        mirrors.append(2.0 * foot[keep] - position[keep])
        reflections.append(reflection[keep])
        owners.append(np.full(int(keep.sum()), index))
    position = np.vstack(positions)
    keep = _without_duplicates(position, 0.5 * spacing)
    return GhostPoints(
        position[keep], np.vstack(mirrors)[keep], np.vstack(reflections)[keep], np.concatenate(owners)[keep]
    )


def _without_duplicates(position: Array, closest: float) -> BoolArray:
    keep = np.ones(len(position), dtype=np.bool_)
    for i, j in sorted(cKDTree(position).query_pairs(closest * (1.0 - TOLERANCE))):
        if keep[i]:
            keep[j] = False
    return keep
