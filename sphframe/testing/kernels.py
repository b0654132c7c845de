"""Testing: kernels, one check function per property; their values on NumPy arrays."""

import itertools
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from sphframe.arrays import Array
from sphframe.compiled import compile_part
from sphframe.interfaces import Kernel
from sphframe.interfaces.edge_integrals import ScalarFunction, edge_quadrature
from sphframe.kernels import compiled_kernel
from sphframe.testing.evaluation import title
from sphframe.testing.proof import require


def check_unit_integral(kernel: Kernel) -> None:
    """The integral of W is one in one, two and three dimensions."""
    value = kernel.value_function()
    for dim, sphere in ((1, 2.0), (2, 2.0 * math.pi), (3, 4.0 * math.pi)):
        integral = kernel.normalisation(dim) * _integral(value, dim - 1, kernel.support) * sphere
        require(
            abs(integral - 1.0) < 1e-9,
            f"{title(kernel)}: the integral of W in {dim}-D is {integral:.12g}, not 1: correct normalisation({dim})",
        )


def check_moments(kernel: Kernel) -> None:
    """The second moment is positive and less than with all mass at the cut-off radius: W is a smoothing kernel."""
    value = kernel.value_function()
    for dim, sphere in ((1, 2.0), (2, 2.0 * math.pi), (3, 4.0 * math.pi)):
        moment = kernel.normalisation(dim) * _integral(value, dim + 1, kernel.support) * sphere
        require(
            0.0 < moment < kernel.support**2,
            f"{title(kernel)}: the second moment of W in {dim}-D is {moment:.6g} h^2, outside of 0 .."
            f" {kernel.support**2:g}",
        )


def check_gradient(kernel: Kernel) -> None:
    """The gradient factor is the derivative of the value divided by q, and finite at the centre."""
    value, factor = kernel.value_function(), kernel.gradient_function()
    largest = max(abs(value(q)) for q in (0.0, 0.5 * kernel.support))
    for q in np.linspace(0.013, 0.987, 57) * kernel.support:
        step = 1e-5 * kernel.support
        slope = (value(q + step) - value(q - step)) / (2.0 * step)
        given = factor(q) * q
        require(
            abs(slope - given) < 1e-6 * largest,
            f"{title(kernel)}: at q = {q:.6g} the gradient function times q is {given:.9g}, but differences of the"
            f" value give {slope:.9g}; it must return w'(q)/q",
        )
    nodes, weights = np.polynomial.legendre.leggauss(6)
    knots = np.linspace(0.0, kernel.support, 1201)
    for low, high in itertools.pairwise(knots.tolist()):  # no band of q escapes
        points = 0.5 * (low + high) + 0.5 * (high - low) * nodes
        rise = 0.5 * (high - low) * float(weights @ np.array([factor(q) * q for q in points.tolist()]))
        found = value(min(high, kernel.support * (1.0 - 1e-15))) - value(low)
        require(
            abs(found - rise) < 1e-7 * largest * (high - low) / kernel.support + 1e-13 * largest,
            f"{title(kernel)}: between q = {low:.6g} and {high:.6g} the value changes by {found:.9g}, but the integral"
            f" of the gradient function times q is {rise:.9g}; it must return w'(q)/q",
        )
    centre = factor(0.0)
    require(
        math.isfinite(centre) and abs(centre - factor(1e-4)) < 1e-3 * abs(centre),
        f"{title(kernel)}: the gradient function is {centre} at q = 0 and {factor(1e-4)} at q = 0.0001; return the"
        f" limit w''(0)",
    )
    of_square = kernel.gradient_of_square_function()
    for q in np.linspace(0.0, 0.999, 37) * kernel.support:
        require(
            math.isclose(of_square(float(q * q)), factor(float(q)), rel_tol=1e-9, abs_tol=1e-12 * abs(centre)),
            f"{title(kernel)}: at q = {q:.6g} the gradient function of q^2 gives {of_square(float(q * q))}, that of q"
            f" {factor(float(q))}",
        )


def check_compact_support(kernel: Kernel) -> None:
    """The value decreases to zero at the cut-off."""
    value = kernel.value_function()
    edge = value(kernel.support * (1.0 - 1e-9))
    require(
        abs(edge) < 1e-6 * value(0.0), f"{title(kernel)}: w is {edge:.3g} at the cut-off q = {kernel.support:g}, not 0"
    )


