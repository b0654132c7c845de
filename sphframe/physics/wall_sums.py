"""Physics: the sums over wall particles for treatments that change what the fluid sees of them.

They take the place of the part of :func:`sphframe.physics.rates.fluid_sums` for ghosts, with the same equations, but
pressure and velocities of a wall particle are those that the treatment lets this fluid particle see. A treatment with a
force of its own adds its acceleration instead, and has no part in the density rate.
"""

import numba

from sphframe.compiled import LANES, fma, local_array, nearest
from sphframe.compiled.stand_ins import COLUMNS, DIM, FORCE, GRADIENT, MASKED, MORRIS, PERIODIC, SEEN, SLOTS, SUPPORT
from sphframe.interfaces import FluidSide, Separation
from sphframe.neighbours.sight import WHOLE
from sphframe.physics.lanes import read_lanes
from sphframe.physics.momentum import pair_stress
from sphframe.physics.wall_pair import wall_side

PER_WHOLE = 1.0 / WHOLE

# parts bound by specialise()
CONTINUITY = True
FORCES = False
IMAGES = False
"""whether images of the fluid take the place of ghosts; then the loop runs over the lists of the fluid"""


def wall_sums(  # type: ignore[no-untyped-def]
    rows, lists, fluid_counts, ghost_counts, shares, walls, images, parameters, rates
):
    """Add the sums over wall particles to the density rates or, without CONTINUITY, to the accelerations ``rates``.

    ``walls``: :class:`~sphframe.boundary.wall_arrays.WallArrays`; ``images``: :class:`~sphframe.boundary.images.Images`
    of the particles; all others as in :func:`fluid_sums`.
    """
    limit = parameters.support * parameters.support
    per_h2 = SUPPORT * SUPPORT / limit
    n = rates.shape[0]
    for c in numba.prange(fluid_counts.shape[0]):
        if ghost_counts[c] == 0:
            continue
        first, fluid = c * LANES, fluid_counts[c]
        present = min(LANES, n - first)
        source = images.rows if IMAGES else rows
        x, y, z = local_array(LANES), local_array(LANES), local_array(LANES)
        u, v, w = local_array(LANES), local_array(LANES), local_array(LANES)
        density, pressure = local_array(LANES), local_array(LANES)
        compression = local_array(LANES)
        fx, fy, fz = local_array(LANES), local_array(LANES), local_array(LANES)
        read_lanes(rows, first, present, COLUMNS, x, y, z, u, v, w, density, pressure)
        for a in range(LANES):
            compression[a] = fx[a] = fy[a] = fz[a] = 0.0
        for k in range(0 if IMAGES else fluid, fluid if IMAGES else fluid + ghost_counts[c]):
            j = lists[c, k]
            for s in range(images.counts[j] if IMAGES else 1):
                row = SLOTS * j + s if IMAGES else j
                g = images.ghost[row] if IMAGES else j - n
                xj, yj, zj = source[row, 0], source[row, 1], source[row, 2] if DIM == 3 else 0.0
                scale = -parameters.gradient_scale * source[row, COLUMNS.volume]
                wall = wall_side(source, row, walls, g, COLUMNS)
                for a in range(LANES):
                    dx, dy, dz = xj - x[a], yj - y[a], zj - z[a]
                    if PERIODIC:
                        dx = nearest(dx, parameters, 0)
                        dy = nearest(dy, parameters, 1)
                        dz = nearest(dz, parameters, 2)
                    r2 = fma(dx, dx, dy * dy)
                    if DIM == 3:
                        r2 = fma(dz, dz, r2)
                    separation = Separation(dx, dy, dz, r2)
                    if FORCES:
                        ax, ay, az = FORCE(wall, separation, parameters)
                        share = PER_WHOLE * shares[c, k, a] if MASKED else 1.0
                        fx[a] += share * ax
                        fy[a] += share * ay
                        fz[a] += share * az
                    else:
                        weight = GRADIENT(r2 * per_h2) * scale
                        weight = weight if r2 < limit else 0.0
                        if MASKED:
                            weight *= PER_WHOLE * shares[c, k, a]
                        seen = SEEN(FluidSide(pressure[a], density[a], u[a], v[a], w[a]), wall, separation, parameters)
                        if CONTINUITY:
                            approach = fma(seen.u - u[a], dx, (seen.v - v[a]) * dy)
                            if DIM == 3:
                                approach = fma(seen.w - w[a], dz, approach)
                            compression[a] = fma(weight, approach, compression[a])
                        else:
                            approach = fma(seen.viscous_u - u[a], dx, (seen.viscous_v - v[a]) * dy)
                            if DIM == 3:
                                approach = fma(seen.viscous_w - w[a], dz, approach)
                            stress = weight * pair_stress(seen.pressure_sum, parameters.viscosity, approach, r2)
                            fx[a] = fma(stress, dx, fx[a])
                            fy[a] = fma(stress, dy, fy[a])
                            if DIM == 3:
                                fz[a] = fma(stress, dz, fz[a])
                            if MORRIS:
                                friction = weight * parameters.friction
                                fx[a] = fma(friction, seen.viscous_u - u[a], fx[a])
                                fy[a] = fma(friction, seen.viscous_v - v[a], fy[a])
                                if DIM == 3:
                                    fz[a] = fma(friction, seen.viscous_w - w[a], fz[a])
        for a in range(present):
            i = first + a
            if CONTINUITY:
                rates[i, COLUMNS.density] -= density[a] * compression[a]
            else:
                per_density = 1.0 if FORCES else 1.0 / density[a]
                rates[i, COLUMNS.u] += fx[a] * per_density
                rates[i, COLUMNS.v] += fy[a] * per_density
                if DIM == 3:
                    rates[i, COLUMNS.w] += fz[a] * per_density
