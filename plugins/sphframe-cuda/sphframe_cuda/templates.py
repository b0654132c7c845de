"""Loop templates that only the device needs."""

import numba


def put_rows(rows, first, given):  # type: ignore[no-untyped-def]
    """Write ``given`` (k, columns) to the rows from ``first`` on."""
    for k in numba.prange(given.shape[0]):
        for d in range(given.shape[1]):
            rows[first + k, d] = given[k, d]


def copy_rows(rows, copy):  # type: ignore[no-untyped-def]
    """Copy the first rows, and of these the first columns, to ``copy`` (k, columns)."""
    for k in numba.prange(copy.shape[0]):
        for d in range(copy.shape[1]):
            copy[k, d] = rows[k, d]


def take_rows(rows, chosen, found):  # type: ignore[no-untyped-def]
    """Copy the ``chosen`` (k,) rows to ``found`` (k, width)."""
    for k in numba.prange(chosen.shape[0]):
        for d in range(found.shape[1]):
            found[k, d] = rows[chosen[k], d]


def give_rows(rows, chosen, given):  # type: ignore[no-untyped-def]
    """Copy ``given`` (k, width) to the ``chosen`` (k,) rows."""
    for k in numba.prange(chosen.shape[0]):
        for d in range(given.shape[1]):
            rows[chosen[k], d] = given[k, d]
