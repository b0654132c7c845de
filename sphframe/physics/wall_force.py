"""Physics: the force of the fluid on each wall, as the reaction of the momentum equation on the wall's ghosts.

::

    F = -sum_i V_i sum_(g in wall) [-(p_i + p_g) + alpha h c0 rho0 pi_ig] grad_i W_ig V_g,    i in fluid

with p_g and the velocity in pi_ig as the particle i sees them (:mod:`sphframe.physics.wall_sums`), or minus the sum of
the forces that a treatment gives, and its moment about the centre of the wall's body. In the corner between two walls
each bears its part of the force on a ghost (see :mod:`sphframe.boundary.corners`). Particles are summed in a fixed
number of chunks, and the chunks in their order, so the result has the same bits on any number of threads.

Departs from the paper: its Eq. 29 takes a pressure difference, which is zero on a hydrostatic wall.
"""

import numba

from sphframe.compiled import LANES, local_array, nearest
from sphframe.compiled.stand_ins import COLUMNS, DIM, FORCE, GRADIENT, MASKED, MORRIS, PERIODIC, SEEN, SLOTS, SUPPORT
from sphframe.interfaces import FluidSide, Separation
from sphframe.neighbours.sight import WHOLE
from sphframe.physics.lanes import read_lanes
from sphframe.physics.momentum import pair_stress
from sphframe.physics.wall_pair import wall_side

# parts bound by specialise()
AS_ASSIGNED = True
"""whether ghosts are seen as they were assigned"""
FORCES = False
"""whether the treatment gives the force"""
IMAGES = False
"""whether images of the fluid take the place of ghosts"""

PER_WHOLE = 1.0 / WHOLE


@numba.njit(error_model="numpy", forceinline=True)
def add_load(load, row, centre, fx, fy, fz):  # type: ignore[no-untyped-def]
    """Add a force on the particle ``row`` and its moment about ``centre`` to ``load``, (3,) in 2-D, (6,) in 3-D."""
    load[0] += fx
    load[1] += fy
    if centre.shape[0] == 3:
        rx, ry, rz = row[0] - centre[0], row[1] - centre[1], row[2] - centre[2]
        load[2] += fz
        load[3] += ry * fz - rz * fy
        load[4] += rz * fx - rx * fz
        load[5] += rx * fy - ry * fx
    else:
        load[2] += (row[0] - centre[0]) * fy - (row[1] - centre[1]) * fx


@numba.njit(error_model="numpy")
def _add_loads(load, rows, first, present, centre, fx, fy, fz):  # type: ignore[no-untyped-def]
    """Add the forces (present,) on the rows from ``first`` on, and set them to zero."""
    for a in range(present):
        add_load(load, rows[first + a], centre, fx[a], fy[a], fz[a])
        fx[a] = fy[a] = fz[a] = 0.0


