"""Kernels: the renormalised Gaussian."""

import math
from dataclasses import dataclass
from typing import ClassVar

from sphframe.compiled import fast_exp
from sphframe.interfaces import Kernel
from sphframe.interfaces.edge_integrals import EdgeFunction, ScalarFunction, edge_quadrature

_AT_CUT_OFF = math.exp(-9.0)


def _value(q: float) -> float:
    return max(fast_exp(-q * q) - _AT_CUT_OFF, 0.0)  # at the very cut-off round-off would make it negative


def _gradient(q: float) -> float:
    return -2.0 * fast_exp(-q * q)


def _gradient_of_square(s: float) -> float:
    return -2.0 * fast_exp(-s)


def _mean(q: float) -> float:
    s = max(q * q, 1e-300)
    return 0.5 * ((1.0 - fast_exp(-s)) / s - _AT_CUT_OFF)


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
        """Return the integrals over an edge by quadrature, with the closed mean 2 k = (1 - exp(-q^2))/q^2 - exp(-9)."""
        return edge_quadrature(_value, self.support, _mean)

    def normalisation(self, dim: int) -> float:
        """Return sigma_d for dim 1, 2 or 3."""
        integral = (
            math.sqrt(math.pi) * math.erf(3.0) - 6.0 * _AT_CUT_OFF,
            math.pi * (1.0 - 10.0 * _AT_CUT_OFF),
            math.pi**1.5 * math.erf(3.0) - 42.0 * math.pi * _AT_CUT_OFF,
        )[dim - 1]
        return 1.0 / integral
