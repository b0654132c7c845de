"""Compiled: differences and squared distances of points, to the nearest copy where space repeats itself."""

import numba
import numpy as np


@numba.njit(error_model="numpy", forceinline=True)
def whole(x):  # type: ignore[no-untyped-def]
    """Return the largest whole number that is not above ``x``, as a float."""
    return np.floor(x)


@numba.njit(error_model="numpy", forceinline=True)
def nearest(difference, parameters, d):  # type: ignore[no-untyped-def]
    """Return a ``difference`` of coordinates ``d`` to the nearest copy; ``parameters``: :class:`LoopParameters`."""
    if d == 0:
        return difference - parameters.period_x * whole(difference * parameters.per_period_x + 0.5)
    if d == 1:
        return difference - parameters.period_y * whole(difference * parameters.per_period_y + 0.5)
    return difference - parameters.period_z * whole(difference * parameters.per_period_z + 0.5)


@numba.njit(error_model="numpy", forceinline=True)
def offset_between(a, i, b, j, dim, periodic, parameters):  # type: ignore[no-untyped-def]
    """Return the components of a_i - b_j, the third one 0 in two dimensions, and their sum of squares.

    The arguments are those of :func:`squared_distance`.
    """
    dx = a[i, 0] - b[j, 0]
    dy = a[i, 1] - b[j, 1]
    dz = a[i, 2] - b[j, 2] if dim == 3 else 0.0
    if periodic:
        dx, dy, dz = nearest(dx, parameters, 0), nearest(dy, parameters, 1), nearest(dz, parameters, 2)
    return dx, dy, dz, dx * dx + dy * dy + dz * dz


@numba.njit(error_model="numpy", forceinline=True)
def squared_distance(a, i, b, j, dim, periodic, parameters):  # type: ignore[no-untyped-def]
    """Return ``|a_i - b_j|^2`` from the first ``dim`` columns of row ``i`` of ``a`` and row ``j`` of ``b``.

    With ``periodic``, a constant, the distance is that of the nearest copies.
    """
    return offset_between(a, i, b, j, dim, periodic, parameters)[3]
