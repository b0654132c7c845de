"""Physics: inflow and outflow of a channel along x, in two dimensions.

Particles left of the plane x_in and right of x_out are in zones, where their state is prescribed and not computed. The
flow between the planes sees them as fluid. With the profile U(y, t) of the inflow, and the pressure p_out::

    inflow zone    u = (U, 0),    p = p_n + g (x - x_n),    m = rho V with V = dx^2
    outflow zone   u = u_n,       p = p_out + (dp/dx)_n (x - x_out)

and rho from the equation of state. g relaxes to the mean over the height of (dp/dx)_n, within five times the time in
which sound crosses the channel: with the gradient itself, sound waves grow at the inflow. Those that arrive at an end
leave a tenth of their velocity behind.

The values at the nodes n are those of a fit to the fluid between the planes, weighted by W V, linear along and
quadratic across the channel: a linear one would flatten the profile. Nodes are one spacing apart along a line across
the channel, one support of the kernel within it, so that no zone is in their reach; between them values are linear.

A particle that leaves the inflow zone is followed by a new one, a zone's length behind it; one that leaves the outflow
zone is removed. The exchange is made when neighbours are found, for which zones are longer than a support.

Source: A. Tafuni, J. M. Dominguez, R. Vacondio, A. J. C. Crespo (2018), doi:10.1016/j.cma.2018.08.004, with these
departures: nodes are fixed on a line and not mirrored from each particle, the gradient of pressure at the inflow is
smoothed in time, and the velocity in the outflow zone has no gradient along x.
"""

import math

import numba

from sphframe.compiled.stand_ins import COLUMNS, SUPPORT, VALUE


def fit_sums(nodes, rows, lists, counts, parameters, inflow, outflow, matrices, sums):  # type: ignore[no-untyped-def]
    """Write the normal equations of the fits at ``nodes`` (k, 2): ``matrices`` (k, 4, 4), ``sums`` (k, 4, 3).

    The unknowns are those of f = a + b s + c t + d t^2 with s, t = (x - x_n) / support, for pressure and both
    velocities. ``lists`` (k, capacity) holds ``counts`` (k,) fluid particles near each node; those between the planes
    x = ``inflow`` and ``outflow`` are used.
    """
    per_support = 1.0 / parameters.support
    for i in numba.prange(nodes.shape[0]):
        matrices[i] = 0.0
        sums[i] = 0.0
        for k in range(counts[i]):
            j = lists[i, k]
            s, t = (rows[j, 0] - nodes[i, 0]) * per_support, (rows[j, 1] - nodes[i, 1]) * per_support
            q = math.sqrt(s * s + t * t)
            if q < 1.0 and inflow <= rows[j, 0] <= outflow:
                weight = VALUE(q * SUPPORT) * rows[j, COLUMNS.volume]
                terms = (1.0, s, t, t * t)
                values = (rows[j, COLUMNS.pressure], rows[j, COLUMNS.u], rows[j, COLUMNS.v])
                for a in range(4):
                    for b in range(4):
                        matrices[i, a, b] += weight * terms[a] * terms[b]
                    for b in range(3):
                        sums[i, a, b] += weight * terms[a] * values[b]
