"""Every kernel: unit integral, gradient, smoothness at the cut-off, and the same values compiled and plain."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from sphframe.compiled import compile_part
from sphframe.interfaces import Kernel
from sphframe.kernels.gaussian import RenormalisedGaussian
from sphframe.kernels.spline import CubicSpline, QuinticSpline
from sphframe.kernels.wendland import WendlandC2, WendlandC4
from sphframe.testing.kernels import kernel_gradient_factor, kernel_value

KERNELS = [RenormalisedGaussian(), WendlandC2(), WendlandC4(), CubicSpline(), QuinticSpline()]
every_kernel = pytest.mark.parametrize("kernel", KERNELS, ids=lambda kernel: type(kernel).__name__)


@every_kernel
@pytest.mark.parametrize("dim", [1, 2, 3])
def test_integral_is_one(kernel: Kernel, dim: int) -> None:
    h = 0.7
    shell = {1: lambda r: 2.0, 2: lambda r: 2.0 * math.pi * r, 3: lambda r: 4.0 * math.pi * r * r}[dim]
    integral = sum(
        quad(lambda r: float(kernel_value(kernel, r, h, dim)) * shell(r), a * h, (a + 1) * h, epsabs=0, epsrel=1e-12)[0]
        for a in range(round(kernel.support))
    )
    assert integral == pytest.approx(1.0, abs=1e-12), f"the {dim}-D normalisation is wrong by a factor {integral}"


@every_kernel
@given(fraction=st.floats(1e-3, 1.0 - 1e-3), dim=st.sampled_from([1, 2, 3]), h=st.floats(1e-3, 10.0))
def test_gradient_is_the_derivative_of_the_value(kernel: Kernel, fraction: float, dim: int, h: float) -> None:
    r = fraction * kernel.support * h
    step = 1e-5 * h
    numerical = (kernel_value(kernel, r + step, h, dim) - kernel_value(kernel, r - step, h, dim)) / (2.0 * step)
    # central differences lose a few digits to cancellation and to the splines' jumps in the third derivative
    slope_scale = kernel_value(kernel, 0.0, h, dim) / h
    assert kernel_gradient_factor(kernel, r, h, dim) * r == pytest.approx(numerical, abs=1e-8 * float(slope_scale))


@every_kernel
def test_gradient_factor_is_finite_at_the_centre(kernel: Kernel) -> None:
    gradient = kernel.gradient_function()
    assert math.isfinite(gradient(0.0))
    assert gradient(0.0) == pytest.approx(gradient(1e-6), rel=1e-5)


@every_kernel
def test_decreases_from_the_centre_to_zero_at_the_cut_off(kernel: Kernel) -> None:
    values = kernel_value(kernel, np.linspace(0.0, kernel.support, 200), 1.0, 2)
    assert np.all(np.diff(values) < 0.0)
    assert kernel.value_function()(kernel.support * (1.0 - 1e-12)) == pytest.approx(0.0, abs=1e-12)
    assert np.all(kernel_value(kernel, [kernel.support, 5.0], 1.0, 2) == 0.0)
    assert np.all(kernel_gradient_factor(kernel, [kernel.support, 5.0], 1.0, 2) == 0.0)


@every_kernel
def test_compiled_functions_agree_with_plain_ones(kernel: Kernel) -> None:
    q = np.linspace(0.0, kernel.support, 50, endpoint=False)
    for function in (kernel.value_function(), kernel.gradient_function(), kernel.gradient_of_square_function()):
        compiled = compile_part(function)
        assert [compiled(v) for v in q] == pytest.approx([function(v) for v in q], rel=1e-13, abs=1e-15)


@every_kernel
def test_gradient_of_the_square(kernel: Kernel) -> None:
    q = np.linspace(0.0, kernel.support, 50, endpoint=False)
    gradient, of_square = kernel.gradient_function(), kernel.gradient_of_square_function()
    assert [of_square(v * v) for v in q] == pytest.approx([gradient(v) for v in q], rel=1e-13, abs=1e-15)


def test_gaussian_constants_of_the_literature() -> None:
    kernel = RenormalisedGaussian()
    assert 1.0 / kernel.normalisation(1) == pytest.approx(1.77167, abs=5e-6)
    assert 1.0 / kernel.normalisation(2) == pytest.approx(math.pi * (1.0 - 10.0 * math.exp(-9.0)), rel=1e-15)
    assert 1.0 / kernel.normalisation(3) == pytest.approx(5.55192, abs=5e-6)


def test_arrays_keep_their_shape() -> None:
    assert kernel_value(WendlandC2(), np.zeros((2, 3)), 1.0, 2).shape == (2, 3)
    assert kernel_value(WendlandC2(), 0.5, 1.0, 2).shape == ()
