"""Kernels: the renormalised Gaussian."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from sphframe.compiled import fast_exp, local_array
from sphframe.interfaces import Kernel
from sphframe.interfaces.edge_integrals import EdgeFunction, ScalarFunction

_AT_CUT_OFF = math.exp(-9.0)


def _value(q: float) -> float:
    return max(fast_exp(-q * q) - _AT_CUT_OFF, 0.0)  # at the very cut-off round-off would make it negative


def _gradient(q: float) -> float:
    return -2.0 * fast_exp(-q * q)


def _gradient_of_square(s: float) -> float:
    return -2.0 * fast_exp(-s)


_NODES, _LONGEST = 8, 1.25
"""points of the quadrature on each part of an edge, and its longest part over h, for errors at round-off"""
_x, _y = np.polynomial.legendre.leggauss(_NODES)
_MOST = _NODES * math.ceil(6.0 / _LONGEST + 1.0)
_PLACES, _WEIGHTS = 0.5 * _x, 0.5 * _y
_CENTRE = 0.5 * (1.0 - 10.0 * _AT_CUT_OFF)
"""g(0) = int_0^3 w(q) q dq"""


def _edge_integrals(z: float, a: float, b: float) -> tuple[float, float, float]:
    half = math.sqrt(max(9.0 - z * z, 0.0))
    a, b = min(max(a, -half), half), min(max(b, -half), half)
    if not a < b:
        return 0.0, 0.0, 0.0
    count = int((b - a) / _LONGEST) + 1
    part = (b - a) / count
    squares, bells, means = local_array(_MOST), local_array(_MOST), local_array(_MOST)
    for k in range(count):
        middle = a + (k + 0.5) * part
        for m in range(_NODES):
            s = middle + part * _PLACES[m]
            squares[k * _NODES + m] = z * z + s * s
    for m in range(count * _NODES):  # without sums, so that it vectorises
        square = min(max(squares[m], 1e-300), 9.0)
        value = fast_exp(-square)
        bells[m] = value
        means[m] = (1.0 - value) / square
    bell = mean = 0.0
    for k in range(count):
        first, last = k * _NODES, (k + 1) * _NODES - 1
        for m in range(_NODES // 2):
            bell += _WEIGHTS[m] * (bells[first + m] + bells[last - m])
            mean += _WEIGHTS[m] * (means[first + m] + means[last - m])
    start, end = min(z * z + a * a, 9.0), min(z * z + b * b, 9.0)
    c = _CENTRE * math.atan2(z * (b - a), z * z + a * b) - 0.5 * z * (part * mean - _AT_CUT_OFF * (b - a))
    w1 = 0.5 * (fast_exp(-start) - fast_exp(-end) - _AT_CUT_OFF * (end - start))
    return c, part * bell - _AT_CUT_OFF * (b - a), w1


@dataclass(frozen=True)
class RenormalisedGaussian(Kernel):
    """The Gaussian cut off at 3h, shifted to be zero there, and normalised again (Eq. 7 of Huang et al. 2019).

    With q = r/h::

        w(q) = exp(-q^2) - exp(-9),   w'(q)/q = -2 exp(-q^2),   q < 3

        1/sigma_1 = sqrt(pi) erf(3) - 6 e^-9            = 1.77167
        1/sigma_2 = pi (1 - 10 e^-9)                    = 3.13772
        1/sigma_3 = pi^(3/2) erf(3) - 42 pi e^-9        = 5.55192

    Departs from the paper: the printed normalisation gives a unit integral in two dimensions only; those above
    are the closed integrals in each. The slope jumps from -6 e^-9 = -7.4e-4 to zero at the cut-off.

    Source: Molteni & Colagrossi (2009), doi:10.1016/j.cpc.2008.12.004; Huang et al. (2019).

    Examples
    --------
    >>> kernel = RenormalisedGaussian()
    >>> [round(kernel.normalisation(2) * kernel.value_function()(q), 5) for q in (0.0, 3.0)]
    [0.31866, 0.0]
    """

    support: ClassVar[float] = 3.0

    def value_function(self) -> ScalarFunction:
        """Return w(q) = exp(-q^2) - exp(-9)."""
        return _value

    def gradient_function(self) -> ScalarFunction:
        """Return w'(q)/q = -2 exp(-q^2)."""
        return _gradient

    def gradient_of_square_function(self) -> ScalarFunction:
        """Return w'(q)/q = -2 exp(-s), s = q^2."""
        return _gradient_of_square

    def edge_integrals_function(self) -> EdgeFunction:
        """Return the integrals over an edge by Gauss-Legendre quadrature along it, with an error at round-off.

        g = R^2 k(R) - q^2 k(q) with 2 k = (1 - exp(-q^2))/q^2 - exp(-9), which is smooth, so that eight points on each
        part of the edge suffice: c = R^2 k(R) [angle from the point to the ends] - z int k ds.
        """
        return _edge_integrals

    def normalisation(self, dim: int) -> float:
        """Return sigma_d for dim 1, 2 or 3."""
        integral = (
            math.sqrt(math.pi) * math.erf(3.0) - 6.0 * _AT_CUT_OFF,
            math.pi * (1.0 - 10.0 * _AT_CUT_OFF),
            math.pi**1.5 * math.erf(3.0) - 42.0 * math.pi * _AT_CUT_OFF,
        )[dim - 1]
        return 1.0 / integral
