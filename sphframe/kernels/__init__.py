"""Kernels: the smoothing kernels, and their compiled functions."""

from sphframe.compiled import compile_part
from sphframe.interfaces import CompiledKernel, Kernel

__all__ = ["compiled_kernel"]


def compiled_kernel(kernel: Kernel, dim: int) -> CompiledKernel:
    """Return the compiled functions and the constants of ``kernel`` in ``dim`` dimensions."""
    return CompiledKernel(
        compile_part(kernel.value_function()),
        compile_part(kernel.gradient_function()),
        kernel.support,
        kernel.normalisation(dim),
        compile_part(kernel.gradient_of_square_function()),
        compile_part(kernel.edge_integrals_function()) if dim == 2 else None,
    )
