"""The fused multiply-add: one rounding in compiled functions, two in plain Python."""

import numba
import pytest

from sphframe.compiled import fma

compiled = numba.njit(lambda a, b, c: fma(a, b, c))


@pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="nothing is compiled")
def test_the_product_is_not_rounded():
    tiny = 2.0**-30
    assert compiled(1.0 + tiny, 1.0 - tiny, -1.0) == -(2.0**-60)


def test_plain_python_computes_the_same_sum():
    assert fma(1.5, 2.0, 0.25) == compiled(1.5, 2.0, 0.25) == 3.25
