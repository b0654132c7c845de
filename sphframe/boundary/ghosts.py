"""Boundary: fixed ghost particles in three steps: mirror (geometry), interpolate, assign.

Each ghost has an evaluation point r, its mirror point x_M or its own position, to which the fluid is interpolated with
the weights Phi_j of the method. With the driving force rho0 (f - a_wall) of the pressure condition
dp/dn = rho (f - a_wall).n the ghost is assigned::

    balanced lift   p_G = sum_j Phi_j [p_j + rho0 (f - a_wall).(x_G - x_j)]
    mirror lift     p_G = sum_j Phi_j p_j + rho0 (f - a_wall).(x_G - x_M)
    velocity        u_G = u_wall + [(1 - s)/2 + (1 + s)/2 S] (sum_j Phi_j u_j - u_wall)

S is the reflection of the wall for free slip and -1 for no slip: it keeps some components of the relative velocity
and reverses the others, which vanish at the wall. With the balanced lift and ``ghost_velocity = "corrected"`` the
reversed components are scaled by s = d / sum_j Phi_j d_j, where d is the distance from the wall along its normal at the
foot of the ghost. This is exact for a velocity that grows linearly from the wall, for any weights that sum to one. In
all other cases, and where the method evaluates at the ghost, s = 1; for the correction with the mirror lift see
:mod:`sphframe.boundary.conjugate`. Negative pressures are clipped to zero. The density follows from the inverse
equation of state. A point without neighbours is DRY: p_G = 0, u_G = u_wall.

Reason for s: weights of zeroth order sample the fluid at a larger distance from the wall than that of the mirror point.
Without s the normal velocity of the ghosts is too large, the divergence at the wall is wrong, and the pressure of the
first layer drifts (in the tank at rest with the normalised method by 1.5 % of rho g H).

Departs from the paper: its pressure condition lacks the acceleration of the wall. The balanced lift, which is exact on
a hydrostatic field for any weights that sum to one, and s are additions. Negative pressures are clipped because they
draw particles of thin jets through the wall (dam break at H/30: three particles; with the clipping none). A method that
evaluates at the ghost always uses the balanced lift, since the mirror lift over a distance of zero is zero; a method
that extrapolates uses none.

Source: X. Huang et al. (2019), doi:10.3390/w11051110, section 2.2 and Eqs. 8, 13, 16, 21.
"""

import math
from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from sphframe.arrays import Array
from sphframe.compiled import local_array
from sphframe.compiled.stand_ins import COLUMNS, DENSITY, DIM, FALLBACK, SUPPORT, VALUE, WEIGHTS
from sphframe.interfaces.traits import DRY, OK

# parts bound by specialise()
BALANCED = True
SCALED = True
EXTRAPOLATED = False

BLOCK = 16
"""number of consecutive ghosts, whose neighbours are mostly the same, that a thread computes in one go"""


class Scratch(NamedTuple):
    """Memory for the neighbourhoods of ghosts, one per chunk of the loop of :func:`fill_ghosts`.

    Attributes
    ----------
    offsets: (chunks, capacity, dim), m.
    columns: (chunks, 4, capacity): distances, kernel values, volumes and weights.
    members: (chunks, capacity), row of each neighbour.
    lift: (chunks, dim), m.
    """

    offsets: Array
    columns: Array
    members: NDArray[np.uint32]
    lift: Array

    @classmethod
    def of(cls, capacity: int, dim: int) -> "Scratch":
        """Return memory for neighbourhoods of up to ``capacity`` particles."""
        chunks = 8 * int(numba.config.NUMBA_NUM_THREADS)  # type: ignore[attr-defined]
        return cls(
            np.zeros((chunks, capacity, dim)),
            np.zeros((chunks, 4, capacity)),
            np.zeros((chunks, capacity), np.uint32),
            np.zeros((chunks, dim)),
        )


