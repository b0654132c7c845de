"""Physics: the fluid at given points, for probes and gauges.

::

    filling(x)  = sum_j W(x - x_j) V_j
    pressure(x) = sum_j W(x - x_j) V_j [p_j + rho0 f(x).(x - x_j)] / filling(x)

with the force per mass f. The kernel average with the hydrostatic lift from each particle to the point is exact on a
hydrostatic field also at a wall, where half of the support is empty. It does not depend on the interpolation method, so
that methods can be compared.
"""

import math

import numba

from sphframe.compiled import squared_distance
from sphframe.compiled.stand_ins import COLUMNS, DIM, PERIODIC, SUPPORT, VALUE
from sphframe.physics.body_force import body_force


def sample_points(points, rows, lists, counts, parameters, pressures, fillings):  # type: ignore[no-untyped-def]
    """Write the pressure (Pa, 0 where dry) and the filling of ``points`` (k, dim)."""
    limit = parameters.support * parameters.support
    per_h = SUPPORT / parameters.support
    for i in numba.prange(points.shape[0]):
        ax, ay, az = body_force(parameters, points[i, 0], points[i, 1], points[i, COLUMNS.z])
        bx, by = parameters.reference_density * ax, parameters.reference_density * ay
        bz = parameters.reference_density * az
        if PERIODIC:  # no pressure grows along a direction that repeats itself
            bx = 0.0 if parameters.period_x > 0.0 else bx
            by = 0.0 if parameters.period_y > 0.0 else by
            bz = 0.0 if parameters.period_z > 0.0 else bz
        filling = 0.0
        pressure = 0.0
        for k in range(counts[i]):
            j = lists[i, k]
            r2 = squared_distance(rows, j, points, i, DIM, PERIODIC, parameters)
            if r2 < limit:
                part = parameters.kernel_scale * VALUE(math.sqrt(r2) * per_h) * rows[j, COLUMNS.volume]
                filling += part
                lift = bx * (points[i, 0] - rows[j, 0]) + by * (points[i, 1] - rows[j, 1])
                if DIM == 3:
                    lift += bz * (points[i, 2] - rows[j, 2])
                pressure += part * (rows[j, COLUMNS.pressure] + lift)
        fillings[i] = filling
        pressures[i] = pressure / filling if filling > 0.0 else 0.0
