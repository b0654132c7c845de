"""Physics: the rates of the fluid in one loop over its neighbours; each term is explained in its own file.

CONTINUITY and MOMENTUM say which of the two equations a specialised loop evaluates: one of them, or both at once.
"""

import math
from typing import Any

import numba

from sphframe.physics.continuity import diffusive_flux
from sphframe.physics.momentum import pair_stress

__all__ = ["fluid_rates"]

# parts bound by specialise()
DIM = 2
SUPPORT = 3.0  # R/h
CONTINUITY = True
MOMENTUM = True


def GRADIENT(q: Any) -> Any:  # noqa: N802
    """Stand for w'(q)/q of the kernel."""


def fluid_rates(  # type: ignore[no-untyped-def]
    rows, gradient, lists, fluid_counts, ghost_counts, support, gradient_scale, diffusion, viscosity, gravity, rates
):
    """Write velocity, acceleration (if MOMENTUM) and density rate (if CONTINUITY), (n, 2 dim + 1), to ``rates``.

    ``gradient_scale`` is sigma_d / h^(d+2), ``diffusion`` delta h c0 in m^2/s, ``viscosity`` alpha h c0 rho0 in Pa s,
    ``gravity`` acts downwards along the last axis, m/s^2.
    """
    limit = support * support
    per_h = SUPPORT / support
    for i in numba.prange(rates.shape[0]):
        x = rows[i, 0]
        y = rows[i, 1]
        u = rows[i, DIM]
        v = rows[i, DIM + 1]
        density = rows[i, 2 * DIM]
        pressure = rows[i, 2 * DIM + 1]
        gx = gradient[i, 0]
        gy = gradient[i, 1]
        compression = 0.0
        diffused = 0.0
        fx = fy = fz = 0.0
        fluid = fluid_counts[i]
        for k in range(fluid):
            j = lists[i, k]
            dx = rows[j, 0] - x
            dy = rows[j, 1] - y
            r2 = dx * dx + dy * dy
            if DIM == 3:
                dz = rows[j, 2] - rows[i, 2]
                r2 += dz * dz
            weight = -gradient_scale * GRADIENT(math.sqrt(r2) * per_h) * rows[j, 2 * DIM + 2]
            weight = weight if r2 < limit else 0.0  # a choice, not a branch: the loop vectorises
            approach = (rows[j, DIM] - u) * dx + (rows[j, DIM + 1] - v) * dy
            sloped = (gx + gradient[j, 0]) * dx + (gy + gradient[j, 1]) * dy
            if DIM == 3:
                approach += (rows[j, DIM + 2] - rows[i, DIM + 2]) * dz
                sloped += (gradient[i, 2] + gradient[j, 2]) * dz
            if CONTINUITY:
                compression += weight * approach
                diffused += weight * diffusive_flux(rows[j, 2 * DIM] - density, sloped)
            if MOMENTUM:
                stress = weight * pair_stress(pressure + rows[j, 2 * DIM + 1], viscosity, approach, r2)
                fx += stress * dx
                fy += stress * dy
                if DIM == 3:
                    fz += stress * dz
        for k in range(fluid, fluid + ghost_counts[i]):
            j = lists[i, k]
            dx = rows[j, 0] - x
            dy = rows[j, 1] - y
            r2 = dx * dx + dy * dy
            if DIM == 3:
                dz = rows[j, 2] - rows[i, 2]
                r2 += dz * dz
            weight = -gradient_scale * GRADIENT(math.sqrt(r2) * per_h) * rows[j, 2 * DIM + 2]
            weight = weight if r2 < limit else 0.0  # a choice, not a branch: the loop vectorises
            approach = (rows[j, DIM] - u) * dx + (rows[j, DIM + 1] - v) * dy
            if DIM == 3:
                approach += (rows[j, DIM + 2] - rows[i, DIM + 2]) * dz
            if CONTINUITY:
                compression += weight * approach
            if MOMENTUM:
                stress = weight * pair_stress(pressure + rows[j, 2 * DIM + 1], viscosity, approach, r2)
                fx += stress * dx
                fy += stress * dy
                if DIM == 3:
                    fz += stress * dz
        rates[i, 0] = u
        rates[i, 1] = v
        if DIM == 3:
            rates[i, 2] = rows[i, DIM + 2]
        if MOMENTUM:
            rates[i, DIM] = fx / density
            rates[i, DIM + 1] = fy / density
            if DIM == 3:
                rates[i, DIM + 2] = fz / density
            rates[i, 2 * DIM - 1] -= gravity
        if CONTINUITY:
            rates[i, 2 * DIM] = diffusion * diffused - density * compression
