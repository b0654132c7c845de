"""Kernels: Wendland's C2 and C4 functions."""

import math
from dataclasses import dataclass
from typing import ClassVar

from sphframe.interfaces import Kernel
from sphframe.interfaces.edge_integrals import EdgeFunction, ScalarFunction
from sphframe.kernels.polynomial import polynomial_edge_integrals


def _c2_value(q: float) -> float:
    s = 1.0 - 0.5 * q
    s2 = s * s
    return s2 * s2 * (2.0 * q + 1.0)


def _c2_gradient(q: float) -> float:
    s = 1.0 - 0.5 * q
    return -5.0 * s * s * s


def _c4_value(q: float) -> float:
    s = 1.0 - 0.5 * q
    s2 = s * s
    return s2 * s2 * s2 * (1.0 + q * (3.0 + q * (35.0 / 12.0)))


def _c4_gradient(q: float) -> float:
    s = 1.0 - 0.5 * q
    s2 = s * s
    return (-14.0 / 3.0) * s2 * s2 * s * (1.0 + 2.5 * q)


@dataclass(frozen=True)
class WendlandC2(Kernel):
    """Wendland's C2 function with cut-off 2h.

    With q = r/h::

        w(q) = (1 - q/2)^4 (1 + 2q),   w'(q)/q = -5 (1 - q/2)^3,   q < 2
        sigma_d = 3/4, 7/(4 pi), 21/(16 pi)

    It is positive definite in up to three dimensions, which keeps particles from pairing. The same function
    is used in 1-D, for which Wendland also gives one of a lower degree.

    Source: Wendland (1995), doi:10.1007/BF02123482; Dehnen & Aly (2012), doi:10.1111/j.1365-2966.2012.21439.x.

    Examples
    --------
    >>> round(WendlandC2().normalisation(2), 6)
    0.557042
    """

    support: ClassVar[float] = 2.0

    def value_function(self) -> ScalarFunction:
        """Return w(q) = (1 - q/2)^4 (1 + 2q)."""
        return _c2_value

    def gradient_function(self) -> ScalarFunction:
        """Return w'(q)/q = -5 (1 - q/2)^3."""
        return _c2_gradient

    def edge_integrals_function(self) -> EdgeFunction:
        """Return the integrals over an edge, in closed form."""
        return polynomial_edge_integrals((2.0, (1.0, 0.0, -5 / 2, 5 / 2, -15 / 16, 1 / 8)))

    def normalisation(self, dim: int) -> float:
        """Return sigma_d for dim 1, 2 or 3."""
        return (3.0 / 4.0, 7.0 / (4.0 * math.pi), 21.0 / (16.0 * math.pi))[dim - 1]


@dataclass(frozen=True)
class WendlandC4(Kernel):
    """Wendland's C4 function with cut-off 2h.

    With q = r/h::

        w(q) = (1 - q/2)^6 (1 + 3q + 35/12 q^2),   w'(q)/q = -14/3 (1 - q/2)^5 (1 + 5q/2),   q < 2
        sigma_d = 27/32, 9/(4 pi), 495/(256 pi)

    It is narrower than C2 at the same cut-off: choose ``smoothing_length_ratio`` 1.6 or more. The same
    function is used in 1-D.

    Source: Wendland (1995), doi:10.1007/BF02123482; Dehnen & Aly (2012), doi:10.1111/j.1365-2966.2012.21439.x.

    Examples
    --------
    >>> round(WendlandC4().normalisation(2), 6)
    0.716197
    """

    support: ClassVar[float] = 2.0

    def value_function(self) -> ScalarFunction:
        """Return w(q) = (1 - q/2)^6 (1 + 3q + 35/12 q^2)."""
        return _c4_value

    def gradient_function(self) -> ScalarFunction:
        """Return w'(q)/q = -14/3 (1 - q/2)^5 (1 + 5q/2)."""
        return _c4_gradient

    def edge_integrals_function(self) -> EdgeFunction:
        """Return the integrals over an edge, in closed form."""
        return polynomial_edge_integrals((2.0, (1.0, 0.0, -7 / 3, 0.0, 35 / 8, -14 / 3, 35 / 16, -1 / 2, 35 / 768)))

    def normalisation(self, dim: int) -> float:
        """Return sigma_d for dim 1, 2 or 3."""
        return (27.0 / 32.0, 9.0 / (4.0 * math.pi), 495.0 / (256.0 * math.pi))[dim - 1]
