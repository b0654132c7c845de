"""Runs of sphframe on a CUDA device."""

from sphframe_cuda.system import CudaSystem

__all__ = ["CudaSystem"]
