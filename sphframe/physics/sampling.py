"""Physics: the fluid at given points, for probes and gauges.

::

    filling(x)  = sum_j W(x - x_j) V_j
    pressure(x) = sum_j W(x - x_j) V_j [p_j - rho0 g (z - z_j)] / filling(x)

The kernel average with the hydrostatic lift from each particle to the point is exact on a hydrostatic field also at a
wall, where half of the support is empty; it is the same for every interpolation method under comparison.
"""

import math
from typing import Any

import numba

__all__ = ["sample_points"]

# parts bound by specialise()
DIM = 2
SUPPORT = 3.0  # R/h


def VALUE(q: Any) -> Any:  # noqa: N802
    """Stand for w(q) of the kernel."""


def sample_points(points, rows, lists, counts, support, kernel_scale, weight, pressures, fillings):  # type: ignore[no-untyped-def]
    """Write the pressure (Pa, 0 where dry) and the filling of ``points`` (k, dim); ``weight`` is rho0 g, N/m^3."""
    limit = support * support
    per_h = SUPPORT / support
    for i in numba.prange(points.shape[0]):
        filling = 0.0
        pressure = 0.0
        for k in range(counts[i]):
            j = lists[i, k]
            r2 = 0.0
            for d in range(DIM):
                r2 += (rows[j, d] - points[i, d]) ** 2
            if r2 < limit:
                part = kernel_scale * VALUE(math.sqrt(r2) * per_h) * rows[j, 2 * DIM + 2]
                filling += part
                pressure += part * (rows[j, 2 * DIM + 1] - weight * (points[i, DIM - 1] - rows[j, DIM - 1]))
        fillings[i] = filling
        pressures[i] = pressure / filling if filling > 0.0 else 0.0
