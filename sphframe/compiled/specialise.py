"""Compiled: joins parts (kernel, equation of state, method) into one compiled loop, cached on disk.

Numba caches a function under its qualified name and the time stamp of its file. It never finds a function in that
cache if the function received another one as an argument or in a closure, and it does not notice that a called function
has changed. Therefore a loop is written as a *template*: a plain function whose parts are global names. The names are
bound in a copy of its globals, and the qualified name of the copy contains a hash of everything that the copy can
reach (byte code, constants, closure values, global values, called functions). So the next process finds the compiled
loop, and an edited part gives another loop.
"""

import hashlib
import sys
import types
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeVar, cast

import numba
import numpy as np
from numba.core.caching import NullCache
from numba.core.dispatcher import Dispatcher

F = TypeVar("F", bound=Callable[..., Any])

_parts: dict[str, Any] = {}
_loops: dict[str, Callable[..., Any]] = {}
_FIXED = {"numpy", "numba", "llvmlite", "scipy", *sys.stdlib_module_names}
"""packages whose code is taken as fixed: of what they define, only the names are hashed"""


def specialise(
    template: Callable[..., Any], parts: Mapping[str, object], *, parallel: bool = True
) -> Callable[..., Any]:
    """Compile ``template`` with the names in ``parts`` bound as globals.

    Parameters
    ----------
    template
        a function of a module that uses the names in ``parts`` as globals.
    parts
        functions (compiled here when they are plain Python) and constants (numbers, strings, booleans, tuples).
    parallel
        whether ``numba.prange`` in the template runs on several threads. While Numba uses one thread, the loop is
        compiled without threads, which takes less than half the time.

    Returns
    -------
    Callable[..., Any]
        The compiled function; the same object for the same template and equal parts.
    """
    bound = {name: compile_part(part) if callable(part) else part for name, part in parts.items()}
    function = _rebind(template, bound)
    parallel = parallel and numba.get_num_threads() > 1
    key = f"{fingerprint(function)}{'p' if parallel else 's'}"
    if key not in _loops:
        function.__qualname__ = f"{template.__qualname__}_{key}"
        _loops[key] = numba.njit(parallel=parallel, cache=True, error_model="numpy")(function)
    return _loops[key]


def compile_part(function: F, *, inlined: bool = False) -> F:
    """Compile one part for use inside loops; a function with the same fingerprint is compiled once per process.

    A loop into which it is ``inlined`` leaves out what it does not use of the results.
    """
    if isinstance(function, Dispatcher) or numba.config.DISABLE_JIT:  # type: ignore[attr-defined]
        return function
    return cast(F, _compiled_once(function, {"error_model": "numpy", "forceinline": inlined}))


def _compiled_once(function: Any, options: dict[str, Any]) -> Any:
    """Compile a copy of ``function``, and of the compiled functions in its closure, under a name that is its own.

    Numba distinguishes machine code by qualified name and a counter that starts at the same number in every process.
    Without the hash in the name, a loop from the cache on disk may contain a function of the same name with other
    closure values, which would then run in its place.
    """
    key = fingerprint(function) + ("i" if options.get("forceinline") else "")
    if key not in _parts:
        copy = _rebind(function, {})
        copy.__qualname__ = f"{copy.__qualname__}_{key}"
        _parts[key] = numba.jit(**{"nopython": True, **options})(copy)
    return _parts[key]


def _own(item: Any) -> Any:
    """Return an item of a closure; functions are compiled, under unique names if they were made inside a function."""
    if isinstance(item, types.FunctionType):
        return compile_part(item)
    if isinstance(item, Dispatcher) and "<locals>" in item.py_func.__qualname__:
        return _compiled_once(item, item.targetoptions)
    return item


def fingerprint(function: Any) -> str:
    """Return a hash of all that the compiled form of ``function`` depends on."""
    digest = hashlib.sha256()
    for piece in _pieces(function, set()):
        digest.update(piece.encode())
        digest.update(b"\0")
    return digest.hexdigest()[:20]


def _rebind(template: Callable[..., Any], bound: dict[str, Any]) -> types.FunctionType:
    plain = template.py_func if isinstance(template, Dispatcher) else template
    assert isinstance(plain, types.FunctionType)
    closure = plain.__closure__ and tuple(types.CellType(_own(cell.cell_contents)) for cell in plain.__closure__)
    copy = types.FunctionType(
        plain.__code__, {**plain.__globals__, **bound}, plain.__name__, plain.__defaults__, closure
    )
    copy.__module__, copy.__qualname__ = plain.__module__, plain.__qualname__
    return copy


