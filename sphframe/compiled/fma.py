"""Compiled: the fused multiply-add, which compiled loops ask for by name."""

# mypy: disable-error-code="no-untyped-call, untyped-decorator"

from typing import Any

from numba import types
from numba.extending import lower_builtin, type_callable

__all__ = ["fma"]


def fma(a: float, b: float, c: float) -> float:
    """Return a b + c, in a compiled function as one instruction that rounds once.

    Why not leave it to the compiler (fast-math's "contract"): it then decides for itself which product goes with which
    sum, and decided differently in the process that compiled a loop than for the loop's copy in the cache on disk.
    Loops compiled without any fast-math have the same bits wherever they run. In plain Python it rounds twice.
    """
    return a * b + c


@type_callable(fma)
def _type_fma(context: Any) -> Any:
    return lambda a, b, c: types.float64


@lower_builtin(fma, types.Float, types.Float, types.Float)
def _lower_fma(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return builder.fma(*arguments)
