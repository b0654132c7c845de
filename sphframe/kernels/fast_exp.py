"""Kernels: an exponential made of multiplications alone, for kernels that are evaluated a hundred million times."""

import math

import numba

__all__ = ["fast_exp"]

_AT_CENTRE = math.exp(-4.5)
_C2, _C3, _C4, _C5, _C6, _C7, _C8, _C9, _C10 = (1.0 / math.factorial(k) for k in range(2, 11))


@numba.njit(error_model="numpy", fastmath={"contract", "nsz"})
def fast_exp(x: float) -> float:
    """Return exp(x) for -9 <= x <= 0, with a relative error below 2e-14.

    exp(x) = exp(-4.5) (exp y)^32 with y = (x + 4.5)/32, and exp y by its Taylor polynomial of degree 10 about zero,
    whose remainder for |y| <= 9/64 is below 2e-17.

    Why not ``math.exp``: without Intel's SVML, which the LLVM from PyPI lacks, Numba calls the C library once for
    every value. Measured in a compiled loop over 4 million values: 5.9 ns a value by ``math.exp``, 3.1 ns by this
    function in a dependent sum and 0.5 ns where the loop vectorises.

    Examples
    --------
    >>> abs(fast_exp(-1.0) / math.exp(-1.0) - 1.0) < 2e-14
    True
    """
    y = (x + 4.5) * 0.03125
    y2 = y * y
    y4 = y2 * y2
    # grouped after Estrin: fewer operations wait for each other than in Horner's scheme
    p = (
        ((1.0 + y) + y2 * (_C2 + _C3 * y))
        + y4 * ((_C4 + _C5 * y) + y2 * (_C6 + _C7 * y))
        + (y4 * y4) * (_C8 + _C9 * y + _C10 * y2)
    )
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    return _AT_CENTRE * p
