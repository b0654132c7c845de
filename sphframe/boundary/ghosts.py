"""Boundary: interpolates the fluid to the ghosts and assigns what the treatment of the walls makes of it.

Each ghost has an evaluation point r, its mirror point x_M or its own position, to which the fluid is interpolated with
the weights Phi_j of a method; a point without neighbours is DRY. The treatment turns the means of pressure, velocity
and position into pressure p_G and velocities of the ghost, and into the share of its volume with which it counts. Then
the tension policy of the case applies (p_0 is the case's ``lowest_pressure``)::

    bounded   p_G := max(p_G, p_0)
    free      p_G as it is
    none      V_G := V_G max(S[(phi - 0.35)/0.3], S[p_G/p_1]),    p_G := max(p_G, 0),
              phi = sum_j V_j W(x_j - r) / phi_0,    p_1 = 0.01 rho0 c0^2

with the smooth step S(t) = 3 t^2 - 2 t^3 of 0 <= t <= 1. phi_0 is the value of the sum where fluid fills the domain. On
a level free surface phi = 1/2, whatever the distance from the wall, so that no ghost acts on fluid from above the
surface. A pair of fluid and ghost then acts only where p_i > 0 and p_i + p_G > 0: it does not attract, has no
viscosity, and a gap that opens does not lower the density, so that the fluid may leave the wall
(:mod:`sphframe.physics.wall_pair`). Without p_1, a particle that is pressed into a corner, such as that between a
paddle and the bed, pushes its neighbours away; the ghosts around it would then fade, nothing would balance the pressure
of the fluid, and the particle would be compressed further.

The density follows from the inverse equation of state.
"""

import math
from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from sphframe.arrays import Array
from sphframe.boundary.wall_arrays import wall_point
from sphframe.compiled import borrowed, local_array, nearest
from sphframe.compiled.stand_ins import ASSIGN, COLUMNS, DENSITY, DIM, FALLBACK, PERIODIC, SUPPORT, VALUE, WEIGHTS
from sphframe.interfaces import Interpolated
from sphframe.interfaces.traits import DRY, OK

# parts bound by specialise()
INTERPOLATES = True
EXTRAPOLATED = DIRECTED = SEPARATE = False
BY_KERNEL = True
"""whether the weights depend on the values of the kernel; else these are computed only for a fallback"""
VELOCITY_WEIGHTS = VELOCITY_FALLBACK = WEIGHTS
VELOCITIES = True
"""whether the treatment uses the fluid's velocity; else those of EXTRAPOLATED weights are not computed again"""
SEEN_ENOUGH = 0.05
"""filling of the evaluation point in the midst of the fluid below which it says nothing, far behind a wall"""
FADED = 0.35
"""filling at the evaluation point, over that in the midst of the fluid, at which a ghost that fades has no share"""
PRESSED = 0.01
"""pressure of a ghost, over rho0 c0^2, from which it does not fade: water that presses on a wall needs it"""

CHUNKS = 8 * int(numba.config.NUMBA_NUM_THREADS)  # type: ignore[attr-defined]
"""number of parts of the loops over ghosts, each with scratch memory of its own"""
BLOCK = 16
"""number of consecutive ghosts, whose neighbours are mostly the same, that a thread computes in one go"""


class Scratch(NamedTuple):
    """Memory for the neighbourhoods of ghosts, one per chunk of the loop of :func:`fill_ghosts`.

    Attributes
    ----------
    offsets
        (chunks, capacity, dim), m.
    columns
        (chunks, 4, capacity): distances, kernel values, volumes and weights.
    members
        (chunks, capacity), row of each neighbour.
    lift
        (chunks, dim), m.
    """

    offsets: Array
    columns: Array
    members: NDArray[np.uint32]
    lift: Array

    @classmethod
    def of(cls, capacity: int, dim: int) -> "Scratch":
        """Return memory for neighbourhoods of up to ``capacity`` particles."""
        return cls(
            np.zeros((CHUNKS, capacity, dim)),
            np.zeros((CHUNKS, 4, capacity)),
            np.zeros((CHUNKS, capacity), np.uint32),
            np.zeros((CHUNKS, dim)),
        )