def _pieces(item: Any, seen: set[int]) -> Iterator[str]:
    """Walk over everything that determines compiled code, as strings in a fixed order."""
    if isinstance(item, Dispatcher):
        if not (item.py_func.__module__ or "").startswith("sphframe."):
            # its own cache on disk does not notice that what it calls has changed
            item._cache = NullCache()  # type: ignore[attr-defined]
        for option in sorted(item.targetoptions):
            yield from _pieces((option, item.targetoptions[option]), seen)
    item = _source(item)
    if isinstance(item, types.FunctionType | type | types.ModuleType):
        name = f"{getattr(item, '__module__', '')} {getattr(item, '__qualname__', item.__name__)}"
        if id(item) in seen:
            yield f"again {name}"
            return
        seen.add(id(item))
        yield name.split("<locals>")[-1]
    if isinstance(item, types.FunctionType):
        if _is_fixed(item.__module__):
            return
        yield from _pieces((item.__defaults__, tuple((item.__kwdefaults__ or {}).items())), seen)
        yield from _code_pieces(item.__code__, item.__doc__)
        for name, cell in zip(item.__code__.co_freevars, item.__closure__ or (), strict=True):
            yield name
            yield from _pieces(cell.cell_contents, seen)
        yield from _used(item.__globals__, _names(item.__code__), seen)
    elif isinstance(item, type) and hasattr(item, "class_type"):  # a jitclass
        yield from _pieces((repr(item.class_type), *item.class_type.methods.values()), seen)
    elif isinstance(item, np.ndarray):
        yield f"array {item.dtype} {item.shape} {item.tobytes().hex()}"
    elif isinstance(item, tuple):
        yield f"{type(item).__qualname__} {len(item)}"
        for part in item:
            yield from _pieces(part, seen)
    elif not isinstance(item, types.ModuleType):  # its name says all, and its text depends on where it is installed
        yield _constant(item)


def _source(item: Any) -> Any:
    """Return the Python function behind what Numba's decorators return; anything else as it is."""
    if isinstance(item, property | staticmethod | classmethod):
        item = item.fget if isinstance(item, property) else item.__func__
    for attribute in ("_dispatcher", "py_func", "_pyfunc", "_defn"):  # vectorize, njit, guvectorize; cfunc; intrinsic
        if type(item).__module__.startswith("numba."):
            item = getattr(item, attribute, item)
    return item


def _used(scope: Mapping[str, Any], names: set[str], seen: set[int]) -> Iterator[str]:
    """Walk over what ``names`` mean in ``scope``, and over the attributes of modules and classes with these names."""
    for name in sorted(names & scope.keys()):
        item = scope[name]
        yield name
        yield from _pieces(item, seen)
        own = item.__name__ if isinstance(item, types.ModuleType) else getattr(item, "__module__", "")
        if isinstance(item, types.ModuleType | type) and not _is_fixed(own):
            found = {key: getattr(item, key) for key in names if hasattr(item, key)}
            yield from _used(found, names - {name}, seen)


def _is_fixed(module: str | None) -> bool:
    return (module or "").partition(".")[0] in _FIXED


def _names(code: types.CodeType) -> set[str]:
    """Return the names of globals and attributes that ``code`` and the functions inside of it use."""
    inner = (_names(constant) for constant in code.co_consts if isinstance(constant, types.CodeType))
    return set(code.co_names).union(*inner)


def _constant(item: Any) -> str:
    """Text of a constant; sets are put in order, which otherwise changes from process to process."""
    if isinstance(item, set | frozenset):
        item = sorted(map(_constant, item))
    elif isinstance(item, tuple):
        item = [_constant(part) for part in item]
    return f"{type(item).__qualname__} {item!r}"


def _code_pieces(code: types.CodeType, docstring: str | None = None) -> Iterator[str]:
    yield code.co_code.hex()
    yield repr((code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars))
    constants = code.co_consts
    if docstring is not None and constants[:1] == (docstring,):
        constants = (None, *constants[1:])  # as without a docstring, which changes nothing that is computed
    for constant in constants:
        if isinstance(constant, types.CodeType):
            yield from _code_pieces(constant)
        else:
            yield _constant(constant)
