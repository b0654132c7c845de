"""Simulation: compiled updates of the packed rows: y = y0 + dt f for all columns, y = y + dt f for some."""

import numba

from sphframe.compiled import threaded_if_long


@threaded_if_long
def hold_state(rows, start, total):  # type: ignore[no-untyped-def]
    """Copy the state in ``rows`` to ``start`` (n, 2 dim + 1), and set ``total`` (n, 2 dim + 1) to zero."""
    for i in numba.prange(start.shape[0]):
        for k in range(start.shape[1]):
            start[i, k] = rows[i, k]
            total[i, k] = 0.0


@threaded_if_long
def advance_state(rows, start, rates, interval):  # type: ignore[no-untyped-def]
    """Set y = y0 + dt f in ``rows`` for y0 = ``start`` and f = ``rates`` (n, 2 dim + 1)."""
    for i in numba.prange(start.shape[0]):
        for k in range(start.shape[1]):
            rows[i, k] = start[i, k] + interval * rates[i, k]


@threaded_if_long
def add_columns(rows, rates, count, first, end, shift, factor):  # type: ignore[no-untyped-def]
    """Add ``factor`` times the columns from ``first + shift`` on of ``rates`` to ``first`` .. ``end`` of ``rows``.

    Only the first ``count`` rows are changed. With the columns of a quantity and of its rate: y = y + dt f.
    """
    for i in numba.prange(count):
        for k in range(first, end):
            rows[i, k] += factor * rates[i, k + shift]
