"""Loop templates that only the device needs."""

import numba

from sphframe.devices import squared_distance

# parts bound by Loop
CLUSTER = 8
PERIODIC = False
DIM = 2


def list_each(  # type: ignore[no-untyped-def]
    position, n, lists, fluid_counts, ghost_counts, limit, ghost_limit, parameters, own, own_fluid, own_ghosts
):
    """Write the neighbours of each of the ``n`` particles to ``own`` (n, capacity), first fluid, then ghosts.

    They are those of the list of its CLUSTER whose squared distance is below ``limit`` or ``ghost_limit``, in the same
    order. ``position`` (n + g, dim), m; ``own_fluid`` and ``own_ghosts`` (n,) are their numbers.
    """
    for i in numba.prange(n):
        c = i // CLUSTER
        count = 0
        for k in range(fluid_counts[c]):
            j = lists[c, k]
            if j != i and squared_distance(position, i, position, j, DIM, PERIODIC, parameters) < limit:
                own[i, count] = j
                count += 1
        own_fluid[i] = count
        for k in range(fluid_counts[c], fluid_counts[c] + ghost_counts[c]):
            j = lists[c, k]
            if squared_distance(position, i, position, j, DIM, PERIODIC, parameters) < ghost_limit:
                own[i, count] = j
                count += 1
        own_ghosts[i] = count - own_fluid[i]


def copy_lists(lists, counts, copy):  # type: ignore[no-untyped-def]
    """Copy ``lists`` (k, capacity) with ``counts`` (k,) entries to ``copy``, whose first index runs fastest."""
    for i in numba.prange(counts.shape[0]):
        for k in range(counts[i]):
            copy[i, k] = lists[i, k]


def put_ghosts(rows, first, position):  # type: ignore[no-untyped-def]
    """Write ``position`` (g, dim) to the rows from ``first`` on."""
    for g in numba.prange(position.shape[0]):
        for d in range(position.shape[1]):
            rows[first + g, d] = position[g, d]


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
