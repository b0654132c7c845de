"""Edge integrals of every kernel against 20 digits of mpmath, and the sums over edges of polygons."""

import math

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from sphframe.interfaces import Kernel
from sphframe.kernels import compiled_kernel
from sphframe.kernels.gaussian import RenormalisedGaussian
from sphframe.kernels.spline import CubicSpline, QuinticSpline
from sphframe.kernels.wendland import WendlandC2, WendlandC4
from sphframe.testing.wall_integrals import wall_integrals

KERNELS = [RenormalisedGaussian(), WendlandC2(), WendlandC4(), CubicSpline(), QuinticSpline()]
every_kernel = pytest.mark.parametrize("kernel", KERNELS, ids=lambda kernel: type(kernel).__name__)

TRUNCATED_POWERS: dict[type[Kernel], list[tuple[int, int, mpmath.mpf]]] = {
    CubicSpline: [(2, 3, mpmath.mpf(1) / 4), (1, 3, mpmath.mpf(-1))],
    QuinticSpline: [(3, 5, mpmath.mpf(1)), (2, 5, mpmath.mpf(-6)), (1, 5, mpmath.mpf(15))],
    WendlandC2: [(2, 4, mpmath.mpf(5) / 16), (2, 5, mpmath.mpf(-1) / 8)],
    WendlandC4: [(2, 6, mpmath.mpf(14) / 48), (2, 7, mpmath.mpf(-11) / 48), (2, 8, mpmath.mpf(35) / 768)],
}
"""w(q) as the sum of factor (cut - q)^power for q < cut, a form that the project does not use"""


def exact(kernel: Kernel, z: float, a: float, b: float) -> tuple[float, float, float]:
    """The three integrals times sigma_2: sectors behind the edge in polar coordinates, and integrals along it."""
    support, knots = int(kernel.support), [0.0, *(side * z * 10.0**k for side in (-1, 1) for k in range(1, 9))]
    for cut in range(1, support + 1):
        half = math.sqrt(max(cut * cut - z * z, 0.0))
        knots += [-half, half]
    ends = sorted(min(max(s, -half), half) for s in {a, b, *(s for s in knots if a < s < b)})

    def value(q):
        if isinstance(kernel, RenormalisedGaussian):
            return mpmath.exp(-q * q) - mpmath.exp(-9)
        return sum(f * (cut - q) ** n for cut, n, f in TRUNCATED_POWERS[type(kernel)] if q < cut)

    def outside(r):
        """The integral of w q dq from r to R."""
        if isinstance(kernel, RenormalisedGaussian):
            return (mpmath.exp(-r * r) - mpmath.exp(-9) - mpmath.exp(-9) * (9 - r * r)) / 2 if r < 3 else 0
        return sum(
            f * (cut * (cut - r) ** (n + 1) / (n + 1) - (cut - r) ** (n + 2) / (n + 2))
            for cut, n, f in TRUNCATED_POWERS[type(kernel)]
            if r < cut
        )

    with mpmath.workdps(20):
        sigma = kernel.normalisation(2)
        angles = [mpmath.atan(s / mpmath.mpf(abs(z))) for s in ends]
        c = math.copysign(1.0, z) * mpmath.quad(lambda t: outside(abs(z) / mpmath.cos(t)), angles)
        w0 = mpmath.quad(lambda s: value(mpmath.hypot(s, z)), ends)
        w1 = mpmath.quad(lambda s: s * value(mpmath.hypot(s, z)), ends)
        return float(sigma * c), float(sigma * w0), float(sigma * w1)


def integrals(kernel: Kernel, z: float, a: float, b: float) -> np.ndarray:
    """The compiled integrals, times sigma_2."""
    return kernel.normalisation(2) * np.array(compiled_kernel(kernel, 2).edge_integrals(z, a, b))


EDGES = [
    (0.3, -0.5, 0.5), (1e-9, -1.0, 0.4), (1e-3, 0.2, 5.0), (-0.1, -4.0, 0.7), (0.9, -4.0, 4.0), (-0.4, 0.01, 1.7),
    (1.2, 0.5, 0.6), (1.9, -0.3, 0.2), (2.2, -1.3, 3.0), (50.0, -1.0, 1e3), (0.1, 40.0, 50.0),
]  # fmt: skip


