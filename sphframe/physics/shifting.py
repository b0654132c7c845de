"""Physics: particle shifting, and the control of the tensile instability.

::

    du_i = -2 h U sum_j [1 + 0.2 (W_ij / W(dx))^4] grad_i W_ij V_j,    |du_i| <= U / 2
    x_i  = x_i + S du_i dt

over fluid and ghosts, at the end of each step, with the largest speed U of the fluid and the coefficient S: particles
move from where they are dense to where they are sparse. A full lattice is not moved.

The smallest eigenvalue e_i of sum_j x_ji (x) grad_i W_ij V_j is about 1 within the fluid and 1/2 at a free surface. A
particle with e_i < 0.4 is not shifted. One that has a neighbour in its support with e_j < 0.75 is near a free surface:
it is not shifted along n_i = -grad e / |grad e|, so that the surface is not blurred.

A shifted particle takes the density and the velocity of its new place, where ghosts have du = 0::

    D rho_i / Dt = sum_j [(rho_j du_j + rho_i du_i) - rho_i (du_j - du_i)] . grad_i W_ij V_j
    D u_i / Dt   = sum_j [(u_j du_j + u_i du_i) - u_i (du_j - du_i)] . grad_i W_ij V_j

Both are about du . grad. Without them the density of a full vessel grows: flow crowds the particles along lines, by
which the equation of continuity raises their density, and shifting would spread them and leave their density as it is.

Control of the tensile instability: where p_i < 0 and no free surface is near, the pair takes p_j - p_i in place of
p_i + p_j, which adds (2 p_i / rho_i) sum_j grad_i W_ij V_j to the acceleration.

Neither conserves momentum exactly: the sums of both are not antisymmetric.
The reaction on walls does not contain the second.

Source: P. N. Sun, A. Colagrossi, S. Marrone, A. M. Zhang (2017), doi:10.1016/j.cma.2016.10.028, with the velocity of
the consistent form of P. N. Sun et al. (2019), doi:10.1016/j.cma.2019.03.002; P. N. Sun et al. (2018),
doi:10.1016/j.cpc.2017.11.016.
"""

import math

import numba
import numpy as np

from sphframe.arrays import Array
from sphframe.compiled import LANES, local_array, offset_between
from sphframe.compiled.stand_ins import COLUMNS, DIM, GRADIENT, MASKED, PERIODIC, SUPPORT, VALUE
from sphframe.neighbours.sight import WHOLE

PER_WHOLE = 1.0 / WHOLE
SPRAY = 0.4
"""eigenvalue below which a particle is not shifted"""
SURFACE = 0.75
"""eigenvalue below which a particle is at a free surface"""


@numba.njit(error_model="numpy", forceinline=True)
def smallest_eigenvalue(xx, xy, yy, xz, yz, zz):  # type: ignore[no-untyped-def]
    """Return the smallest eigenvalue of a symmetric matrix; that of the plane where ``zz`` is negative."""
    if zz < 0.0:
        half = 0.5 * (xx - yy)
        return 0.5 * (xx + yy) - math.sqrt(half * half + xy * xy)
    mean = (xx + yy + zz) / 3.0
    a, b, c = xx - mean, yy - mean, zz - mean
    p = math.sqrt((a * a + b * b + c * c + 2.0 * (xy * xy + xz * xz + yz * yz)) / 6.0)
    if p <= 0.0:
        return mean
    determinant = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)
    cosine = min(max(0.5 * determinant / (p * p * p), -1.0), 1.0)
    return mean + 2.0 * p * math.cos(math.acos(cosine) / 3.0 + 2.0 * math.pi / 3.0)


def fluid_fillings(  # type: ignore[no-untyped-def]
    rows, lists, fluid_counts, ghost_counts, shares, parameters, eigenvalues, sums, crowding
):
    """Write e (n,), sum_j grad W V (n, 3), and the sum of the shift (n, 3), for the fluid particles."""
    limit = parameters.support * parameters.support
    per_h2 = SUPPORT * SUPPORT / limit
    per_h = SUPPORT / parameters.support
    at_spacing = VALUE(parameters.spacing * per_h)
    n = eigenvalues.shape[0]
    for c in numba.prange(fluid_counts.shape[0]):
        xx, xy, yy = local_array(LANES), local_array(LANES), local_array(LANES)
        xz, yz, zz = local_array(LANES), local_array(LANES), local_array(LANES)
        sx, sy, sz = local_array(LANES), local_array(LANES), local_array(LANES)
        cx, cy, cz = local_array(LANES), local_array(LANES), local_array(LANES)
        for a in range(LANES):
            xx[a] = xy[a] = yy[a] = xz[a] = yz[a] = zz[a] = 0.0
            sx[a] = sy[a] = sz[a] = cx[a] = cy[a] = cz[a] = 0.0
        for k in range(fluid_counts[c] + ghost_counts[c]):
            j = lists[c, k]
            scale = -parameters.gradient_scale * rows[j, COLUMNS.volume]
            for a in range(LANES):
                i = min(c * LANES + a, n - 1)
                dx, dy, dz, r2 = offset_between(rows, j, rows, i, DIM, PERIODIC, parameters)
                weight = GRADIENT(r2 * per_h2) * scale
                near = VALUE(math.sqrt(r2) * per_h) / at_spacing
                crowded = weight * (1.0 + 0.2 * near * near * near * near)
                weight, crowded = (weight, crowded) if r2 < limit else (0.0, 0.0)
                if MASKED:
                    seen = PER_WHOLE * shares[c, k, a]
                    weight, crowded = weight * seen, crowded * seen
                sx[a] += weight * dx
                sy[a] += weight * dy
                cx[a] += crowded * dx
                cy[a] += crowded * dy
                xx[a] += weight * dx * dx
                xy[a] += weight * dx * dy
                yy[a] += weight * dy * dy
                if DIM == 3:
                    sz[a] += weight * dz
                    cz[a] += crowded * dz
                    xz[a] += weight * dx * dz
                    yz[a] += weight * dy * dz
                    zz[a] += weight * dz * dz
        for a in range(min(LANES, n - c * LANES)):
            i = c * LANES + a
            eigenvalues[i] = smallest_eigenvalue(xx[a], xy[a], yy[a], xz[a], yz[a], zz[a] if DIM == 3 else -1.0)
            sums[i, 0], sums[i, 1], sums[i, 2] = sx[a], sy[a], sz[a]
            crowding[i, 0], crowding[i, 1], crowding[i, 2] = cx[a], cy[a], cz[a]


