"""Kernels: the cubic and the quintic spline."""

import math
from dataclasses import dataclass
from typing import ClassVar

from sphframe.interfaces import Kernel
from sphframe.interfaces.edge_integrals import EdgeFunction, ScalarFunction
from sphframe.kernels.polynomial import polynomial_edge_integrals


def _cubic_value(q: float) -> float:
    if q < 1.0:
        return 1.0 + q * q * (0.75 * q - 1.5)
    s = 2.0 - q
    return 0.25 * s * s * s


def _cubic_gradient(q: float) -> float:
    if q < 1.0:
        return 2.25 * q - 3.0
    s = 2.0 - q
    return -0.75 * s * s / q


def _quintic_value(q: float) -> float:
    if q < 1.0:
        q2 = q * q
        return 66.0 + q2 * (-60.0 + q2 * (30.0 - 10.0 * q))
    s = 3.0 - q
    s2 = s * s
    value = s2 * s2 * s
    if q < 2.0:
        t = 2.0 - q
        t2 = t * t
        value -= 6.0 * t2 * t2 * t
    return value


def _quintic_gradient(q: float) -> float:
    if q < 1.0:
        q2 = q * q
        return -120.0 + q2 * (120.0 - 50.0 * q)
    s2 = (3.0 - q) * (3.0 - q)
    slope = s2 * s2
    if q < 2.0:
        t2 = (2.0 - q) * (2.0 - q)
        slope -= 6.0 * t2 * t2
    return -5.0 * slope / q


@dataclass(frozen=True)
class CubicSpline(Kernel):
    """The cubic B-spline with cut-off 2h.

    With q = r/h::

        w(q) = 1 - 3/2 q^2 + 3/4 q^3   (q < 1),   (2 - q)^3 / 4   (1 <= q < 2)
        sigma_d = 2/3, 10/(7 pi), 1/pi

    Its Fourier transform has zeros: particles may pair when the smoothing length exceeds about 1.3 spacings.

    Source: Monaghan & Lattanzio (1985), Astronomy and Astrophysics 149, 135.

    Examples
    --------
    >>> round(CubicSpline().normalisation(2), 6)
    0.454728
    """

    support: ClassVar[float] = 2.0

    def value_function(self) -> ScalarFunction:
        """Return w(q)."""
        return _cubic_value

    def gradient_function(self) -> ScalarFunction:
        """Return w'(q)/q, -3 at q = 0."""
        return _cubic_gradient

    def edge_integrals_function(self) -> EdgeFunction:
        """Return the integrals over an edge, in closed form, of w = (2 - q)^3/4 - (1 - q)^3."""
        return polynomial_edge_integrals((2.0, (2.0, -3.0, 3 / 2, -1 / 4)), (1.0, (-1.0, 3.0, -3.0, 1.0)))

    def normalisation(self, dim: int) -> float:
        """Return sigma_d for dim 1, 2 or 3."""
        return (2.0 / 3.0, 10.0 / (7.0 * math.pi), 1.0 / math.pi)[dim - 1]


@dataclass(frozen=True)
class QuinticSpline(Kernel):
    """The quintic B-spline with cut-off 3h.

    With q = r/h::

        w(q) = (3 - q)^5 - 6 (2 - q)^5 + 15 (1 - q)^5   (each term only while its bracket is positive)
        sigma_d = 1/120, 7/(478 pi), 1/(120 pi)

    Source: Schoenberg (1946), Quarterly of Applied Mathematics 4, 45; Morris, Fox & Zhu (1997),
    doi:10.1006/jcph.1997.5776.

    Examples
    --------
    >>> round(QuinticSpline().normalisation(2), 6)
    0.004661
    """

    support: ClassVar[float] = 3.0

    def value_function(self) -> ScalarFunction:
        """Return w(q)."""
        return _quintic_value

    def gradient_function(self) -> ScalarFunction:
        """Return w'(q)/q, -120 at q = 0."""
        return _quintic_gradient

    def edge_integrals_function(self) -> EdgeFunction:
        """Return the integrals over an edge, in closed form, of w = (3 - q)^5 - 6 (2 - q)^5 + 15 (1 - q)^5."""
        return polynomial_edge_integrals(
            (3.0, (243.0, -405.0, 270.0, -90.0, 15.0, -1.0)),
            (2.0, (-192.0, 480.0, -480.0, 240.0, -60.0, 6.0)),
            (1.0, (15.0, -75.0, 150.0, -150.0, 75.0, -15.0)),
        )

    def normalisation(self, dim: int) -> float:
        """Return sigma_d for dim 1, 2 or 3."""
        return (1.0 / 120.0, 7.0 / (478.0 * math.pi), 1.0 / (120.0 * math.pi))[dim - 1]
