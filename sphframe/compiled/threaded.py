"""Compiled: loops without parts that run on several threads."""

import functools
from collections.abc import Callable
from typing import Any

import numba

from sphframe.compiled.specialise import specialise


def threaded(loop: Callable[..., Any]) -> Callable[..., Any]:
    """Compile ``loop`` when it is called, see :func:`~sphframe.compiled.specialise`: for one thread or for several."""
    compiled = functools.cache(lambda several: specialise(loop, {}))

    @functools.wraps(loop)
    def call(*arguments: Any) -> Any:
        return compiled(numba.get_num_threads() > 1)(*arguments)

    return call
