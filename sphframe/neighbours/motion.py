"""Neighbours: how far and how fast particles move, which decides how long neighbour lists remain valid."""

import math
from typing import NamedTuple

import numba

from sphframe.compiled import threaded_if_long


class LargestMotion(NamedTuple):
    """Largest ``speed`` of the fluid, m/s, and its largest ``displacement`` since the lists were built, m."""

    speed: float
    displacement: float


@threaded_if_long
def largest_motion(rows, reference, dim):  # type: ignore[no-untyped-def]
    """Return the largest speed, m/s, and displacement from ``reference`` (n, dim), m, of the first n ``rows``."""
    speed2 = 0.0
    displacement2 = 0.0
    for i in numba.prange(reference.shape[0]):
        u2 = 0.0
        d2 = 0.0
        for k in range(dim):
            u2 += rows[i, dim + k] ** 2
            d2 += (rows[i, k] - reference[i, k]) ** 2
        speed2 = max(speed2, u2)
        displacement2 = max(displacement2, d2)
    return math.sqrt(speed2), math.sqrt(displacement2)


@numba.njit(cache=True)
def largest_wall_displacement(ghosts, ghost_reference, points, point_reference):  # type: ignore[no-untyped-def]
    """Return the largest displacement of ``ghosts`` (rows) and evaluation ``points`` (g, dim) from their references."""
    largest = 0.0
    for g in range(points.shape[0]):
        ghost2 = 0.0
        point2 = 0.0
        for k in range(points.shape[1]):
            ghost2 += (ghosts[g, k] - ghost_reference[g, k]) ** 2
            point2 += (points[g, k] - point_reference[g, k]) ** 2
        largest = max(largest, ghost2, point2)
    return math.sqrt(largest)