def fill_ghosts(  # type: ignore[no-untyped-def]
    rows, fluid_count, lists, counts, points, lifts, normals, depths, heights, reflections, wall_velocities,
    driving_forces, parameters, scratch, statuses,
):  # fmt: skip
    """Interpolate to ``points`` (g, dim) and assign the ghosts, rows ``fluid_count`` .. ``fluid_count + g``.

    ``lifts`` (g, dim): from evaluation point to ghost, m; ``normals`` (g, dim), ``depths`` (g,), ``heights`` (g,),
    ``reflections`` (g, dim, dim), ``wall_velocities`` (g, dim): see :class:`~sphframe.boundary.boundary.Boundary`;
    ``driving_forces`` (g, dim): rho0 (f - a_wall), N/m^3; ``parameters`` are :class:`LoopParameters`, ``scratch`` is a
    :class:`Scratch`. ``statuses`` (g,) is written.
    """
    support = parameters.support
    limit = support * support
    per_h = SUPPORT / support
    ghosts = points.shape[0]
    chunks = scratch.offsets.shape[0]
    blocks = -(-ghosts // BLOCK)
    for chunk in numba.prange(chunks):
        offsets = scratch.offsets[chunk]
        distances = scratch.columns[chunk, 0]
        values = scratch.columns[chunk, 1]
        volumes = scratch.columns[chunk, 2]
        weights = scratch.columns[chunk, 3]
        members = scratch.members[chunk]
        lift = scratch.lift[chunk]
        mean_offset = local_array(DIM)
        mean_velocity = local_array(DIM)
        for block in range(chunk, blocks, chunks):  # wet ghosts are consecutive: each chunk gets some
            for g in range(block * BLOCK, min((block + 1) * BLOCK, ghosts)):
                px = points[g, 0]
                py = points[g, 1]
                pz = points[g, COLUMNS.z]
                n = 0
                for k in range(counts[g]):
                    j = lists[g, k]
                    dx = rows[j, 0] - px
                    dy = rows[j, 1] - py
                    r2 = dx * dx + dy * dy
                    if DIM == 3:
                        dz = rows[j, 2] - pz
                        r2 += dz * dz
                    offsets[n, 0] = dx
                    offsets[n, 1] = dy
                    if DIM == 3:
                        offsets[n, 2] = dz
                    distances[n] = r2
                    volumes[n] = rows[j, COLUMNS.volume]
                    members[n] = j
                    n += 1 if r2 < limit else 0  # else it is overwritten: faster than a branch
                for k in range(n):
                    distances[k] = math.sqrt(distances[k])
                    values[k] = parameters.kernel_scale * VALUE(distances[k] * per_h)

                status = DRY
                extrapolated = 0.0
                if n > 0:
                    for d in range(DIM):
                        lift[d] = lifts[g, d] if EXTRAPOLATED else 0.0
                    status = WEIGHTS(
                        offsets[:n], distances[:n], values[:n], volumes[:n], support, lift, weights[:n]
                    )  # fmt: skip
                    if status != OK:
                        FALLBACK(offsets[:n], distances[:n], values[:n], volumes[:n], support, lift, weights[:n])
                    elif EXTRAPOLATED:
                        for k in range(n):
                            extrapolated += weights[k] * rows[members[k], COLUMNS.pressure]
                        for d in range(DIM):
                            lift[d] = 0.0
                        WEIGHTS(offsets[:n], distances[:n], values[:n], volumes[:n], support, lift, weights[:n])
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
                if EXTRAPOLATED and status == OK:
                    pressure = extrapolated
                elif BALANCED:
                    for d in range(DIM):
                        pressure += driving_forces[g, d] * (total * lifts[g, d] - mean_offset[d])
                elif n > 0:
                    for d in range(DIM):
                        pressure += driving_forces[g, d] * lifts[g, d]
                pressure = max(pressure, 0.0)

                slope = 1.0  # s of the module's docstring; d_j is the height of r less (x_j - r).n
                if SCALED and n > 0:
                    distance = total * heights[g]
                    for d in range(DIM):
                        distance -= mean_offset[d] * normals[g, d]
                    slope = depths[g] / max(distance, 0.5 * heights[g])

                row = fluid_count + g
                for d in range(DIM):
                    rows[row, COLUMNS.u + d] = wall_velocities[g, d]
                for e in range(DIM if n > 0 else 0):
                    relative = mean_velocity[e] - wall_velocities[g, e]
                    rows[row, COLUMNS.u + e] += 0.5 * (1.0 - slope) * relative
                    for d in range(DIM):
                        rows[row, COLUMNS.u + d] += 0.5 * (1.0 + slope) * reflections[g, d, e] * relative
                rows[row, COLUMNS.density] = DENSITY(pressure, parameters.reference_density, parameters.sound_speed)
                rows[row, COLUMNS.pressure] = pressure
