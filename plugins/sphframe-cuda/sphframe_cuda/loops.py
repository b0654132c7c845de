"""Loop templates as CUDA kernels.

A template is a function that loops over rows with ``numba.prange``. As a kernel, each of T threads t takes the rows t,
t + T, t + 2 T, ...: the name ``numba`` of the copy stands for a module whose ``prange`` gives these. One particle takes
the place of a cluster of LANES. All functions that the template calls, those of kernels, methods and treatments among
them, are copied in the same way; ``fma``, ``local_array``, ``borrowed`` and ``whole`` have counterparts of CUDA.
"""

# mypy: disable-error-code="no-untyped-call, attr-defined"

import types
from collections.abc import Callable, Mapping
from functools import cache, partial
from typing import Any

import numba
import numpy as np
from numba import cuda
from numba.core.dispatcher import Dispatcher

from sphframe.devices import borrowed, fma, local_array, whole

SIMULATED = bool(numba.config.ENABLE_CUDASIM)
"""whether Numba's simulator runs the kernels, in Python"""
THREADS = 2 if SIMULATED else 128
"""threads of a block"""
_BLOCKS_PER_UNIT = 16
"""blocks for each multiprocessor"""
_CONSTANTS = {"LANES": 1, "BLOCK": 1}
numba.config.CUDA_LOW_OCCUPANCY_WARNINGS = 0
_FAR = np.iinfo(np.int64).max


def _prange(stop):  # type: ignore[no-untyped-def]
    return range(cuda.grid(1), stop, cuda.gridsize(1))


def _fma(a, b, c):  # type: ignore[no-untyped-def]
    return cuda.fma(a, b, c)


def _local_array(size):  # type: ignore[no-untyped-def]
    return cuda.local.array(size, numba.float64)


def _whole(x):  # type: ignore[no-untyped-def]
    return cuda.libdevice.floor(x)


def _borrowed(array):  # type: ignore[no-untyped-def]
    return array


def _no_result(loop):  # type: ignore[no-untyped-def]
    def kernel(out, arguments):  # type: ignore[no-untyped-def]
        loop(*arguments)

    return kernel


def _sum(loop):  # type: ignore[no-untyped-def]
    def kernel(out, arguments):  # type: ignore[no-untyped-def]
        cuda.atomic.add(out, 0, loop(*arguments))

    return kernel


def _least(loop):  # type: ignore[no-untyped-def]
    def kernel(out, arguments):  # type: ignore[no-untyped-def]
        cuda.atomic.min(out, 0, loop(*arguments))

    return kernel


def _largest(loop):  # type: ignore[no-untyped-def]
    def kernel(out, arguments):  # type: ignore[no-untyped-def]
        cuda.atomic.max(out, 0, loop(*arguments))

    return kernel


def _largest_two(loop):  # type: ignore[no-untyped-def]
    def kernel(out, arguments):  # type: ignore[no-untyped-def]
        first, second = loop(*arguments)
        cuda.atomic.max(out, 0, first)
        cuda.atomic.max(out, 1, second)

    return kernel


def _least_three_and_sum(loop):  # type: ignore[no-untyped-def]
    def kernel(out, arguments):  # type: ignore[no-untyped-def]
        a, b, c, count = loop(*arguments)
        cuda.atomic.min(out, 0, a)
        cuda.atomic.min(out, 1, b)
        cuda.atomic.min(out, 2, c)
        cuda.atomic.add(out, 3, count)

    return kernel


_RESULTS: dict[str, tuple[Callable[..., Any], Any]] = {
    "put_back": (_sum, np.zeros(1, np.int64)),
    "first_bad_ghost": (_least, np.full(1, _FAR)),
    "list_particles": (_largest, np.zeros(1, np.int64)),
    "list_points": (_largest, np.zeros(1, np.int64)),
    "largest_motion": (_largest_two, np.zeros(2)),
    "check_fluid": (_least_three_and_sum, np.array([_FAR, _FAR, _FAR, 0])),
}
"""templates that return numbers: how those of all threads are joined, and what they are joined to"""


