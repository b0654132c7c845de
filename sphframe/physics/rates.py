"""Physics: the sums over the neighbours of all particles in one loop; each term is explained in its own file.

With CONTINUITY the compiled loop computes the density rate from a given density gradient. Without it, the loop computes
the acceleration and the density gradient together, since half of the cost of a pair is its distance and kernel.
"""

import numba

from sphframe.compiled import LANES, fma, local_array, nearest
from sphframe.compiled.stand_ins import COLUMNS, DIM, GRADIENT, MASKED, MORRIS, PERIODIC, SUPPORT
from sphframe.neighbours.sight import WHOLE
from sphframe.physics.body_force import body_force
from sphframe.physics.continuity import diffusive_flux
from sphframe.physics.density_gradient import renormalised_2d, renormalised_3d
from sphframe.physics.lanes import read_lanes
from sphframe.physics.momentum import pair_stress

PER_WHOLE = 1.0 / WHOLE

# parts bound by specialise()
CONTINUITY = True
KINDS = 2
"""1: sums over the fluid alone; 2: ghosts are seen as they were assigned"""


def fluid_sums(  # type: ignore[no-untyped-def]
    rows, lists, fluid_counts, ghost_counts, shares, parameters, gradient, rates
):
    """Write velocities and, depending on CONTINUITY, density rates or accelerations to ``rates`` (n, 2 dim + 1).

    With CONTINUITY the density rate is computed with the given ``gradient`` (n, dim). Without it, the acceleration is
    computed, and <grad rho> is written to ``gradient``. ``parameters``: :class:`LoopParameters`. With MASKED,
    ``shares`` are those in which the particles see the entries, see :class:`sphframe.neighbours.NeighbourLists`.

    A row of ``lists`` is the common list of LANES consecutive particles. Each neighbour is read once and then
    interacts with all of them: the innermost loops run over these particles, and the compiler turns the loops into
    vector instructions and the local arrays into registers. The sums of a particle keep the order of the list.
    """
    limit = parameters.support * parameters.support
    per_h2 = SUPPORT * SUPPORT / limit
    n = rates.shape[0]
    for c in numba.prange(fluid_counts.shape[0]):
        first = c * LANES
        present = min(LANES, n - first)
        fluid = fluid_counts[c]
        both = fluid + ghost_counts[c]
        x, y, z = local_array(LANES), local_array(LANES), local_array(LANES)
        u, v, w = local_array(LANES), local_array(LANES), local_array(LANES)
        density, pressure = local_array(LANES), local_array(LANES)
        gx, gy, gz = local_array(LANES), local_array(LANES), local_array(LANES)
        compression, diffused, diffused_by_fluid = local_array(LANES), local_array(LANES), local_array(LANES)
        fx, fy, fz = local_array(LANES), local_array(LANES), local_array(LANES)
        bx, by, bz = local_array(LANES), local_array(LANES), local_array(LANES)
        xx, xy, yy = local_array(LANES), local_array(LANES), local_array(LANES)
        xz, yz, zz = local_array(LANES), local_array(LANES), local_array(LANES)
        read_lanes(rows, first, present, COLUMNS, x, y, z, u, v, w, density, pressure)
        for a in range(LANES):
            i = first + min(a, present - 1)
            gx[a] = gradient[i, 0]
            gy[a] = gradient[i, 1]
            gz[a] = gradient[i, COLUMNS.z]
            compression[a] = diffused[a] = 0.0
            fx[a] = fy[a] = fz[a] = 0.0
            bx[a] = by[a] = bz[a] = 0.0
            xx[a] = xy[a] = yy[a] = xz[a] = yz[a] = zz[a] = 0.0
        for kind in range(KINDS):
            for k in range(0 if kind == 0 else fluid, fluid if kind == 0 else both):
                j = lists[c, k]
                xj, yj, zj = rows[j, 0], rows[j, 1], rows[j, COLUMNS.z]
                uj, vj, wj = rows[j, COLUMNS.u], rows[j, COLUMNS.v], rows[j, COLUMNS.w]
                density_j, pressure_j = rows[j, COLUMNS.density], rows[j, COLUMNS.pressure]
                scale = -parameters.gradient_scale * rows[j, COLUMNS.volume]
                m = j if j < n else 0  # ghosts have no gradient; their diffusion is computed but not used
                gxj = gradient[m, 0]
                gyj = gradient[m, 1]
                gzj = gradient[m, COLUMNS.z]
                for a in range(LANES):
                    dx = xj - x[a]
                    dy = yj - y[a]
                    if PERIODIC:
                        dx = nearest(dx, parameters, 0)
                        dy = nearest(dy, parameters, 1)
                    r2 = fma(dx, dx, dy * dy)
                    if DIM == 3:
                        dz = zj - z[a]
                        if PERIODIC:
                            dz = nearest(dz, parameters, 2)
                        r2 = fma(dz, dz, r2)
                    weight = GRADIENT(r2 * per_h2) * scale
                    weight = weight if r2 < limit else 0.0  # a selection, not a branch, so that the loop vectorises
                    if MASKED:
                        weight *= PER_WHOLE * shares[c, k, a]
                    approach = fma(uj - u[a], dx, (vj - v[a]) * dy)
                    if DIM == 3:
                        approach = fma(wj - w[a], dz, approach)
                    if CONTINUITY:
                        sloped = fma(gx[a] + gxj, dx, (gy[a] + gyj) * dy)
                        if DIM == 3:
                            sloped = fma(gz[a] + gzj, dz, sloped)
                        compression[a] = fma(weight, approach, compression[a])
                        diffused[a] = fma(weight, diffusive_flux(density_j - density[a], sloped), diffused[a])
                    else:
                        stress = weight * pair_stress(pressure[a] + pressure_j, parameters.viscosity, approach, r2)
                        fx[a] = fma(stress, dx, fx[a])
                        fy[a] = fma(stress, dy, fy[a])
                        if DIM == 3:
                            fz[a] = fma(stress, dz, fz[a])
                        if MORRIS:
                            friction = weight * parameters.friction
                            fx[a] = fma(friction, uj - u[a], fx[a])
                            fy[a] = fma(friction, vj - v[a], fy[a])
                            if DIM == 3:
                                fz[a] = fma(friction, wj - w[a], fz[a])
                        rise = weight * (density_j - density[a])
                        wx = weight * dx
                        wy = weight * dy
                        bx[a] = fma(rise, dx, bx[a])
                        by[a] = fma(rise, dy, by[a])
                        xx[a] = fma(wx, dx, xx[a])
                        xy[a] = fma(wx, dy, xy[a])
                        yy[a] = fma(wy, dy, yy[a])
                        if DIM == 3:
                            bz[a] = fma(rise, dz, bz[a])
                            xz[a] = fma(wx, dz, xz[a])
                            yz[a] = fma(wy, dz, yz[a])
                            zz[a] = fma(weight * dz, dz, zz[a])
            if kind == 0:  # the sums over the fluid alone are complete
                for a in range(present):
                    i = first + a
                    if CONTINUITY:
                        diffused_by_fluid[a] = diffused[a]
                    elif DIM == 2:
                        gradient[i, 0], gradient[i, 1] = renormalised_2d(bx[a], by[a], xx[a], xy[a], yy[a])
                    else:
                        gradient[i, 0], gradient[i, 1], gradient[i, 2] = renormalised_3d(
                            bx[a], by[a], bz[a], xx[a], xy[a], yy[a], xz[a], yz[a], zz[a]
                        )
        for a in range(present):
            i = first + a
            rates[i, 0] = u[a]
            rates[i, 1] = v[a]
            if DIM == 3:
                rates[i, 2] = w[a]
            if CONTINUITY:
                rates[i, COLUMNS.density] = parameters.diffusion * diffused_by_fluid[a] - density[a] * compression[a]
            else:
                ax, ay, az = body_force(parameters, x[a], y[a], z[a])
                rates[i, COLUMNS.u] = fx[a] / density[a] + ax
                rates[i, COLUMNS.v] = fy[a] / density[a] + ay
                if DIM == 3:
                    rates[i, COLUMNS.w] = fz[a] / density[a] + az
