"""Compiled: the squared distance between two points of arrays."""

import numba


@numba.njit(inline="always")
def squared_distance(a, i, b, j, dim):  # type: ignore[no-untyped-def]
    """Return |a_i - b_j|^2 from the first ``dim`` columns of row ``i`` of ``a`` and row ``j`` of ``b``."""
    square = 0.0
    for d in range(dim):
        square += (a[i, d] - b[j, d]) ** 2
    return square