class Loop:
    """A template as a CUDA kernel, with the names in ``parts`` bound; compiled at its first call.

    Its arguments are arrays of the device, numbers, and tuples of these; each keeps its type from call to call. It is
    always ``parallel``. ``launches`` counts the calls of all loops.
    """

    launches = 0

    def __init__(
        self, template: Callable[..., Any], parts: Mapping[str, object] | None = None, *, parallel: bool = True
    ) -> None:
        self._template, self._parts = _plain(template), {**(parts or {}), **_CONSTANTS}
        self._join, self._start = _RESULTS.get(self._template.__name__, (_no_result, np.zeros(0)))
        self._kernel: Any = None
        self._out: Any = None

    def __call__(self, *arguments: Any) -> Any:
        """Run the loop; return what it returns."""
        if self._kernel is None:
            kernel = self._join(_copied(self._template, self._parts, {}))
            self._out = cuda.to_device(self._start if len(self._start) else np.zeros(1))
            signature = numba.void(type_of(self._start), type_of(arguments))
            self._kernel = (cuda.jit(kernel) if SIMULATED else cuda.jit(signature)(kernel))[_blocks(), THREADS]
        if len(self._start):
            self._out.copy_to_device(self._start)
        Loop.launches += 1
        self._kernel(self._out, arguments)
        if not len(self._start):
            return None
        found = self._out.copy_to_host()
        return found[0] if len(found) == 1 else tuple(found.tolist())


def type_of(value: Any) -> Any:
    """Return the type of an argument; no order is assumed of arrays, empty ones too, unless only C has it."""
    if SIMULATED:
        return numba.void
    if isinstance(value, tuple):
        return numba.types.BaseTuple.from_types(tuple(map(type_of, value)), type(value))
    kind = numba.typeof(value)
    if isinstance(kind, numba.types.Array) and kind.ndim > 1 and (kind.layout != "C" or min(value.shape) < 2):
        return kind.copy(layout="A")
    return kind


@cache
def _blocks() -> int:
    if SIMULATED:
        return 2
    return int(_BLOCKS_PER_UNIT * cuda.get_current_device().MULTIPROCESSOR_COUNT)


def _plain(item: Any) -> Any:
    """Return the Python function behind a template or a compiled function; anything else as it is."""
    if isinstance(item, Dispatcher):
        item = item.py_func
    return getattr(item, "__wrapped__", item) if isinstance(item, types.FunctionType) else item


@cache
def _counterparts() -> dict[Any, Any]:
    """What stands on the device for functions of sphframe; the simulator computes with these themselves."""
    inlined = partial(cuda.jit, device=True, inline="always")
    loops = types.ModuleType("loops")
    loops.prange = inlined(_prange)
    own = {fma: _fma, local_array: _local_array, borrowed: _borrowed, _plain(whole): _whole}
    return {numba: loops, **({} if SIMULATED else {name: inlined(one) for name, one in own.items()})}


def _copied(plain: types.FunctionType, bound: Mapping[str, object], made: dict[Any, Any]) -> Any:
    """Return a device function: a copy of ``plain`` whose names, ``bound`` or its own, are those of the device."""
    used = _names(plain.__code__)
    scope = {**plain.__globals__, **bound}
    for name in used & scope.keys():
        scope[name] = _on_device(scope[name], made)
    closure = plain.__closure__ and tuple(types.CellType(_on_device(c.cell_contents, made)) for c in plain.__closure__)
    copy = types.FunctionType(plain.__code__, scope, plain.__name__, plain.__defaults__, closure)
    copy.__qualname__, copy.__module__ = plain.__qualname__, plain.__module__
    return copy if SIMULATED else cuda.jit(copy, device=True)


def _on_device(item: Any, made: dict[Any, Any]) -> Any:
    plain = _plain(item)
    if not isinstance(plain, types.FunctionType | types.ModuleType):
        return item
    if plain in _counterparts():
        return _counterparts()[plain]
    if isinstance(plain, types.ModuleType):
        return item
    if plain not in made:
        made[plain] = _copied(plain, {}, made)
    return made[plain]


def _names(code: types.CodeType) -> set[str]:
    inner = (_names(constant) for constant in code.co_consts if isinstance(constant, types.CodeType))
    return set(code.co_names).union(*inner)
