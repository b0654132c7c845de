"""Physics: particle shifting, and the control of the tensile instability.

::

    du_i = -2 h U sum_j [1 + 0.2 (W_ij / W(dx))^4] grad_i W_ij V_j,    |du_i| <= U / 2
    x_i  = x_i + S du_i dt

over fluid and ghosts, at the end of each step, with the largest speed U of the fluid and the coefficient S: particles
move from where they are dense to where they are sparse. A full lattice is not moved.

The smallest eigenvalue e_i of sum_j x_ji (x) grad_i W_ij V_j is about 1 within the fluid and 1/2 at a free surface. A
particle with e_i < 0.4 is not shifted. One that has a neighbour in its support with e_j < 0.75 is near a free surface:
it is not shifted along n_i = -grad e / |grad e|, so that the surface is not blurred.

Control of the tensile instability: where p_i < 0 and no free surface is near, the pair takes p_j - p_i in place of
p_i + p_j, which adds (2 p_i / rho_i) sum_j grad_i W_ij V_j to the acceleration.

Neither conserves momentum exactly: shifted particles carry their velocity along, and the second is not antisymmetric.
The reaction on walls does not contain the second.

Source: P. N. Sun, A. Colagrossi, S. Marrone, A. M. Zhang (2017), doi:10.1016/j.cma.2016.10.028, with the velocity of
P. N. Sun et al. (2019), doi:10.1016/j.cma.2019.03.002, Eq. 9; P. N. Sun et al. (2018), doi:10.1016/j.cpc.2017.11.016.
"""

import math

import numba

from sphframe.compiled import LANES, offset_between
from sphframe.compiled.stand_ins import COLUMNS, DIM, GRADIENT, MASKED, PERIODIC, SUPPORT, VALUE
from sphframe.neighbours.sight import WHOLE

PER_WHOLE = 1.0 / WHOLE
SPRAY = 0.4
"""eigenvalue below which a particle is not shifted"""
SURFACE = 0.75
"""eigenvalue below which a particle is at a free surface"""


@numba.njit(inline="always")
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
    for i in numba.prange(eigenvalues.shape[0]):
        c = i // LANES
        xx = xy = yy = xz = yz = zz = 0.0
        sx = sy = sz = cx = cy = cz = 0.0
        for k in range(fluid_counts[c] + ghost_counts[c]):
            j = lists[c, k]
            dx, dy, dz, r2 = offset_between(rows, j, rows, i, DIM, PERIODIC, parameters)
            if r2 < limit and r2 > 0.0:
                weight = -parameters.gradient_scale * rows[j, COLUMNS.volume] * GRADIENT(r2 * per_h2)
                if MASKED:
                    weight *= PER_WHOLE * shares[c, k, i - c * LANES]
                near = VALUE(math.sqrt(r2) * per_h) / at_spacing
                crowded = weight * (1.0 + 0.2 * near * near * near * near)
                sx += weight * dx
                sy += weight * dy
                sz += weight * dz
                cx += crowded * dx
                cy += crowded * dy
                cz += crowded * dz
                xx += weight * dx * dx
                xy += weight * dx * dy
                yy += weight * dy * dy
                xz += weight * dx * dz
                yz += weight * dy * dz
                zz += weight * dz * dz
        eigenvalues[i] = smallest_eigenvalue(xx, xy, yy, xz, yz, zz if DIM == 3 else -1.0)
        sums[i, 0], sums[i, 1], sums[i, 2] = sx, sy, sz
        crowding[i, 0], crowding[i, 1], crowding[i, 2] = cx, cy, cz


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


def shift_particles(rows, parameters, eigenvalues, crowding, normals, speed, interval):  # type: ignore[no-untyped-def]
    """Move the fluid particles during ``interval`` (s), S dt, at most with half of the largest ``speed``, m/s."""
    for i in numba.prange(eigenvalues.shape[0]):
        if eigenvalues[i] < SPRAY:
            continue
        factor = -2.0 * parameters.smoothing_length * speed
        nx, ny, nz = normals[i, 0], normals[i, 1], normals[i, 2]
        u, v, w = factor * crowding[i, 0], factor * crowding[i, 1], factor * crowding[i, 2]
        along = u * nx + v * ny + w * nz
        u -= along * nx
        v -= along * ny
        w -= along * nz
        size = math.sqrt(u * u + v * v + w * w)
        scale = interval * min(1.0, 0.5 * speed / size) if size > 0.0 else 0.0
        rows[i, 0] += scale * u
        rows[i, 1] += scale * v
        if DIM == 3:
            rows[i, 2] += scale * w


def control_tension(rows, eigenvalues, sums, normals, rates):  # type: ignore[no-untyped-def]
    """Add the control of the tensile instability to the accelerations in ``rates`` (n, 2 dim + 1)."""
    for i in numba.prange(eigenvalues.shape[0]):
        pressure = rows[i, COLUMNS.pressure]
        near_surface = normals[i, 0] != 0.0 or normals[i, 1] != 0.0 or normals[i, 2] != 0.0
        if pressure < 0.0 and not near_surface:
            factor = 2.0 * pressure / rows[i, COLUMNS.density]
            rates[i, COLUMNS.u] += factor * sums[i, 0]
            rates[i, COLUMNS.v] += factor * sums[i, 1]
            if DIM == 3:
                rates[i, COLUMNS.w] += factor * sums[i, 2]
