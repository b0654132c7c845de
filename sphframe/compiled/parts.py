"""Compiled: what a component returns to be compiled is checked first, where the mistake can be named."""

import inspect
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from sphframe.errors import BrokenPluginError


def checked_function(owner: object, maker: str, function: Any, arguments: Sequence[str]) -> Any:
    """Return ``function``, which the method ``maker`` of ``owner`` has returned, or which is that method.

    Raises
    ------
    BrokenPluginError
        when it is not a function of the ``arguments``.
    """
    plain = getattr(function, "py_func", function)
    where = f"{type(owner).__name__}.{maker}"
    expected = f"expected a function of ({', '.join(arguments)})"
    if not inspect.isroutine(plain):
        hint = ": is its last line, 'return' and the name of the function, missing?" if plain is None else ""
        raise BrokenPluginError(f"{where} returned {plain!r:.80}; {expected}{hint}")
    try:
        inspect.signature(plain).bind(*arguments)
    except TypeError as error:
        given = f"{plain.__name__}{inspect.signature(plain)}"
        raise BrokenPluginError(f"{where}: {given} ({place_of(plain)}); {expected}: {error}") from None
    except ValueError:  # a function that is not written in Python
        pass
    return function


def checked_scalar(owner: object, maker: str, function: Any, arguments: Sequence[str], sample: Sequence[float]) -> Any:
    """Return ``function`` as :func:`checked_function` does, if it returns a number for the ``sample``."""
    checked_function(owner, maker, function, arguments)
    plain = getattr(function, "py_func", function)
    try:
        with np.errstate(all="ignore"):
            value = plain(*sample)
    except Exception:
        return function  # what Numba compiles need not run in plain Python
    check_result(owner, maker, plain, value, "a number", isinstance(value, float | int | np.number))
    return function


def check_result(owner: object, maker: str, plain: Any, value: Any, expected: str, sound: bool) -> None:
    """Raise a BrokenPluginError that names the function unless its result is ``sound``."""
    if not sound:
        hint = ": a 'return' is missing" if value is None else ""
        raise BrokenPluginError(
            f"{type(owner).__name__}.{maker}: {plain.__name__} ({place_of(plain)}) returns {value!r:.80}; expected"
            f" {expected}{hint}"
        )


def place_of(function: Callable[..., Any]) -> str:
    """Return file and line of a function."""
    code = getattr(function, "__code__", None)
    return f"{code.co_filename}, line {code.co_firstlineno}" if code else "not in Python"