def surface_normals(  # type: ignore[no-untyped-def]
    rows, lists, fluid_counts, shares, parameters, eigenvalues, normals
):
    """Write the normal out of a free surface (n, 3) for particles near one, and zero within the fluid."""
    limit = parameters.support * parameters.support
    per_h2 = SUPPORT * SUPPORT / limit
    for i in numba.prange(eigenvalues.shape[0]):
        c = i // LANES
        own = eigenvalues[i]
        lowest = own
        gx = gy = gz = 0.0
        for k in range(fluid_counts[c]):
            j = lists[c, k]
            dx, dy, dz, r2 = offset_between(rows, j, rows, i, DIM, PERIODIC, parameters)
            seen = r2 < limit
            if MASKED:
                seen = seen and shares[c, k, i - c * LANES] > 0
            if seen:
                lowest = min(lowest, eigenvalues[j])
                rise = GRADIENT(r2 * per_h2) * rows[j, COLUMNS.volume] * (eigenvalues[j] - own)
                gx += rise * dx  # along -grad e: the gradient of the kernel points from j to i
                gy += rise * dy
                gz += rise * dz
        size = math.sqrt(gx * gx + gy * gy + gz * gz)
        scale = 1.0 / size if lowest < SURFACE and size > 0.0 else 0.0
        normals[i, 0], normals[i, 1], normals[i, 2] = scale * gx, scale * gy, scale * gz


def shift_velocities(eigenvalues: Array, crowding: Array, normals: Array, length: float, speed: float) -> Array:
    """Return du (n, 3), m/s, of the sums ``crowding`` (n, 3); ``length`` h, m, and the largest ``speed`` U, m/s."""
    velocity = np.where(eigenvalues >= SPRAY, -2.0 * length * speed, 0.0)[:, None] * crowding
    velocity -= np.einsum("ij,ij->i", velocity, normals)[:, None] * normals
    size = np.linalg.norm(velocity, axis=1)
    limited: Array = velocity * np.minimum(1.0, 0.5 * speed / np.maximum(size, 1e-300))[:, None]
    return limited


def transported(  # type: ignore[no-untyped-def]
    rows, lists, fluid_counts, ghost_counts, shares, parameters, shifts, changes
):
    """Write the rates of velocity (3) and density at the velocities ``shifts`` (n, 3) to ``changes`` (n, 4)."""
    n = shifts.shape[0]
    limit = parameters.support * parameters.support
    per_h2 = SUPPORT * SUPPORT / limit
    for c in numba.prange(fluid_counts.shape[0]):
        du, dv, dw, rate = local_array(LANES), local_array(LANES), local_array(LANES), local_array(LANES)
        for a in range(LANES):
            du[a] = dv[a] = dw[a] = rate[a] = 0.0
        for k in range(fluid_counts[c] + ghost_counts[c]):
            j = lists[c, k]
            scale = -parameters.gradient_scale * rows[j, COLUMNS.volume]
            m, moves = (j, scale) if j < n else (0, 0.0)
            sx, sy, sz = moves * shifts[m, 0], moves * shifts[m, 1], moves * shifts[m, 2]
            density_j, uj, vj = rows[j, COLUMNS.density], rows[j, COLUMNS.u], rows[j, COLUMNS.v]
            for a in range(LANES):
                i = min(c * LANES + a, n - 1)
                dx, dy, dz, r2 = offset_between(rows, j, rows, i, DIM, PERIODIC, parameters)
                weight = GRADIENT(r2 * per_h2)
                weight = weight if r2 < limit else 0.0
                if MASKED:
                    weight *= PER_WHOLE * shares[c, k, a]
                own = 2.0 * scale * weight * (shifts[i, 0] * dx + shifts[i, 1] * dy + shifts[i, 2] * dz)
                other = weight * (sx * dx + sy * dy + sz * dz)
                density, u, v = rows[i, COLUMNS.density], rows[i, COLUMNS.u], rows[i, COLUMNS.v]
                rate[a] += (density_j - density) * other + density * own
                du[a] += (uj - u) * other + u * own
                dv[a] += (vj - v) * other + v * own
                if DIM == 3:
                    w = rows[i, COLUMNS.w]
                    dw[a] += (rows[j, COLUMNS.w] - w) * other + w * own
        for a in range(min(LANES, n - c * LANES)):
            i = c * LANES + a
            changes[i, 0], changes[i, 1], changes[i, 2], changes[i, 3] = du[a], dv[a], dw[a], rate[a]
