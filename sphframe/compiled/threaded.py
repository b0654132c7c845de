"""Compiled: loops without parts that run on several threads."""

import functools
from collections.abc import Callable
from typing import Any

import numba

from sphframe.compiled.specialise import specialise


def threaded(loop: Callable[..., Any], *, least: int = 0) -> Callable[..., Any]:
    """Compile ``loop`` when it is called, see :func:`~sphframe.compiled.specialise`: for one thread or for several.

    It runs on one if its first argument has less than ``least`` rows.
    """
    compiled = functools.cache(lambda several: specialise(loop, {}, parallel=several))

    @functools.wraps(loop)
    def call(*arguments: Any) -> Any:
        return compiled(numba.get_num_threads() > 1 and len(arguments[0]) >= least)(*arguments)

    return call


LONG = 20_000
"""rows from which loops with little work per row use threads, whose start takes 10 to 20 us, as long as 5,000 rows"""
threaded_if_long = functools.partial(threaded, least=LONG)
