"""Compiled: the fused multiply-add as a function."""

# mypy: disable-error-code="no-untyped-call, untyped-decorator"

from typing import Any

from numba import types
from numba.extending import lower_builtin, type_callable


def fma(a: float, b: float, c: float) -> float:
    """Return a b + c, in a compiled function as one instruction that rounds once.

    With fast-math ("contract") the compiler chooses itself which product it fuses with which sum. It chose differently
    in the process that compiled a loop than for the copy of the loop in the cache on disk. Without fast-math a loop
    gives the same bits in every process, so the fusion is written explicitly. In plain Python this function rounds
    twice.
    """
    return a * b + c


@type_callable(fma)
def _type_fma(context: Any) -> Any:
    return lambda a, b, c: types.float64


@lower_builtin(fma, types.Float, types.Float, types.Float)
def _lower_fma(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return builder.fma(*arguments)
