"""Interfaces: the integrals of a kernel over a straight edge of a wall, by quadrature."""

import math
from collections.abc import Callable

import numpy as np

ScalarFunction = Callable[[float], float]
EdgeFunction = Callable[[float, float, float], tuple[float, float, float]]
"""(z, a, b) -> (c, w0, w1), see :meth:`sphframe.Kernel.edge_integrals_function`"""

NODES = 16
"""number of points of the quadrature on each side of the foot; a constant, so that compiled loops are unrolled"""


def edge_quadrature(value: ScalarFunction, support: float, mean: ScalarFunction | None = None) -> EdgeFunction:
    """Return the integrals of w over an edge by Gauss-Legendre quadrature along the edge.

    The chord is divided at the foot of the point, with 16 nodes on each side. With the mean of w over the disc of
    radius q, m(q) = 2 k(q), k(q) = int_0^1 w(q x) x dx, the potential is g = R^2 k(R) - q^2 k(q), and::

        c = R^2 k(R) [angle from the point to the ends of the chord] - z int_a^b k ds,     w1 = g(r_a) - g(r_b)

    whose integrand has no singularity for points close to the edge. The error is at round-off for functions of q^2
    such as the Gaussian. For functions with odd powers or knots it is algebraic: see the method that calls this one.

    Parameters
    ----------
    value
        w(q). support: R/h. mean: k(q), in closed form; by default it is computed by 16 nodes as well.
    """
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    x, y = tuple(0.5 + 0.5 * nodes), tuple(0.5 * weights)

    def by_quadrature(q: float) -> float:
        total = 0.0
        for k in range(NODES):
            total += y[k] * x[k] * value(q * x[k])
        return total

    k_of = by_quadrature if mean is None else mean
    centre = support * support * k_of(support)

    def edge_integrals(z: float, a: float, b: float) -> tuple[float, float, float]:
        z2 = z * z
        half = math.sqrt(max(support * support - z2, 0.0))
        a = min(max(a, -half), half)
        b = min(max(b, -half), half)
        if not a < b:
            return 0.0, 0.0, 0.0
        foot = min(max(0.0, a), b)
        w0 = mean_along = 0.0
        for start, length in ((a, foot - a), (foot, b - foot)):
            for k in range(NODES if length > 0.0 else 0):
                s = start + length * x[k]
                q = min(math.sqrt(s * s + z2), support)
                w0 += length * y[k] * value(q)
                mean_along += length * y[k] * k_of(q)
        c = centre * math.atan2(z * (b - a), z2 + a * b) - z * mean_along
        ra, rb = min(math.sqrt(a * a + z2), support), min(math.sqrt(b * b + z2), support)
        return c, w0, rb * rb * k_of(rb) - ra * ra * k_of(ra)

    return edge_integrals