@every_kernel
def test_edge_integrals_to_twelve_digits(kernel: Kernel) -> None:
    for edge in EDGES:
        assert integrals(kernel, *edge) == pytest.approx(exact(kernel, *edge), abs=1e-12), edge


@every_kernel
def test_the_default_is_a_quadrature_of_stated_accuracy(kernel: Kernel) -> None:
    default = Kernel.edge_integrals_function(kernel)
    accuracy = 1e-12 if isinstance(kernel, RenormalisedGaussian) else 3e-5
    for edge in EDGES:
        given = kernel.normalisation(2) * np.array(default(*edge))
        assert given == pytest.approx(integrals(kernel, *edge), abs=accuracy), edge


@every_kernel
def test_plain_and_compiled_integrals_agree(kernel: Kernel) -> None:
    plain = kernel.edge_integrals_function()
    for edge in EDGES:
        assert kernel.normalisation(2) * np.array(plain(*edge)) == pytest.approx(integrals(kernel, *edge), abs=1e-13)


def test_published_values_of_wendland_c2() -> None:
    # the values of a straight wall, and of one edge
    kernel = WendlandC2()
    assert integrals(kernel, 0.3, -0.5, 0.5)[1] == pytest.approx(0.405539189395677, abs=1e-14)
    for z, gamma in ((0.0, 0.5), (0.1, 0.573814664954130), (1.0, 0.971490937043549), (2.0, 1.0)):
        assert 1.0 - integrals(kernel, z, -9.0, 9.0)[0] == pytest.approx(gamma, abs=1e-14)
    assert integrals(kernel, 0.0, -9.0, 9.0)[1] == pytest.approx(7.0 / (3.0 * math.pi), abs=1e-14)


def test_ferrands_form_of_the_gradient_of_gamma() -> None:
    z, a, b = 0.3, -0.5, 1.1

    def primitive(s):
        x, z2 = math.hypot(s, z), z * z
        p = 7 / 192 * x**5 - 21 / 64 * x**4 + 35 / 32 * x**3 - 35 / 24 * x**2 + 7 / 4
        p += z2 * (35 / 768 * x**3 - 7 / 16 * x**2 + 105 / 64 * x - 35 / 12) + z2 * z2 * (35 / 512 * x - 7 / 8)
        return (s * p + z2 * z2 * (105 / 64 + 35 / 512 * z2) * math.asinh(s / z)) / math.pi

    assert integrals(WendlandC2(), z, a, b)[1] == pytest.approx(primitive(b) - primitive(a), abs=1e-14)


numbers = st.floats(-3.5, 3.5).map(lambda x: round(x, 12))  # the product of two such lengths does not underflow


@every_kernel
@settings(max_examples=60)
@given(z=numbers, ends=st.tuples(numbers, numbers, numbers))
@example(z=0.0, ends=(-1.0, 0.0, 1.0))
@example(z=1e-12, ends=(-1.0, 1e-12, 1.0))
def test_edges_may_be_divided(kernel: Kernel, z: float, ends: tuple[float, float, float]) -> None:
    a, middle, b = sorted(ends)
    whole = integrals(kernel, z, a, b)
    parts = integrals(kernel, z, a, middle) + integrals(kernel, z, middle, b)
    if z == 0.0 and a < 0.0 < b and middle == 0.0:
        whole[0] = parts[0] = 0.0  # a point on the edge is at the end of both halves, which then have no angle
    assert np.all(np.isfinite(whole))
    assert whole == pytest.approx(parts, abs=1e-12)


