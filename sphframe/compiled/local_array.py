"""Compiled: scratch memory for weights functions, which must not allocate."""

# mypy: disable-error-code="no-untyped-call, untyped-decorator"

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.errors import TypingError
from numba.extending import lower_builtin, type_callable

from sphframe.arrays import Array
from sphframe.errors import InputError

LARGEST = 8192
"""most floats that a local array may hold"""


def local_array(size: int) -> Array:
    """Return an uninitialised array of ``size`` floats that lives until the calling function returns.

    In a compiled function the array lies on the stack: its allocation takes no time, threads do not wait for each
    other, and the compiler may keep the array in registers. Therefore ``size`` must be a number that is known when the
    function is compiled, such as a variable of the enclosing function, and the function must not return the array. In
    plain Python it is an ordinary array.

    The largest size is 8192 (64 KiB): the stack of a thread may be small, and an array beyond it ends the process.

    Numba would allocate ``numpy.empty`` on the heap for every evaluation point (measured for the 3 by 3 matrix of 40
    neighbours: 85 ns per point instead of 23 ns).
    """
    if not 0 < size <= LARGEST:
        raise InputError(_refused(size))
    return np.empty(size)


def _refused(size: int) -> str:
    return (
        f"local_array({size}): give a size from 1 to {LARGEST}, since the array lies on the stack, which is small;"
        " what depends on the number of neighbours fits into out, or is computed twice"
    )


@type_callable(local_array)
def _type_local_array(context: Any) -> Any:
    def typer(size: Any) -> Any:
        if isinstance(size, types.IntegerLiteral) and not 0 < size.literal_value <= LARGEST:
            raise TypingError(_refused(size.literal_value))
        return types.Array(types.float64, 1, "C") if isinstance(size, types.IntegerLiteral) else None

    return typer


@lower_builtin(local_array, types.IntegerLiteral)
def _lower_local_array(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    size = signature.args[0].literal_value
    array = context.make_array(signature.return_type)(context, builder)
    integer = context.get_value_type(types.intp)
    array.data = cgutils.alloca_once(builder, ir.DoubleType(), size=size)
    array.meminfo = cgutils.get_null_value(array.meminfo.type)
    array.parent = cgutils.get_null_value(array.parent.type)
    array.nitems = integer(size)
    array.itemsize = integer(8)
    array.shape = cgutils.pack_array(builder, [integer(size)])
    array.strides = cgutils.pack_array(builder, [integer(8)])
    return array._getvalue()
