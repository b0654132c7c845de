"""The exponential of the kernels: its error, and the same values compiled and in plain Python."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sphframe.compiled import fast_exp


@given(st.floats(-9.0, 0.0))
def test_fast_exp_is_exp(x: float) -> None:
    assert abs(fast_exp(x) / math.exp(x) - 1.0) < 2e-14


def test_fast_exp_is_the_same_in_plain_python() -> None:
    plain = getattr(fast_exp, "py_func", fast_exp)
    for x in np.linspace(-9.0, 0.0, 101):
        assert fast_exp(x) == pytest.approx(plain(float(x)), rel=1e-14)