@every_kernel
@settings(max_examples=60)
@given(z=st.floats(0.2, 3.2), a=numbers, length=st.floats(0.0, 4.0))
def test_the_gradient_is_the_difference_of_gamma(kernel: Kernel, z: float, a: float, length: float) -> None:
    # c changes by -w0 dz, and by the potential of the two ends: moved along the edge by ds, it loses what it passes
    step, b = 1e-5, a + length
    slope = (integrals(kernel, z + step, a, b)[0] - integrals(kernel, z - step, a, b)[0]) / (2 * step)
    shift = (integrals(kernel, z, a + step, b + step)[0] - integrals(kernel, z, a - step, b - step)[0]) / (2 * step)

    def mean(s):
        """g(r)/r^2 at the end of an edge."""
        q, value = math.hypot(z, s), kernel.value_function()
        return kernel.normalisation(2) * quad(lambda x: value(x) * x, q, kernel.support, points=knots(q))[0] / q**2

    def knots(q):
        return [k for k in range(1, int(kernel.support)) if k > q] or None

    ends = [mean(s) if math.hypot(z, s) < kernel.support else 0.0 for s in (a, b)]
    _, w0, _ = integrals(kernel, z, a, b)
    assert shift == pytest.approx(z * (ends[1] - ends[0]), abs=1e-6)
    assert slope == pytest.approx(a * ends[0] - b * ends[1] - w0, abs=1e-6)


SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
PENTAGON = np.array([[0.0, 0.0], [0.9, -0.1], [1.1, 0.7], [0.4, 0.35], [-0.1, 0.8]])  # with a corner that juts in


def of(polygon: np.ndarray, points: object, kernel: Kernel, h: float = 0.1):
    return wall_integrals(kernel, h, np.atleast_2d(points), polygon, np.roll(polygon, -1, axis=0))


@every_kernel
def test_inside_on_a_wall_in_a_corner_and_outside(kernel: Kernel) -> None:
    gamma, gradient, moment = of(SQUARE, [[0.5, 0.5], [0.5, 0.0], [0.0, 0.0], [0.5, -0.5]], kernel)
    assert gamma == pytest.approx([1.0, 0.5, 0.25, 0.0], abs=1e-13)
    assert gradient[[0, 3]] == pytest.approx(np.zeros((2, 2)), abs=1e-12)
    assert gradient[1, 0] == pytest.approx(0.0, abs=1e-12)
    assert gradient[1, 1] > 0.0
    assert moment[0] == pytest.approx(np.zeros((2, 2)), abs=1e-13)
    assert moment[3] == pytest.approx(np.eye(2), abs=1e-13)


@every_kernel
@settings(max_examples=40)
@given(x=st.floats(-0.3, 1.3), y=st.floats(-0.3, 1.1))
def test_polygons_of_any_shape(kernel: Kernel, x: float, y: float) -> None:
    gamma, gradient, moment = of(PENTAGON, [x, y], kernel)
    assert -1e-12 < gamma[0] < 1.0 + 1e-12
    assert moment[0, 0, 1] == pytest.approx(moment[0, 1, 0], abs=1e-12)
    step = 1e-6
    around = of(PENTAGON, [[x + step, y], [x - step, y], [x, y + step], [x, y - step]], kernel).gamma
    assert gradient[0] == pytest.approx((around[::2] - around[1::2]) / (2 * step), abs=1e-6)


def test_the_moment_of_the_solid_behind_a_straight_wall() -> None:
    gamma, gradient, moment = of(SQUARE * 10.0 - [5.0, 0.0], [[0.0, 0.1]], WendlandC2())
    assert moment[0, 0, 0] == pytest.approx(1.0 - gamma[0], abs=1e-14)
    assert moment[0, 1, 1] == pytest.approx(1.0 - gamma[0] + 0.1 * gradient[0, 1], abs=1e-14)
    assert moment[0, 1, 1] == pytest.approx(0.164840, abs=5e-7)


def test_gamma_of_a_polygon_is_the_integral_over_it() -> None:
    # brute force: the kernel summed over a fine lattice in the square
    n, point = 2000, np.array([0.93, 0.04])
    x, y = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n)
    q = np.hypot(x - point[0], y - point[1]) / 0.1
    w = np.where(q < 2.0, (1 - q / 2) ** 4 * (1 + 2 * q), 0.0) * WendlandC2().normalisation(2) / 0.01
    assert of(SQUARE, point, WendlandC2()).gamma[0] == pytest.approx(w.sum() / n**2, abs=1e-5)
