"""Boundary: particles behind a wall are put back on its surface.

The pressures of the ghosts keep the fluid away from the walls. But a single fast particle of a jet, which has no
neighbours that push it back, can cross the surface by a fraction of a spacing, and no force would return it. Such a
particle is put on the surface, and the component of its relative velocity into the wall is set to zero.

With the nearest ghost of the first layer, its wall point w and normal n out of the fluid, the particle is behind the
wall when s = (x - w).n > 0, and then

    x := x - s n,    u := u - max[(u - u_wall).n, 0] n

Departs from the paper, which has no such rule. In a tank at rest it acts on no particle.
"""

import numba

from sphframe.compiled import LANES, local_array, squared_distance


@numba.njit(parallel=True, cache=True, error_model="numpy")
def put_back(  # type: ignore[no-untyped-def]
    rows, fluid_count, lists, fluid_counts, ghost_counts, columns, spacing, foot, normal, wall_velocity
):
    """Put the particles behind a wall back on its surface, in ``rows``; return their number.

    A row of ``lists`` is the common list of LANES particles; ``columns``: :class:`Columns` of ``rows``; ``foot`` and
    ``normal`` (g, dim): wall point, m, and unit normal out of the fluid; ``wall_velocity`` (g, dim): velocity of the
    wall at each ghost, m/s.
    """
    contacts = 0
    for c in numba.prange(fluid_counts.shape[0]):
        if ghost_counts[c] == 0:
            continue
        first = c * LANES
        present = min(LANES, fluid_count - first)
        closest = local_array(LANES)
        nearest = local_array(LANES)
        for a in range(LANES):
            closest[a] = spacing * spacing
            nearest[a] = -1.0
        for k in range(fluid_counts[c], fluid_counts[c] + ghost_counts[c]):
            j = lists[c, k]
            depth2 = squared_distance(rows, j, foot, j - fluid_count, columns.dim)
            if depth2 > 0.375 * spacing * spacing:  # the depth is 1/2 spacing in the first layer, 3/2 in the next
                continue
            for a in range(present):
                distance2 = squared_distance(rows, j, rows, first + a, columns.dim)
                if distance2 < closest[a]:
                    closest[a] = distance2
                    nearest[a] = j - fluid_count
        for a in range(present):
            if nearest[a] >= 0.0:
                i = first + a
                g = int(nearest[a])
                depth = 0.0
                into = 0.0
                for d in range(columns.dim):
                    depth += (rows[i, d] - foot[g, d]) * normal[g, d]
                    into += (rows[i, columns.u + d] - wall_velocity[g, d]) * normal[g, d]
                if depth > 1e-12 * spacing:
                    for d in range(columns.dim):
                        rows[i, d] -= depth * normal[g, d]
                        rows[i, columns.u + d] -= max(into, 0.0) * normal[g, d]
                    contacts += 1
    return contacts
