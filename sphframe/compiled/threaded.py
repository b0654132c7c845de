"""Compiled: loops without parts that run on several threads."""

import functools
from collections.abc import Callable
from typing import Any

import numba

from sphframe.compiled.specialise import specialise


def threaded(loop: Callable[..., Any]) -> Callable[..., Any]:
    """Compile ``loop`` when it is called, see :func:`~sphframe.compiled.specialise`: for one thread or for several."""
    compiled: dict[bool, Callable[..., Any]] = {}

    @functools.wraps(loop)
    def call(*arguments: Any) -> Any:
        several = numba.get_num_threads() > 1
        if several not in compiled:
            compiled[several] = specialise(loop, {})
        return compiled[several](*arguments)

    return call
