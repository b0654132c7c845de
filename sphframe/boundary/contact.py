"""Boundary: particles behind a wall are put back on its surface.

The pressures of the ghosts keep the fluid away from the walls. But a single fast particle of a jet, which has no
neighbours that push it back, can cross the surface by a fraction of a spacing, and no force would return it. Such a
particle is put on the surface, and the component of its relative velocity into the wall is set to zero.

Each ghost of the first layer stands for the plane of the wall at its wall point w with the normal n out of the fluid.
A particle near the ghost is behind this plane when s = (x - w).n > 0, and then

    x := x - s n,    u := u - max[(u - u_wall).n, 0] n

Beside a convex part of a solid, such as the tip of a wedge, a particle is behind the wall only if s > 0 for all planes
there, and the one with the least s is used. In a concave corner, the particle is put back on each of the planes.

Where walls are thin, only ghosts count that the particle sees, beside their wall points; it is put a little inside the
surface, so that its side of the wall remains known.

In 3-D, where walls are given by triangles, the planes only tell which particles may be behind a wall. The nearest point
of the triangles tells whether they are, and they are put there (:mod:`sphframe.boundary.solid_contact`); not where
directions are periodic.

Departs from the paper, which has no such rule. In a tank at rest it acts on no particle.
"""

import math

import numba
import numpy as np

from sphframe.compiled import LANES, local_array, nearest, squared_distance
from sphframe.compiled.stand_ins import MASKED, PERIODIC
from sphframe.neighbours.sight import WHOLE

HALF = WHOLE // 2

MARKS = False
"""whether particles are only marked, not put back; bound by specialise()"""

_NEAR = 1.25
"""distance of a ghost over spacing within which it puts particles back"""
_BESIDE = 3.0
"""distance of a ghost over spacing within which it may show that a particle is in front of a convex part of a solid"""
_ALONG = 0.75
"""distance along a thin wall, over spacing, of a ghost's wall point within which it stands for the wall"""
_INSIDE = 1e-3
"""distance over spacing from a thin wall at which particles are put back"""
_LEAST = 1e-12
"""depth over spacing from which a particle is behind a plane, beyond round-off"""
_MARGIN = 0.2
"""distance over spacing in front of a plane from which a particle may be behind a wall that is curved"""
_FIRST_LAYER = 0.625
"""depth over spacing up to which a ghost is of the first layer: it is about 1/2 there, and 3/2 in the next"""


@numba.njit(error_model="numpy", forceinline=True)
def _behind(rows, i, foot, normal, g, dim, periodic, parameters):  # type: ignore[no-untyped-def]
    """Return how far row ``i`` lies behind the plane of the wall at the foot of ghost ``g``."""
    depth = 0.0
    for d in range(dim):
        offset = rows[i, d] - foot[g, d]
        if periodic:
            offset = nearest(offset, parameters, d)
        depth += offset * normal[g, d]
    return depth


@numba.njit(error_model="numpy", forceinline=True)
def _stands_for_wall(rows, i, ghost, foot, g, near, dim, periodic, parameters):  # type: ignore[no-untyped-def]
    """Whether row ``ghost``, with wall point ``foot[g]``, is of the first layer and within ``near`` dx of row ``i``."""
    spacing = parameters.spacing
    if squared_distance(rows, ghost, rows, i, dim, periodic, parameters) > (near * spacing) ** 2:
        return False
    return squared_distance(rows, ghost, foot, g, dim, periodic, parameters) < (_FIRST_LAYER * spacing) ** 2


@numba.njit(error_model="numpy", forceinline=True)
def _convex(foot, normal, g, other, least, dim, periodic, parameters):  # type: ignore[no-untyped-def]
    """Whether the feet of two ghosts lie on a convex part of a solid: each is behind the plane of the other."""
    behind_one = 0.0
    behind_other = 0.0
    for d in range(dim):
        offset = foot[other, d] - foot[g, d]
        if periodic:
            offset = nearest(offset, parameters, d)
        behind_one += offset * normal[g, d]
        behind_other -= offset * normal[other, d]
    return behind_one > least and behind_other > least


