"""Arrays of the device; with Numba's simulator they are those of NumPy."""

# mypy: disable-error-code="no-untyped-call"

from typing import Any, Literal

import numpy as np
from numba import cuda

from sphframe import InputError
from sphframe_cuda.loops import SIMULATED


def check_device() -> None:
    """Raise an InputError if there is no device."""
    if not cuda.is_available():
        raise InputError(
            'device "cuda": no CUDA device was found; install its driver and numba-cuda (python -m pip install'
            " 'numba-cuda[cu13]'), see python -m numba -s, or run with device \"cpu\""
        )


def room(shape: tuple[int, ...], kind: Any = np.float64, *, order: Literal["C", "F"] = "C") -> Any:
    """Return an array on the device whose content is not defined; with ``order`` "F" its first index runs fastest."""
    return (np.empty if SIMULATED else cuda.device_array)(shape, kind, order=order)


def put(array: Any) -> Any:
    """Return a copy of ``array`` on the device."""
    if SIMULATED:
        return np.array(array)
    return cuda.to_device(np.ascontiguousarray(array))


def put_into(array: Any, target: Any) -> None:
    """Copy ``array`` to ``target``, an array of the device of the same shape."""
    if SIMULATED:
        target[...] = array
    elif target.size:
        target.copy_to_device(np.ascontiguousarray(array))


def fetched(array: Any) -> Any:
    """Return a copy of an ``array`` of the device for the processor."""
    return np.array(array) if SIMULATED else array.copy_to_host()
