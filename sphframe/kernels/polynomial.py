"""Kernels: the integrals over an edge of a kernel that is made of polynomials, in closed form."""

import math

import numpy as np

from sphframe.interfaces.edge_integrals import EdgeFunction


def polynomial_edge_integrals(*terms: tuple[float, tuple[float, ...]]) -> EdgeFunction:
    """Return the edge integrals of w(q) = sum over the terms of sum_k c_k q^k, each term for q below its own cut.

    With J_n(s) = int_0^s r^n ds, r^2 = s^2 + z^2, and [J] its difference between the ends of the chord::

        J_0 = s,   J_1 = (s r + z^2 asinh(s/|z|))/2,   J_n = (s r^n + n z^2 J_(n-2))/(n + 1)

        w0 = sum c_k [J_k],   w1 = sum c_k [r^(k+2)]/(k+2),   c = g(0) angle - z sum c_k/(k+2) [J_k]

    g(0) = sum c_k cut^(k+2)/(k+2); the angle is that from the point to the ends, atan2(z (b-a), z^2 + a b).

    Parameters
    ----------
    terms
        (cut, (c_0, c_1, ...)), the cut-off in smoothing lengths and the coefficients; a term is 0 at its cut.

    Examples
    --------
    >>> c2 = polynomial_edge_integrals((2.0, (1.0, 0.0, -2.5, 2.5, -0.9375, 0.125)))
    >>> f"{7 / (4 * math.pi) * c2(0.3, -0.5, 0.5)[1]:.12f}"
    '0.405539189396'
    """
    count, degree = len(terms), len(terms[0][1]) - 1
    cuts = np.array([cut for cut, _ in terms])
    coefficients = np.array([c for _, c in terms])
    powers = np.arange(2, degree + 3)
    centres = (coefficients * cuts[:, None] ** powers / powers).sum(axis=1)

    def primitives(m: int, s: float, z: float) -> tuple[float, float, float]:
        """The integrals of term ``m`` from the foot to s: of w, of w q dq, and of sum c_k q^k/(k + 2)."""
        z2 = z * z
        r2 = s * s + z2
        r = math.sqrt(r2)
        before, now = s, 0.5 * (s * r + z2 * math.asinh(s / max(abs(z), 1e-300)))  # at z = 0 the last term vanishes
        power = r
        w0 = coefficients[m, 0] * before + coefficients[m, 1] * now
        w1 = r2 * (coefficients[m, 0] / 2.0 + coefficients[m, 1] * r / 3.0)
        mean = coefficients[m, 0] * before / 2.0 + coefficients[m, 1] * now / 3.0
        for k in range(2, degree + 1):
            power *= r
            before, now = now, (s * power + k * z2 * before) / (k + 1)
            w0 += coefficients[m, k] * now
            w1 += coefficients[m, k] * power * r2 / (k + 2)
            mean += coefficients[m, k] * now / (k + 2)
        return w0, w1, mean

    def edge_integrals(z: float, a: float, b: float) -> tuple[float, float, float]:
        c = w0 = w1 = 0.0
        for m in range(count):
            half = math.sqrt(max(cuts[m] * cuts[m] - z * z, 0.0))
            low, high = min(max(a, -half), half), min(max(b, -half), half)
            if not low < high:
                continue
            w0_low, w1_low, mean_low = primitives(m, low, z)
            w0_high, w1_high, mean_high = primitives(m, high, z)
            c += centres[m] * math.atan2(z * (high - low), z * z + low * high) - z * (mean_high - mean_low)
            w0 += w0_high - w0_low
            w1 += w1_high - w1_low
        return c, w0, w1

    return edge_integrals