@numba.njit(error_model="numpy")
def _put_back_one(  # type: ignore[no-untyped-def]
    rows, i, ghosts, fluid_count, columns, foot, normal, wall_velocity, inside, periodic, parameters
):
    """Put row ``i`` back if it is behind the wall of any of the ``ghosts`` (rows) near it; return 1 if it was, or 0.

    It is put at the distance ``inside`` from the wall, m.
    """
    spacing = parameters.spacing
    least = _LEAST * spacing
    touched = 0
    for ghost in ghosts:
        g = ghost - fluid_count
        if not _stands_for_wall(rows, i, ghost, foot, g, _NEAR, columns.dim, periodic, parameters):
            continue
        depth = _behind(rows, i, foot, normal, g, columns.dim, periodic, parameters)
        if depth < least or depth > 0.5 * spacing:  # a step is much shorter: that deep, it is another wall
            continue
        for neighbour in ghosts:
            other = neighbour - fluid_count
            if not _stands_for_wall(rows, i, neighbour, foot, other, _BESIDE, columns.dim, periodic, parameters):
                continue
            behind_other = _behind(rows, i, foot, normal, other, columns.dim, periodic, parameters)
            if behind_other < depth and _convex(
                foot, normal, g, other, 1e-6 * spacing, columns.dim, periodic, parameters
            ):
                depth = behind_other
                g = other
        if depth < least:
            continue
        touched = 1
        into = 0.0
        for d in range(columns.dim):
            into += (rows[i, columns.u + d] - wall_velocity[g, d]) * normal[g, d]
        for d in range(columns.dim):
            rows[i, d] -= (depth + inside) * normal[g, d]
            rows[i, columns.u + d] -= max(into, 0.0) * normal[g, d]
    return touched


@numba.njit(error_model="numpy")
def _ghosts_beside(  # type: ignore[no-untyped-def]
    rows, i, ghosts, shares, passable, fluid_count, columns, foot, normal, periodic, parameters
):
    """Return those of the ``ghosts`` (rows) beside whose wall points row ``i`` lies, and which it sees."""
    kept = np.empty(ghosts.shape[0], ghosts.dtype)
    count = 0
    for k in range(ghosts.shape[0]):
        g = ghosts[k] - fluid_count
        if shares[k] >= HALF and not passable[g]:
            depth = _behind(rows, i, foot, normal, g, columns.dim, periodic, parameters)
            along2 = squared_distance(rows, i, foot, g, columns.dim, periodic, parameters) - depth * depth
            if along2 < (_ALONG * parameters.spacing) ** 2:
                kept[count] = ghosts[k]
                count += 1
    return kept[:count]


def put_back(  # type: ignore[no-untyped-def]
    rows, fluid_count, lists, fluid_counts, ghost_counts, shares, passable, columns, parameters, foot, normal,
    wall_velocity, marked,
):  # fmt: skip
    """Put the particles behind a wall back on its surface, in ``rows``; return their number.

    A row of ``lists`` is the common list of LANES particles; ``columns``: :class:`Columns` of ``rows``; ``foot`` and
    ``normal`` (g, dim): wall point, m, and unit normal out of the fluid; ``wall_velocity`` (g, dim): velocity of the
    wall at each ghost, m/s. With MASKED, ``shares`` are those in which the particles see the entries of the lists, and
    ``passable`` (g,) are ghosts beyond the end of a thin wall. With MARKS, nothing is put back, and ``marked``
    (fluid_count,) says which particles may be behind a wall.
    """
    contacts = 0
    spacing = parameters.spacing
    near = (_NEAR * spacing) ** 2
    first_layer = (_FIRST_LAYER * spacing) ** 2
    for c in numba.prange(fluid_counts.shape[0]):
        if ghost_counts[c] == 0:
            continue
        first = c * LANES
        present = min(LANES, fluid_count - first)
        deepest = local_array(LANES)
        widest = 0.0
        for a in range(LANES):
            deepest[a] = -math.inf
            i = first + min(a, present - 1)
            widest = max(widest, squared_distance(rows, i, rows, first, columns.dim, PERIODIC, parameters))
        within = (_NEAR * spacing + math.sqrt(widest)) ** 2
        begin = fluid_counts[c]
        end = begin + ghost_counts[c]
        for k in range(begin, end):
            j = lists[c, k]
            g = j - fluid_count
            if squared_distance(rows, j, rows, first, columns.dim, PERIODIC, parameters) > within:
                continue  # it is near none of them
            if squared_distance(rows, j, foot, g, columns.dim, PERIODIC, parameters) < first_layer:
                for a in range(present):
                    i = first + a
                    if squared_distance(rows, j, rows, i, columns.dim, PERIODIC, parameters) <= near:
                        depth = _behind(rows, i, foot, normal, g, columns.dim, PERIODIC, parameters)
                        deepest[a] = max(deepest[a], depth)
        for a in range(present):
            i = first + a
            if MARKS:
                marked[i] = deepest[a] > -_MARGIN * spacing
            elif deepest[a] >= _LEAST * spacing:
                ghosts = lists[c, begin:end]
                inside = 0.0
                if MASKED:
                    inside = _INSIDE * spacing
                    ghosts = _ghosts_beside(
                        rows, i, ghosts, shares[c, begin:end, a], passable, fluid_count, columns, foot, normal,
                        PERIODIC, parameters,
                    )  # fmt: skip
                contacts += _put_back_one(
                    rows, i, ghosts, fluid_count, columns, foot, normal, wall_velocity, inside, PERIODIC, parameters
                )
    return contacts
