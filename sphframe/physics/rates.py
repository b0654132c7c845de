"""Physics: the rates of the fluid in one loop over its neighbours; each term is explained in its own file.

CONTINUITY and MOMENTUM say which of the two equations a specialised loop evaluates: one of them, or both at once.
"""

import math
from typing import Any

import numba
import numpy as np

from sphframe.physics.chunks import CHUNKS, LANES
from sphframe.physics.continuity import diffusive_flux
from sphframe.physics.momentum import pair_stress
from sphframe.physics.sums import add

__all__ = ["fluid_rates"]

# parts bound by specialise()
DIM = 2
SUPPORT = 3.0  # R/h
CLUSTER = 1  # particles that share a list
CONTINUITY = True
MOMENTUM = True


def GRADIENT(q: Any) -> Any:  # noqa: N802
    """Stand for w'(q)/q of the kernel."""


def fluid_rates(  # type: ignore[no-untyped-def]
    rows, gradient, lists, fluid_counts, ghost_counts, support, gradient_scale, diffusion, viscosity, gravity, rates
):
    """Write velocity, acceleration (if MOMENTUM) and density rate (if CONTINUITY), (n, 2 dim + 1), to ``rates``.

    ``gradient_scale`` is sigma_d / h^(d+2), ``diffusion`` delta h c0 in m^2/s, ``viscosity`` alpha h c0 rho0 in Pa s,
    ``gravity`` acts downwards along the last axis, m/s^2. A row of ``lists`` serves CLUSTER consecutive particles,
    whose common neighbourhood is copied first: see :mod:`sphframe.neighbours.lists`.
    """
    limit = support * support
    per_h = SUPPORT / support
    n = rates.shape[0]
    clusters = fluid_counts.shape[0]
    chunks = min(clusters, CHUNKS)
    for chunk in numba.prange(chunks):
        near = np.empty((3 * DIM + 3, lists.shape[1] + 2 * LANES))
        xs = near[0]
        ys = near[1]
        zs = near[DIM - 1]
        us = near[DIM]
        vs = near[DIM + 1]
        ws = near[2 * DIM - 1]
        densities = near[2 * DIM]
        pressures = near[2 * DIM + 1]
        volumes = near[2 * DIM + 2]
        gxs = near[2 * DIM + 3]
        gys = near[2 * DIM + 4]
        gzs = near[3 * DIM + 2]
        for c in range(chunk * clusters // chunks, (chunk + 1) * clusters // chunks):
            first = c * CLUSTER
            count = fluid_counts[c]
            # full vectors, fluid and ghosts apart: no remainder is left to a scalar loop
            fluid = (count + LANES - 1) // LANES * LANES
            both = fluid + (ghost_counts[c] + LANES - 1) // LANES * LANES
            ghosts_end = fluid + ghost_counts[c]
            for k in range(both):
                listed = k if k < fluid else k - fluid + count
                real = k < count or (k >= fluid and k < ghosts_end)
                j = lists[c, listed] if real else first
                xs[k] = rows[j, 0]
                ys[k] = rows[j, 1]
                us[k] = rows[j, DIM]
                vs[k] = rows[j, DIM + 1]
                if DIM == 3:
                    zs[k] = rows[j, 2]
                    ws[k] = rows[j, 5]
                if MOMENTUM:
                    pressures[k] = rows[j, 2 * DIM + 1]
                volumes[k] = rows[j, 2 * DIM + 2] if real else 0.0
                if CONTINUITY and k < fluid:
                    densities[k] = rows[j, 2 * DIM]
                    gxs[k] = gradient[j, 0]
                    gys[k] = gradient[j, 1]
                    if DIM == 3:
                        gzs[k] = gradient[j, 2]
            for i in range(first, min(first + CLUSTER, n)):
                x = rows[i, 0]
                y = rows[i, 1]
                z = rows[i, DIM - 1]
                u = rows[i, DIM]
                v = rows[i, DIM + 1]
                w = rows[i, 2 * DIM - 1]
                density = rows[i, 2 * DIM]
                pressure = rows[i, 2 * DIM + 1]
                gx = gradient[i, 0]
                gy = gradient[i, 1]
                gz = gradient[i, DIM - 1]
                compression = 0.0
                diffused = 0.0
                fx = fy = fz = 0.0
                for k in range(fluid):
                    dx = xs[k] - x
                    dy = ys[k] - y
                    r2 = dx * dx + dy * dy
                    approach = (us[k] - u) * dx + (vs[k] - v) * dy
                    if DIM == 3:
                        dz = zs[k] - z
                        r2 += dz * dz
                        approach += (ws[k] - w) * dz
                    weight = -gradient_scale * GRADIENT(math.sqrt(r2) * per_h) * volumes[k]
                    weight = weight if r2 < limit else 0.0  # a choice, not a branch: the loop vectorises
                    if CONTINUITY:
                        sloped = (gx + gxs[k]) * dx + (gy + gys[k]) * dy
                        if DIM == 3:
                            sloped += (gz + gzs[k]) * dz
                        compression = add(compression, weight * approach)
                        diffused = add(diffused, weight * diffusive_flux(densities[k] - density, sloped))
                    if MOMENTUM:
                        stress = weight * pair_stress(pressure + pressures[k], viscosity, approach, r2)
                        fx = add(fx, stress * dx)
                        fy = add(fy, stress * dy)
                        if DIM == 3:
                            fz = add(fz, stress * dz)
                for k in range(fluid, both):
                    dx = xs[k] - x
                    dy = ys[k] - y
                    r2 = dx * dx + dy * dy
                    approach = (us[k] - u) * dx + (vs[k] - v) * dy
                    if DIM == 3:
                        dz = zs[k] - z
                        r2 += dz * dz
                        approach += (ws[k] - w) * dz
                    weight = -gradient_scale * GRADIENT(math.sqrt(r2) * per_h) * volumes[k]
                    weight = weight if r2 < limit else 0.0
                    if CONTINUITY:
                        compression = add(compression, weight * approach)
                    if MOMENTUM:
                        stress = weight * pair_stress(pressure + pressures[k], viscosity, approach, r2)
                        fx = add(fx, stress * dx)
                        fy = add(fy, stress * dy)
                        if DIM == 3:
                            fz = add(fz, stress * dz)
                rates[i, 0] = u
                rates[i, 1] = v
                if DIM == 3:
                    rates[i, 2] = w
                if MOMENTUM:
                    rates[i, DIM] = fx / density
                    rates[i, DIM + 1] = fy / density
                    if DIM == 3:
                        rates[i, DIM + 2] = fz / density
                    rates[i, 2 * DIM - 1] -= gravity
                if CONTINUITY:
                    rates[i, 2 * DIM] = diffusion * diffused - density * compression
