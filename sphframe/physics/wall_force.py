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

from sphframe.compiled import LANES, offset_between
from sphframe.compiled.stand_ins import COLUMNS, DIM, FORCE, GRADIENT, MASKED, MORRIS, PERIODIC, SEEN, SLOTS, SUPPORT
from sphframe.interfaces import FluidSide, Separation
from sphframe.neighbours.sight import WHOLE
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


def wall_reaction(  # type: ignore[no-untyped-def]
    rows, fluid_count, lists, fluid_counts, ghost_counts, seen_shares, ghost_walls, shares, centres, walls,
    images, parameters, partial,
):  # fmt: skip
    """Write force, N, and moment, N m, of each wall from chunks of the fluid to ``partial`` (chunks, walls, 3 or 6).

    ``shares``: :class:`~sphframe.boundary.corners.Shares` of second walls in the forces on ghosts in corners;
    ``seen_shares``: those in which the particles see the entries; ``images``: of the particles;
    ``centres`` (walls, dim): the points to which moments refer, m. In 2-D loads are per metre of width.
    """
    limit = parameters.support * parameters.support
    per_h2 = SUPPORT * SUPPORT / limit
    chunks = partial.shape[0]
    source = images.rows if IMAGES else rows
    for chunk in numba.prange(chunks):
        for member in range(partial.shape[1]):  # arrays set as a whole would be loops for threads, compiled apart
            for k in range(partial.shape[2]):
                partial[chunk, member, k] = 0.0
        for i in range(chunk * fluid_count // chunks, (chunk + 1) * fluid_count // chunks):
            c = i // LANES
            fluid = fluid_counts[c]
            for k in range(0 if IMAGES else fluid, fluid if IMAGES else fluid + ghost_counts[c]):
                j = lists[c, k]
                for s in range(images.counts[j] if IMAGES else 1):
                    row = SLOTS * j + s if IMAGES else j
                    g = images.ghost[row] if IMAGES else j - fluid_count
                    dx, dy, dz, r2 = offset_between(source, row, rows, i, DIM, PERIODIC, parameters)
                    if r2 < limit:
                        pressures = rows[i, COLUMNS.pressure] + source[row, COLUMNS.pressure]
                        u, v, w = source[row, COLUMNS.u], source[row, COLUMNS.v], source[row, COLUMNS.w]
                        if not AS_ASSIGNED:
                            separation = Separation(dx, dy, dz, r2)
                            wall = wall_side(source, row, walls, g, COLUMNS)
                        if FORCES:
                            mass = rows[i, COLUMNS.mass]
                            ax, ay, az = FORCE(wall, separation, parameters)
                            fx, fy, fz = -mass * ax, -mass * ay, -mass * az
                        else:
                            if not AS_ASSIGNED:
                                side = FluidSide(
                                    rows[i, COLUMNS.pressure], rows[i, COLUMNS.density], rows[i, COLUMNS.u],
                                    rows[i, COLUMNS.v], rows[i, COLUMNS.w] if DIM == 3 else 0.0,
                                )  # fmt: skip
                                seen = SEEN(side, wall, separation, parameters)
                                pressures = seen.pressure_sum
                                u, v, w = seen.viscous_u, seen.viscous_v, seen.viscous_w
                            approach = (u - rows[i, COLUMNS.u]) * dx + (v - rows[i, COLUMNS.v]) * dy
                            if DIM == 3:
                                approach += (w - rows[i, COLUMNS.w]) * dz
                            weight = parameters.gradient_scale * GRADIENT(r2 * per_h2)
                            weight *= rows[i, COLUMNS.volume] * source[row, COLUMNS.volume]
                            stress = weight * pair_stress(pressures, parameters.viscosity, approach, r2)
                            fx, fy, fz = stress * dx, stress * dy, stress * dz if DIM == 3 else 0.0
                            if MORRIS:
                                friction = weight * parameters.friction
                                fx += friction * (u - rows[i, COLUMNS.u])
                                fy += friction * (v - rows[i, COLUMNS.v])
                                if DIM == 3:
                                    fz += friction * (w - rows[i, COLUMNS.w])
                        if MASKED:
                            share = PER_WHOLE * seen_shares[c, k, i - c * LANES]
                            fx, fy, fz = share * fx, share * fy, share * fz
                        other = shares.wall[g]
                        if other >= 0:
                            along = fx * shares.dual[g, 0] + fy * shares.dual[g, 1]
                            ox, oy = along * shares.normal[g, 0], along * shares.normal[g, 1]
                            fx, fy = fx - ox, fy - oy
                            add_load(partial[chunk, other], rows[i], centres[other], ox, oy, 0.0)
                        add_load(partial[chunk, ghost_walls[g]], rows[i], centres[ghost_walls[g]], fx, fy, fz)
