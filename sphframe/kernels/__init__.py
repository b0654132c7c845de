"""Kernels: the smoothing kernels, and their compiled functions."""

from sphframe.compiled import compile_part
from sphframe.compiled.parts import checked_scalar
from sphframe.interfaces import CompiledKernel, Kernel

__all__ = ["compiled_kernel"]


def compiled_kernel(kernel: Kernel, dim: int) -> CompiledKernel:
    """Return the compiled functions and the constants of ``kernel`` in ``dim`` dimensions.

    Raises
    ------
    BrokenPluginError
        when a function is none, or does not return a number.
    """
    middle = (0.5 * kernel.support,)
    value = checked_scalar(kernel, "value_function", kernel.value_function(), ("q",), middle)
    gradient = checked_scalar(kernel, "gradient_function", kernel.gradient_function(), ("q",), middle)
    of_square = kernel.gradient_of_square_function()
    return CompiledKernel(
        compile_part(value),
        compile_part(gradient),
        kernel.support,
        kernel.normalisation(dim),
        compile_part(checked_scalar(kernel, "gradient_of_square_function", of_square, ("s",), middle)),
        compile_part(kernel.edge_integrals_function(), inlined=True) if dim == 2 else None,
    )