def wall_reaction(  # type: ignore[no-untyped-def]
    rows, fluid_count, lists, fluid_counts, ghost_counts, seen_shares, ghost_walls, shares, centres, walls,
    images, parameters, partial,
):  # fmt: skip
    """Add force, N, and moment, N m, of each wall from chunks of the fluid to ``partial`` (chunks, walls, 3 or 6).

    ``shares``: :class:`~sphframe.boundary.corners.Shares` of second walls in the forces on ghosts in corners;
    ``seen_shares``: those in which the particles see the entries; ``images``: of the particles;
    ``centres`` (walls, dim): the points to which moments refer, m. In 2-D loads are per metre of width.

    As in :func:`~sphframe.physics.rates.fluid_sums`, each ghost is read once for LANES particles. The forces of
    consecutive ghosts of one wall are summed for each particle, before their moments are taken.
    """
    limit = parameters.support * parameters.support
    per_h2 = SUPPORT * SUPPORT / limit
    chunks, clusters = partial.shape[0], fluid_counts.shape[0]
    source = images.rows if IMAGES else rows
    for chunk in numba.prange(chunks):
        x, y, z = local_array(LANES), local_array(LANES), local_array(LANES)
        u, v, w = local_array(LANES), local_array(LANES), local_array(LANES)
        density, pressure, amount = local_array(LANES), local_array(LANES), local_array(LANES)
        px, py, pz = local_array(LANES), local_array(LANES), local_array(LANES)
        fx, fy, fz = local_array(LANES), local_array(LANES), local_array(LANES)
        for c in range(chunk * clusters // chunks, (chunk + 1) * clusters // chunks):
            if ghost_counts[c] == 0:
                continue
            first, fluid = c * LANES, fluid_counts[c]
            present = min(LANES, fluid_count - first)
            read_lanes(rows, first, present, COLUMNS, x, y, z, u, v, w, density, pressure)
            for a in range(LANES):
                i = first + min(a, present - 1)
                amount[a] = rows[i, COLUMNS.mass if FORCES else COLUMNS.volume] if a < present else 0.0
                fx[a] = fy[a] = fz[a] = 0.0
            own = 0
            for k in range(0 if IMAGES else fluid, fluid if IMAGES else fluid + ghost_counts[c]):
                j = lists[c, k]
                for s in range(images.counts[j] if IMAGES else 1):
                    row = SLOTS * j + s if IMAGES else j
                    g = images.ghost[row] if IMAGES else j - fluid_count
                    if ghost_walls[g] != own:
                        _add_loads(partial[chunk, own], rows, first, present, centres[own], fx, fy, fz)
                        own = ghost_walls[g]
                    xj, yj, zj = source[row, 0], source[row, 1], source[row, COLUMNS.z]
                    scale = parameters.gradient_scale * source[row, COLUMNS.volume]
                    uj, vj, wj = source[row, COLUMNS.u], source[row, COLUMNS.v], source[row, COLUMNS.w]
                    pressure_j = source[row, COLUMNS.pressure]
                    if not AS_ASSIGNED:
                        wall = wall_side(source, row, walls, g, COLUMNS)
                    for a in range(LANES):
                        dx, dy, dz = xj - x[a], yj - y[a], zj - z[a] if DIM == 3 else 0.0
                        if PERIODIC:
                            dx, dy = nearest(dx, parameters, 0), nearest(dy, parameters, 1)
                            dz = nearest(dz, parameters, 2)
                        r2 = dx * dx + dy * dy + dz * dz
                        share = amount[a] * (PER_WHOLE * seen_shares[c, k, a] if MASKED else 1.0)
                        if FORCES:
                            ax, ay, az = FORCE(wall, Separation(dx, dy, dz, r2), parameters)
                            px[a], py[a], pz[a] = -share * ax, -share * ay, -share * az
                        else:
                            pressures = pressure[a] + pressure_j
                            ru, rv, rw = uj - u[a], vj - v[a], wj - w[a]
                            if not AS_ASSIGNED:
                                side = FluidSide(pressure[a], density[a], u[a], v[a], w[a])
                                seen = SEEN(side, wall, Separation(dx, dy, dz, r2), parameters)
                                pressures = seen.pressure_sum
                                ru, rv, rw = seen.viscous_u - u[a], seen.viscous_v - v[a], seen.viscous_w - w[a]
                            weight = share * scale * GRADIENT(r2 * per_h2) if r2 < limit else 0.0
                            approach = ru * dx + rv * dy + rw * dz
                            stress = weight * pair_stress(pressures, parameters.viscosity, approach, r2)
                            friction = weight * parameters.friction if MORRIS else 0.0
                            px[a], py[a] = stress * dx + friction * ru, stress * dy + friction * rv
                            pz[a] = stress * dz + friction * rw
                    other = shares.wall[g]
                    if other >= 0:
                        for a in range(present):
                            along = px[a] * shares.dual[g, 0] + py[a] * shares.dual[g, 1]
                            ox, oy = along * shares.normal[g, 0], along * shares.normal[g, 1]
                            add_load(partial[chunk, other], rows[first + a], centres[other], ox, oy, 0.0)
                            px[a], py[a] = px[a] - ox, py[a] - oy
                    for a in range(LANES):
                        fx[a], fy[a], fz[a] = fx[a] + px[a], fy[a] + py[a], fz[a] + pz[a]
            _add_loads(partial[chunk, own], rows, first, present, centres[own], fx, fy, fz)
