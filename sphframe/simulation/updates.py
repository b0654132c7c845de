"""Simulation: compiled updates of the packed rows: y = y0 + dt f, and its parts for position, velocity and density."""

import numba


@numba.njit(parallel=True, cache=True)
def copy_state(rows, start):  # type: ignore[no-untyped-def]
    """Copy position, velocity and density of ``rows`` to ``start`` (n, 2 dim + 1)."""
    for i in numba.prange(start.shape[0]):
        for k in range(start.shape[1]):
            start[i, k] = rows[i, k]


@numba.njit(parallel=True, cache=True)
def advance_state(rows, start, rates, interval):  # type: ignore[no-untyped-def]
    """Set y = y0 + dt f in ``rows`` for y0 = ``start`` and f = ``rates`` (n, 2 dim + 1)."""
    for i in numba.prange(start.shape[0]):
        for k in range(start.shape[1]):
            rows[i, k] = start[i, k] + interval * rates[i, k]


@numba.njit(parallel=True, cache=True)
def accumulate_rates(total, rates, weight):  # type: ignore[no-untyped-def]
    """Add ``weight`` times ``rates`` to ``total`` (n, 2 dim + 1)."""
    for i in numba.prange(total.shape[0]):
        for k in range(total.shape[1]):
            total[i, k] += weight * rates[i, k]


@numba.njit(parallel=True, cache=True)
def advance_position(rows, count, columns, interval):  # type: ignore[no-untyped-def]
    """Add dt u to the positions of the first ``count`` rows, whose ``columns`` are given."""
    for i in numba.prange(count):
        for k in range(columns.dim):
            rows[i, k] += interval * rows[i, columns.u + k]


@numba.njit(parallel=True, cache=True)
def advance_velocity(rows, rates, columns, interval):  # type: ignore[no-untyped-def]
    """Add dt a, from the accelerations in ``rates`` (n, 2 dim + 1), to the velocities."""
    for i in numba.prange(rates.shape[0]):
        for k in range(columns.u, columns.density):
            rows[i, k] += interval * rates[i, k]


@numba.njit(parallel=True, cache=True)
def advance_density(rows, rates, columns, interval):  # type: ignore[no-untyped-def]
    """Add dt times the density rate in ``rates`` (n, 2 dim + 1) to the densities."""
    for i in numba.prange(rates.shape[0]):
        rows[i, columns.density] += interval * rates[i, columns.density]
