"""Kernels: the smoothing kernels; their compiled functions, and their values on NumPy arrays."""

import numpy as np
from numpy.typing import ArrayLike

from sphframe.arrays import Array
from sphframe.compiled import compile_part
from sphframe.interfaces import CompiledKernel, Kernel
from sphframe.interfaces.kernel import ScalarFunction

__all__ = ["compiled_kernel", "kernel_gradient_factor", "kernel_value"]


def compiled_kernel(kernel: Kernel, dim: int) -> CompiledKernel:
    """Return the compiled functions and the constants of ``kernel`` in ``dim`` dimensions."""
    return CompiledKernel(
        compile_part(kernel.value_function()),
        compile_part(kernel.gradient_function()),
        kernel.support,
        kernel.normalisation(dim),
        compile_part(kernel.gradient_of_square_function()),
    )


def kernel_value(kernel: Kernel, distance: ArrayLike, smoothing_length: float, dim: int) -> Array:
    """Return W(r, h) = sigma_d / h^d w(r/h), zero from the cut-off on.

    Parameters
    ----------
    kernel: any kernel.
    distance: r >= 0, in m; any shape.
    smoothing_length: h, in m.
    dim: 1, 2 or 3.

    Returns
    -------
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
