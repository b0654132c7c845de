"""Compiled: differences and squared distances of points, to the nearest copy where space repeats itself."""

import numba
import numpy as np


@numba.njit(inline="always")
def nearest(difference, parameters, d):  # type: ignore[no-untyped-def]
    """Return a ``difference`` of coordinates ``d`` to the nearest copy; ``parameters``: :class:`LoopParameters`."""
    if d == 0:
        return difference - parameters.period_x * np.floor(difference * parameters.per_period_x + 0.5)
    if d == 1:
        return difference - parameters.period_y * np.floor(difference * parameters.per_period_y + 0.5)
    return difference - parameters.period_z * np.floor(difference * parameters.per_period_z + 0.5)


@numba.njit(inline="always")
def squared_distance(a, i, b, j, dim, periodic=False, parameters=None):  # type: ignore[no-untyped-def]
    """Return |a_i - b_j|^2 from the first ``dim`` columns of row ``i`` of ``a`` and row ``j`` of ``b``.

    With ``periodic``, a constant, the distance is that of the nearest copies.
    """
    square = 0.0
    for d in range(dim):
        difference = a[i, d] - b[j, d]
        if periodic:
            difference = nearest(difference, parameters, d)
        square += difference**2
    return square