@numba.njit(error_model="numpy", forceinline=True)
def _step(t):  # type: ignore[no-untyped-def]
    """Return the smooth step S(t), 0 for t < 0 and 1 for t > 1."""
    t = min(max(t, 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)


def fill_ghosts(  # type: ignore[no-untyped-def]
    rows, fluid_count, ghosts, lists, counts, points, lifts, walls, parameters, scratch, statuses
):
    """Interpolate to ``points`` (g, dim) and assign the ``ghosts`` (k,), rows ``fluid_count + ghosts``.

    ``lists`` (k, capacity) and ``counts`` (k,): the fluid near the evaluation point of each of them.

    ``lifts`` (g, dim): from evaluation point to ghost, m; ``walls``: :class:`WallArrays`; ``parameters`` are
    :class:`LoopParameters`, ``scratch`` is a :class:`Scratch`. ``statuses`` (g,) is written.
    """
    support = parameters.support
    limit = support * support
    per_h = SUPPORT / support
    fades = INTERPOLATES and parameters.fading_pressure > 0.0
    count = ghosts.shape[0]
    chunks = scratch.offsets.shape[0]
    blocks = -(-count // BLOCK)
    for chunk in numba.prange(chunks):
        offsets = borrowed(scratch.offsets[chunk])
        columns = borrowed(scratch.columns[chunk])
        distances = columns[0]
        values = columns[1]
        volumes = columns[2]
        weights = columns[3]
        members = scratch.members[chunk]
        lift = borrowed(scratch.lift[chunk])
        mean_offset = local_array(DIM)
        mean_velocity = local_array(DIM)
        for block in range(chunk, blocks, chunks):  # wet ghosts are consecutive: each chunk gets some
            for place in range(block * BLOCK, min((block + 1) * BLOCK, count)):
                g = ghosts[place]
                status = OK
                n = 0
                extrapolated = 0.0
                if INTERPOLATES:
                    status = DRY
                    px = points[g, 0]
                    py = points[g, 1]
                    pz = points[g, COLUMNS.z]
                    for k in range(counts[place]):
                        j = lists[place, k]
                        dx = rows[j, 0] - px
                        dy = rows[j, 1] - py
                        if PERIODIC:
                            dx = nearest(dx, parameters, 0)
                            dy = nearest(dy, parameters, 1)
                        r2 = dx * dx + dy * dy
                        if DIM == 3:
                            dz = rows[j, 2] - pz
                            if PERIODIC:
                                dz = nearest(dz, parameters, 2)
                            r2 += dz * dz
                        offsets[n, 0] = dx
                        offsets[n, 1] = dy
                        if DIM == 3:
                            offsets[n, 2] = dz
                        distances[n] = math.sqrt(r2)
                        volumes[n] = rows[j, COLUMNS.volume]
                        members[n] = j
                        n += 1 if r2 < limit else 0  # else it is overwritten: faster than a branch
                    if BY_KERNEL or fades:
                        for k in range(n):
                            values[k] = parameters.kernel_scale * VALUE(distances[k] * per_h)
                    around = offsets[:n], distances[:n], values[:n], volumes[:n]
                    if n > 0:
                        for d in range(DIM):
                            lift[d] = 0.0
                            if EXTRAPOLATED:
                                lift[d] = lifts[g, d]
                            if DIRECTED:
                                lift[d] = walls.normal[g, d]
                        status = WEIGHTS(*around, support, lift, weights[:n])
                        if status != OK:
                            if not (BY_KERNEL or fades):
                                for k in range(n):
                                    values[k] = parameters.kernel_scale * VALUE(distances[k] * per_h)
                            FALLBACK(*around, support, lift, weights[:n])
                        elif EXTRAPOLATED:
                            for k in range(n):
                                extrapolated += weights[k] * rows[members[k], COLUMNS.pressure]
                            for d in range(DIM):
                                lift[d] = 0.0
                            if VELOCITIES and WEIGHTS(*around, support, lift, weights[:n]) != OK:
                                FALLBACK(*around, support, lift, weights[:n])
                statuses[g] = status

                total = 0.0
                pressure = 0.0
                for d in range(DIM):
                    mean_offset[d] = 0.0
                    mean_velocity[d] = 0.0
                for k in range(n):
                    j = members[k]
                    total += weights[k]
                    pressure += weights[k] * rows[j, COLUMNS.pressure]
                    for d in range(DIM):
                        mean_offset[d] += weights[k] * offsets[k, d]
                        mean_velocity[d] += weights[k] * rows[j, COLUMNS.u + d]
                if SEPARATE and n > 0:
                    for d in range(DIM):
                        lift[d] = walls.normal[g, d] if DIRECTED else 0.0
                        mean_velocity[d] = 0.0
                    if VELOCITY_WEIGHTS(*around, support, lift, weights[:n]) != OK:
                        VELOCITY_FALLBACK(*around, support, lift, weights[:n])
                    for k in range(n):
                        for d in range(DIM):
                            mean_velocity[d] += weights[k] * rows[members[k], COLUMNS.u + d]
                at_ghost = EXTRAPOLATED and n > 0 and status == OK
                if at_ghost:
                    pressure = extrapolated

                row = fluid_count + g
                fluid = Interpolated(status, n, total, pressure, at_ghost, mean_offset, mean_velocity)
                wall = wall_point(walls, lifts, g)
                velocity = rows[row, COLUMNS.u : COLUMNS.u + DIM]
                pressure, share = ASSIGN(fluid, wall, parameters, velocity, walls.viscous_velocity[g])
                if fades and walls.full[g] > SEEN_ENOUGH:
                    filling = 0.0
                    for k in range(n):
                        filling += values[k] * volumes[k]
                    filled = _step((filling / walls.full[g] - FADED) / (1.0 - 2.0 * FADED))
                    share *= max(filled, _step(pressure / parameters.fading_pressure))
                pressure = max(pressure, parameters.lowest_pressure)
                rows[row, COLUMNS.volume] = share * walls.volume[g]
                rows[row, COLUMNS.density] = DENSITY(pressure, parameters.reference_density, parameters.sound_speed)
                rows[row, COLUMNS.pressure] = pressure
