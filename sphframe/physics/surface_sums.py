"""Physics: walls as edges over which the kernel is integrated exactly, in two dimensions.

For a fluid particle and an edge with the unit normal n out of the fluid, the integrals of the kernel
(:meth:`sphframe.Kernel.edge_integrals_function`) give the part of the solid behind the edge in the kernel, and its
gradient. Their sums over the edges in reach are::

    gamma = 1 - sum_e solid_e,    grad gamma = -sum_e n_e weight_e

A treatment gives force and divergence of each edge; those of USAW are divided by gamma, with the fluid's own sums.
"""

import numba

from sphframe.compiled import LANES, nearest
from sphframe.compiled.stand_ins import COLUMNS, EDGE_INTEGRALS, PERIODIC, SURFACE
from sphframe.interfaces import Edge, FluidSide
from sphframe.physics.body_force import body_force
from sphframe.physics.wall_force import add_load
from sphframe.physics.wall_pair import wall_side

# parts bound by specialise()
CONTINUITY = True
DIVIDES = False
SIGMA = 1.0
"""normalisation of the kernel in two dimensions"""
_LEAST = 0.05
"""least gamma by which sums are divided"""


@numba.njit(error_model="numpy", forceinline=True)
def _edge(rows, i, j, walls, g, parameters, integrals, sigma, periodic):  # type: ignore[no-untyped-def]
    """Return the :class:`Edge` of wall particle ``g`` in row ``j``, as particle ``i`` sees it."""
    h = parameters.smoothing_length
    nx, ny = walls.normal[g, 0], walls.normal[g, 1]
    dx, dy = rows[j, 0] - rows[i, 0], rows[j, 1] - rows[i, 1]
    if periodic:
        dx, dy = nearest(dx, parameters, 0), nearest(dy, parameters, 1)
    z = dx * nx + dy * ny
    along = dy * nx - dx * ny
    half = 0.5 * walls.volume[g] / parameters.spacing
    c, w0, w1 = integrals(z / h, (along - half) / h, (along + half) / h)
    return Edge(z, along - half, along + half, sigma * c, sigma * w0 / h, sigma * w1)


def surface_sums(  # type: ignore[no-untyped-def]
    rows, lists, fluid_counts, ghost_counts, seen_shares, walls, images, parameters, rates
):
    """Add force and divergence of the edges to ``rates`` (n, 5); all arguments as in :func:`wall_sums`."""
    n = rates.shape[0]
    for c in numba.prange(fluid_counts.shape[0]):
        if ghost_counts[c] == 0:
            continue
        for i in range(c * LANES, min((c + 1) * LANES, n)):
            density = rows[i, COLUMNS.density]
            fluid = FluidSide(rows[i, COLUMNS.pressure], density, rows[i, COLUMNS.u], rows[i, COLUMNS.v], 0.0)
            fx = 0.0
            fy = 0.0
            divergence = 0.0
            solid = 0.0
            for k in range(fluid_counts[c], fluid_counts[c] + ghost_counts[c]):
                j = lists[c, k]
                edge = _edge(rows, i, j, walls, j - n, parameters, EDGE_INTEGRALS, SIGMA, PERIODIC)
                if edge.weight == 0.0:
                    continue  # out of reach
                wall = wall_side(rows, j, walls, j - n, COLUMNS)
                ex, ey, opening = SURFACE(fluid, wall, edge, parameters)
                solid += edge.solid
                fx += ex
                fy += ey
                divergence += opening
            per_gamma = 1.0 / max(1.0 - solid, _LEAST) if DIVIDES else 1.0
            if CONTINUITY:
                rate = rates[i, COLUMNS.density] - density * divergence
                rates[i, COLUMNS.density] = rate * per_gamma
            else:
                ax, ay, _ = body_force(parameters, rows[i, 0], rows[i, 1], 0.0)
                rates[i, COLUMNS.u] = (rates[i, COLUMNS.u] - ax + fx / density) * per_gamma + ax
                rates[i, COLUMNS.v] = (rates[i, COLUMNS.v] - ay + fy / density) * per_gamma + ay


def surface_reaction(  # type: ignore[no-untyped-def]
    rows, fluid_count, lists, fluid_counts, ghost_counts, seen_shares, ghost_walls, shares, centres, walls,
    images, parameters, partial,
):  # fmt: skip
    """Add force and moment of each wall to ``partial``; all arguments as in :func:`wall_reaction`."""
    chunks = partial.shape[0]
    for chunk in numba.prange(chunks):
        for i in range(chunk * fluid_count // chunks, (chunk + 1) * fluid_count // chunks):
            c = i // LANES
            fluid = FluidSide(
                rows[i, COLUMNS.pressure], rows[i, COLUMNS.density], rows[i, COLUMNS.u], rows[i, COLUMNS.v], 0.0
            )
            volume = rows[i, COLUMNS.volume]
            first, last = fluid_counts[c], fluid_counts[c] + ghost_counts[c]
            if DIVIDES:
                solid = 0.0
                for k in range(first, last):
                    j = lists[c, k]
                    g = j - fluid_count
                    solid += _edge(rows, i, j, walls, g, parameters, EDGE_INTEGRALS, SIGMA, PERIODIC).solid
                volume /= max(1.0 - solid, _LEAST)
            for k in range(first, last):
                j = lists[c, k]
                g = j - fluid_count
                edge = _edge(rows, i, j, walls, g, parameters, EDGE_INTEGRALS, SIGMA, PERIODIC)
                ex, ey, _ = SURFACE(fluid, wall_side(rows, j, walls, g, COLUMNS), edge, parameters)
                own = ghost_walls[g]
                add_load(partial[chunk, own], rows[i], centres[own], -volume * ex, -volume * ey, 0.0)