def check_monotone(kernel: Kernel) -> None:
    """The value is positive and decreases from the centre to the cut-off."""
    value = kernel.value_function()
    q = np.linspace(0.0, 0.9999, 400) * kernel.support
    values = np.array([value(x) for x in q])
    require(bool(np.all(values > 0.0)), f"{title(kernel)}: w is not positive at q = {q[np.argmin(values)]:.6g}")
    rises = np.flatnonzero(np.diff(values) >= 0.0)
    require(not len(rises), f"{title(kernel)}: w does not decrease at q = {q[rises[0]] if len(rises) else 0.0:.6g}")


def check_edge_integrals(kernel: Kernel) -> None:
    """The compiled integrals over the edges of walls agree with a quadrature of the value in plain Python."""
    given = compile_part(kernel.edge_integrals_function())
    quadrature = edge_quadrature(kernel.value_function(), kernel.support)
    sigma, reach = kernel.normalisation(2), kernel.support
    for z, a, b in ((0.0, -1.0, 1.0), (0.1, -1.0, 0.3), (-0.3, 0.2, 0.5), (0.7, -0.6, -0.1), (1.1, 0.0, 1.0)):
        edge = z * reach, a * reach, b * reach
        for name, one, other in zip(("c", "w0", "w1"), given(*edge), quadrature(*edge), strict=True):
            require(
                abs(sigma * (one - other)) < 1e-4,
                f"{title(kernel)}: the edge integral {name} at z, a, b = {edge} is {one:.9g}, by quadrature of the"
                f" value {other:.9g}; correct edge_integrals_function, or leave it out",
            )


def check_compiles(kernel: Kernel) -> None:
    """The compiled functions and plain Python return the same values."""
    compiled_kernel(kernel, 2)
    for function in (kernel.value_function(), kernel.gradient_function(), kernel.gradient_of_square_function()):
        compiled = compile_part(function)
        for q in np.linspace(0.0, 0.999, 37) * kernel.support:
            require(
                math.isclose(compiled(float(q)), function(float(q)), rel_tol=1e-9, abs_tol=1e-12),
                f"{title(kernel)}: at q = {q:.6g}, compiled {compiled(float(q))} and plain Python {function(float(q))}"
                f" differ",
            )


def _integral(value: Callable[[float], float], power: int, upper: float) -> float:
    """The integral of w(q) q^power by Gauss-Legendre in 60 pieces; the knots of the usual splines lie between them."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    width = upper / 60
    total = 0.0
    for k in range(60):
        q = width * (k + 0.5 + 0.5 * nodes)
        total += 0.5 * width * float(weights @ np.array([value(float(x)) * x**power for x in q]))
    return total


CHECKS: dict[str, Callable[[Kernel], None]] = {
    "compiles": check_compiles,
    "unit_integral": check_unit_integral,
    "moments": check_moments,
    "gradient": check_gradient,
    "compact_support": check_compact_support,
    "monotone": check_monotone,
    "edge_integrals": check_edge_integrals,
}
"""the checks of a kernel, by the name of the property"""


def kernel_value(kernel: Kernel, distance: ArrayLike, smoothing_length: float, dim: int) -> Array:
    """Return W(r, h) = sigma_d / h^d w(r/h), zero from the cut-off on.

    Parameters
    ----------
    kernel
        any kernel.
    distance
        r >= 0, in m; any shape.
    smoothing_length
        h, in m.
    dim
        1, 2 or 3.

    Returns
    -------
    Array
        W, in m^-dim, with the shape of ``distance``.

    Examples
    --------
    >>> from sphframe.kernels.wendland import WendlandC2
    >>> kernel_value(WendlandC2(), [0.0, 1.0, 2.0], smoothing_length=1.0, dim=2).round(4)
    array([0.557 , 0.1044, 0.    ])
    """
    scale = kernel.normalisation(dim) / smoothing_length**dim
    return _within_support(kernel.value_function(), kernel.support, distance, smoothing_length, scale)


def kernel_gradient_factor(kernel: Kernel, distance: ArrayLike, smoothing_length: float, dim: int) -> Array:
    """Return F(r, h) = sigma_d / h^(d+2) w'(q)/q, such that grad W(x) = F(|x|, h) x.

    Parameters, shapes and an example as for :func:`kernel_value`; the unit is m^-(dim+2). F is finite at r = 0.
    """
    scale = kernel.normalisation(dim) / smoothing_length ** (dim + 2)
    return _within_support(kernel.gradient_function(), kernel.support, distance, smoothing_length, scale)


def _within_support(
    function: ScalarFunction, support: float, distance: ArrayLike, smoothing_length: float, scale: float
) -> Array:
    q = np.asarray(distance, dtype=np.float64) / smoothing_length
    inside = q < support
    values = np.zeros_like(q)
    values[inside] = [scale * function(float(q_j)) for q_j in q[inside]]
    return values
