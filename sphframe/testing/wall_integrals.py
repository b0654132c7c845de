"""Testing: the exact integrals of a kernel over the solid outside of a polygonal fluid, as sums over its edges."""

from typing import NamedTuple

import numba
import numpy as np

from sphframe.arrays import Array
from sphframe.compiled import specialise
from sphframe.compiled.stand_ins import EDGE_INTEGRALS
from sphframe.interfaces import Kernel
from sphframe.kernels import compiled_kernel


class WallIntegrals(NamedTuple):
    """What a smoothed sum over the fluid lacks at each of n points; see :func:`wall_integrals`."""

    gamma: Array
    """integral of W over the fluid, (n,)"""
    gradient: Array
    """its gradient, which points into the fluid, in 1/m, (n, 2)"""
    moment: Array
    """integral of grad W (x) (x' - x) over the solid, (n, 2, 2), symmetric"""


def wall_integrals(kernel: Kernel, smoothing_length: float, points: Array, starts: Array, ends: Array) -> WallIntegrals:
    """Return gamma, its gradient and the first moment of the solid for fluid that is bounded by straight edges.

    With c, w0 and w1 of :meth:`sphframe.Kernel.edge_integrals_function`, z the distance of the point before the line
    of edge e, t and n the directions along the edge and out of the fluid, and angle the angle at which it is seen::

        gamma      = sum_e (angle_e/(2 pi) - c_e)        lambda = 1 - gamma
        grad gamma = -sum_e n_e w0_e
        A          = lambda 1 + sum_e (z_e w0_e n_e + w1_e t_e) (x) n_e

    The angles add up to 2 pi for a point in the fluid, to pi on an edge, and to the angle of a corner in its vertex.

    Parameters
    ----------
    kernel
        any kernel. smoothing_length: h, in m. points: (n, 2), in m.
    starts, ends
        the ends of the edges, (e, 2), in m. They form closed polygons; from start to end the fluid is on the
        left, so that outlines run anticlockwise and those of obstacles clockwise.

    Returns
    -------
    WallIntegrals
        Arrays of n points; a point that sees no edge has gamma 1 or 0, gradient 0 and moment 0 or 1.

    Examples
    --------
    >>> from sphframe.kernels.wendland import WendlandC2
    >>> corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> points = np.array([[0.5, 0.5], [0.5, 0.01], [0.5, 0.0], [0.0, 0.0]])
    >>> wall_integrals(WendlandC2(), 0.1, points, corners, np.roll(corners, -1, axis=0)).gamma.round(6)
    array([1.      , 0.573815, 0.5     , 0.25    ])

    Source: Ferrand et al. (2013), doi:10.1002/fld.3666, for gamma and its gradient.
    """
    compiled = compiled_kernel(kernel, 2)
    sums = specialise(sum_over_edges, {"EDGE_INTEGRALS": compiled.edge_integrals})
    points, starts, ends = (np.ascontiguousarray(array, dtype=np.float64) for array in (points, starts, ends))
    n = len(points)
    found = WallIntegrals(np.empty(n), np.empty((n, 2)), np.empty((n, 2, 2)))
    sums(points, starts, ends, smoothing_length, compiled.normalisation, *found)
    return found


def sum_over_edges(  # type: ignore[no-untyped-def]
    points, starts, ends, h, normalisation, gamma, gradient, moment
):
    """Write the sums over all edges; one point after the other, edges in their order."""
    for i in numba.prange(points.shape[0]):
        seen = gx = gy = xx = xy = yx = yy = 0.0
        for e in range(starts.shape[0]):
            tx, ty = ends[e, 0] - starts[e, 0], ends[e, 1] - starts[e, 1]
            length = max(np.hypot(tx, ty), 1e-300)  # an edge without length adds nothing
            tx, ty = tx / length, ty / length
            nx, ny = ty, -tx
            x, y = (starts[e, 0] - points[i, 0]) / h, (starts[e, 1] - points[i, 1]) / h
            z, a = x * nx + y * ny, x * tx + y * ty
            b = a + length / h
            c, w0, w1 = EDGE_INTEGRALS(z, a, b)
            seen += np.arctan2(z * (b - a), z * z + a * b) / (2.0 * np.pi) - normalisation * c
            gx -= normalisation * w0 / h * nx
            gy -= normalisation * w0 / h * ny
            along, across = normalisation * w1, normalisation * z * w0
            xx += (across * nx + along * tx) * nx
            xy += (across * nx + along * tx) * ny
            yx += (across * ny + along * ty) * nx
            yy += (across * ny + along * ty) * ny
        gamma[i] = seen
        gradient[i, 0], gradient[i, 1] = gx, gy
        moment[i, 0, 0], moment[i, 0, 1] = 1.0 - seen + xx, xy
        moment[i, 1, 0], moment[i, 1, 1] = yx, 1.0 - seen + yy
