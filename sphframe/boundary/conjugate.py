"""Boundary: velocities of ghosts, corrected so that walls do no spurious work, for the mirror lift.

The velocity of a ghost enters the continuity equation of the fluid, its pressure the momentum equation. In a uniform
pressure p the power of the two sums over the ghosts is p times::

    sum_G V_G sum_j V_j grad_j W_jG.[(u_j - u_wall) + (u_G - u_wall)]

which should vanish: it is the rate at which a wall at rest produces or destroys mechanical energy. Q = (1 - S)/2 is the
projection on the components of the velocity that the wall reverses (S as in :mod:`sphframe.boundary.ghosts`). The
velocity that the method interpolates is changed as little as possible so that the part of these components vanishes
from the sum of each ghost::

    u_G <- u_G - (b / a.a) a,    a = sum_j V_j Q grad_j W_jG,    b = sum_j V_j (Q grad_j W_jG).(u_j + u_G - 2 u_wall)

Near one plane face, with free slip, this does not change the tangential velocity. The normal velocity relative to the
wall becomes -sum_j omega_j u_j.n with omega_j = V_j dW_jG/dn over their sum: an average over the same neighbours, with
positive weights that sum to one for every method. Nothing is corrected where the gradients nearly cancel.

Reason: under a pressure p neighbouring layers of particles oscillate against each other with a frequency of about
sqrt(p/rho)/dx, which is in the range of the sound waves. With the mirror lift, weights that do not reproduce a linear
field give the ghosts below a bed too low a pressure. The first layers are then displaced in proportion to the missing
pressure over p, so that an oscillation of p moves them against each other. Weights as wide as the kernel do not resolve
this motion, the velocity of the ghosts does not follow it, and the power above does not vanish: while viscosity and
diffusion damp the motion of the layers, sound gains energy (in the tank at rest, with the normalised method, its
amplitude grew by a factor of e in 1.7 s). With the balanced lift no pressure is missing, and there is no correction.

Departs from the paper, where the ghosts have the velocity that the method interpolates; a case does so with
``ghost_velocity = "interpolated"``, as all presets named ``paper`` do.
"""

import math

import numba

from sphframe.compiled import local_array, nearest
from sphframe.compiled.stand_ins import COLUMNS, DIM, GRADIENT, PERIODIC, SUPPORT

CANCELLED = 0.1
"""|a| over the sum of |V_j grad W| below which there is no correction; near one plane face it is at least dx/(2 R)"""


def make_conjugate(  # type: ignore[no-untyped-def]
    rows, fluid_count, ghosts, lists, counts, reflections, wall_velocities, parameters
):
    """Correct the velocities of the ``ghosts`` (k,), rows ``fluid_count + ghosts``; see :func:`fill_ghosts`."""
    limit = parameters.support * parameters.support
    per_h2 = SUPPORT * SUPPORT / limit
    for place in numba.prange(counts.shape[0]):
        g = ghosts[place]
        offset = local_array(DIM)
        row = fluid_count + g
        ax = ay = az = 0.0
        power = 0.0
        total = 0.0
        for k in range(counts[place]):
            j = lists[place, k]
            r2 = 0.0
            for d in range(DIM):
                offset[d] = rows[j, d] - rows[row, d]
                if PERIODIC:
                    offset[d] = nearest(offset[d], parameters, d)
                r2 += offset[d] ** 2
            if r2 < limit:
                weight = -GRADIENT(r2 * per_h2) * rows[j, COLUMNS.volume]
                total += weight * math.sqrt(r2)
                for d in range(DIM):
                    side = offset[d]
                    for e in range(DIM):
                        side -= reflections[g, d, e] * offset[e]
                    side *= 0.5 * weight
                    power += side * (rows[j, COLUMNS.u + d] + rows[row, COLUMNS.u + d] - 2.0 * wall_velocities[g, d])
                    if d == 0:
                        ax += side
                    elif d == 1:
                        ay += side
                    else:
                        az += side
        square = ax * ax + ay * ay + az * az
        if square > (CANCELLED * total) ** 2:
            rows[row, COLUMNS.u] -= power / square * ax
            rows[row, COLUMNS.v] -= power / square * ay
            if DIM == 3:
                rows[row, COLUMNS.w] -= power / square * az
