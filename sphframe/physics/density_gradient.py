"""Physics: the renormalised density gradient (Eq. 6 of the paper, which its text leaves out).

::

    <grad rho>_i = L_i sum_j (rho_j - rho_i) grad_i W_ij V_j,    L_i = [sum_j x_ji (x) grad_i W_ij V_j]^-1

over the fluid neighbours j. It is exact for a linear density, whatever the neighbours, wherever L_i exists. Where the
matrix is ill-conditioned (spray, isolated particles) the uncorrected sum is used.

Sources: M. Antuono et al. (2010), doi:10.1016/j.cpc.2009.11.002; S. Marrone et al. (2011),
doi:10.1016/j.cma.2010.12.016.
"""

import math
from typing import Any

import numba
import numpy as np

from sphframe.physics.chunks import CHUNKS, LANES
from sphframe.physics.sums import add

__all__ = ["density_gradient"]

# parts bound by specialise()
DIM = 2
SUPPORT = 3.0  # R/h
CLUSTER = 1  # particles that share a list


def GRADIENT(q: Any) -> Any:  # noqa: N802
    """Stand for w'(q)/q of the kernel."""


ILL_CONDITIONED = 0.02
"""det(A) / (trace(A)/d)^d below which the matrix A = L^-1 is not inverted; it is 1 in a full neighbourhood"""


def density_gradient(rows, lists, counts, support, gradient_scale, gradient):  # type: ignore[no-untyped-def]
    """Write <grad rho>_i (n, dim), kg/m^4, to ``gradient``; ``gradient_scale`` is sigma_d / h^(d+2).

    A row of ``lists`` serves CLUSTER consecutive particles, whose common neighbourhood is copied first: see
    :mod:`sphframe.neighbours.lists`.
    """
    limit = support * support
    per_h = SUPPORT / support
    n = gradient.shape[0]
    clusters = counts.shape[0]
    chunks = min(clusters, CHUNKS)
    for chunk in numba.prange(chunks):
        near = np.empty((DIM + 2, lists.shape[1] + LANES))
        xs = near[0]
        ys = near[1]
        zs = near[DIM - 1]
        densities = near[DIM]
        volumes = near[DIM + 1]
        for c in range(chunk * clusters // chunks, (chunk + 1) * clusters // chunks):
            first = c * CLUSTER
            count = counts[c]
            padded = (count + LANES - 1) // LANES * LANES  # full vectors: no remainder is left to a scalar loop
            for k in range(padded):
                j = lists[c, k] if k < count else first
                xs[k] = rows[j, 0]
                ys[k] = rows[j, 1]
                if DIM == 3:
                    zs[k] = rows[j, 2]
                densities[k] = rows[j, 2 * DIM]
                volumes[k] = rows[j, 2 * DIM + 2] if k < count else 0.0
            for i in range(first, min(first + CLUSTER, n)):
                x = rows[i, 0]
                y = rows[i, 1]
                z = rows[i, DIM - 1]
                density = rows[i, 2 * DIM]
                bx = by = bz = 0.0
                xx = xy = yy = xz = yz = zz = 0.0
                for k in range(padded):
                    dx = xs[k] - x
                    dy = ys[k] - y
                    r2 = dx * dx + dy * dy
                    if DIM == 3:
                        dz = zs[k] - z
                        r2 += dz * dz
                    weight = -gradient_scale * GRADIENT(math.sqrt(r2) * per_h) * volumes[k]
                    weight = weight if r2 < limit else 0.0  # a choice, not a branch: the loop vectorises
                    rise = weight * (densities[k] - density)
                    wx = weight * dx
                    wy = weight * dy
                    bx = add(bx, rise * dx)
                    by = add(by, rise * dy)
                    xx = add(xx, wx * dx)
                    xy = add(xy, wx * dy)
                    yy = add(yy, wy * dy)
                    if DIM == 3:
                        bz = add(bz, rise * dz)
                        xz = add(xz, wx * dz)
                        yz = add(yz, wy * dz)
                        zz = add(zz, weight * dz * dz)
                if DIM == 2:
                    determinant = xx * yy - xy * xy
                    mean = 0.5 * (xx + yy)
                    if determinant > ILL_CONDITIONED * mean * mean:
                        gradient[i, 0] = (yy * bx - xy * by) / determinant
                        gradient[i, 1] = (xx * by - xy * bx) / determinant
                    else:
                        gradient[i, 0] = bx
                        gradient[i, 1] = by
                else:
                    cxx = yy * zz - yz * yz
                    cxy = xz * yz - xy * zz
                    cxz = xy * yz - xz * yy
                    determinant = xx * cxx + xy * cxy + xz * cxz
                    mean = (xx + yy + zz) / 3.0
                    if determinant > ILL_CONDITIONED * mean * mean * mean:
                        cyy = xx * zz - xz * xz
                        cyz = xy * xz - xx * yz
                        czz = xx * yy - xy * xy
                        gradient[i, 0] = (cxx * bx + cxy * by + cxz * bz) / determinant
                        gradient[i, 1] = (cxy * bx + cyy * by + cyz * bz) / determinant
                        gradient[i, 2] = (cxz * bx + cyz * by + czz * bz) / determinant
                    else:
                        gradient[i, 0] = bx
                        gradient[i, 1] = by
                        gradient[i, 2] = bz
