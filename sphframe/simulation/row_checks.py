"""Simulation: compiled checks of the packed rows, with which the guards find what has gone wrong."""

import math

import numba

from sphframe.compiled import threaded_if_long


@threaded_if_long
def check_fluid(rows, n, columns, lower, upper, lowest, highest):  # type: ignore[no-untyped-def]
    """Return the first of ``n`` rows that is not finite, the first one outside the box, and the first one with a
    density outside ``lowest`` .. ``highest`` and the number of those. A first one that does not exist is n."""
    broken = outside = out_of_range = n
    densities_outside = 0
    for i in numba.prange(n):
        inside = True
        density = rows[i, columns.density]
        total = density
        for k in range(columns.dim):
            total += rows[i, columns.u + k] ** 2 + rows[i, k]
            inside = inside and rows[i, k] >= lower[k] and rows[i, k] <= upper[k]
        if not math.isfinite(total):
            broken = min(broken, i)
        elif not inside:
            outside = min(outside, i)
        elif density < lowest or density > highest:
            out_of_range = min(out_of_range, i)
            densities_outside += 1
    return broken, outside, out_of_range, densities_outside


@threaded_if_long
def first_bad_ghost(rows, first, columns, ghosts, statuses, status_count):  # type: ignore[no-untyped-def]
    """Return the first of ``ghosts`` whose state is not finite or whose status is no :class:`Status`; g without one."""
    worst = statuses.shape[0]
    for k in numba.prange(ghosts.shape[0]):
        g = ghosts[k]
        total = rows[first + g, columns.density] + rows[first + g, columns.pressure]
        for d in range(columns.density):
            total += rows[first + g, d]
        if not math.isfinite(total) or statuses[g] < 0 or statuses[g] >= status_count:
            worst = min(worst, g)
    return worst
