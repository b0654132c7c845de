"""Compiled: an exponential of multiplications and additions alone, for kernels that are evaluated very often."""

import math

import numba
import numpy as np
from numpy.polynomial import Chebyshev, Polynomial

from sphframe.compiled.fma import fma


def _root_of_exp() -> tuple[float, ...]:
    """Coefficients of a polynomial that is exp(x/32) for -9 <= x <= 0 to 3e-16: its Chebyshev series to degree 8.

    exp(a t) = I_0(a) + 2 sum_k I_k(a) T_k(t) with the modified Bessel functions I_k; here a = 9/64, t = 1 + 2x/9.
    """
    half = 4.5 / 64.0
    bessel = [sum(half ** (2 * m + k) / math.factorial(m) / math.factorial(m + k) for m in range(8)) for k in range(9)]
    series = math.exp(-2.0 * half) * np.array([bessel[0], *(2.0 * value for value in bessel[1:])])
    return tuple(float(c) for c in Chebyshev(series, domain=[-9.0, 0.0]).convert(kind=Polynomial).coef)


_C0, _C1, _C2, _C3, _C4, _C5, _C6, _C7, _C8 = _root_of_exp()


@numba.njit(error_model="numpy")
def fast_exp(x: float) -> float:
    """Return exp(x) for -9 <= x <= 0, with a relative error below 2e-14.

    exp(x) = exp(x/32)^32, and exp(x/32) by a polynomial of degree 8.

    It replaces ``math.exp`` because the binary packages of llvmlite lack Intel's SVML, without which Numba calls the C
    library for every value. Measured in a compiled loop over 4 million values: 5.9 ns per value with ``math.exp``,
    3.1 ns with this function in a sum where each term waits for the one before, and 0.5 ns in a loop that vectorises.

    Examples
    --------
    >>> abs(fast_exp(-1.0) / math.exp(-1.0) - 1.0) < 2e-14
    True
    """
    x2 = x * x
    x4 = x2 * x2
    # Estrin's grouping: fewer operations wait for each other than in Horner's scheme
    low = fma(x2, fma(_C3, x, _C2), fma(_C1, x, _C0))
    high = fma(x4, _C8, fma(x2, fma(_C7, x, _C6), fma(_C5, x, _C4)))
    p = fma(x4, high, low)
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    return p * p
