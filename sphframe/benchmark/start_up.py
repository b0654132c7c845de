"""Benchmark: time until the end of the first step."""

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from sphframe.benchmark.fresh import Fresh, run_fresh
from sphframe.benchmark.timing import Spread

_IMPORTS = """
import json, time
began = time.perf_counter()
import numpy, numba
libraries = time.perf_counter()
import sphframe
print(json.dumps([libraries - began, time.perf_counter() - libraries]))
"""
_FIRST_STEP = """
import json, time
began = time.perf_counter()
import sphframe
simulation = sphframe.Simulation(sphframe.load_case("dam-break"))
simulation.advance()
print(json.dumps(time.perf_counter() - began))
"""


@dataclass(frozen=True)
class StartUp:
    """Times in s, each measured in a new process.

    Attributes
    ----------
    libraries
        import of NumPy and Numba.
    sphframe
        import of sphframe after them.
    first_compile
        from nothing imported to the end of the first step of the dam break, with an empty compiler cache;
        ``cached``: the same with a full cache; ``cached_process``: ``cached`` with the start and the end of Python.
    """

    libraries: Spread
    sphframe: Spread
    first_compile: float
    cached: Spread
    cached_process: Spread


def measure_start_up(repeats: int, tell: Callable[[str, float | None], None]) -> StartUp:
    """Measure imports, the first compilation of a configuration, and the start with a cache."""
    with tempfile.TemporaryDirectory(prefix="sphframe-bench-") as cache:
        tell("start-up: first compilation", None)
        first = run_fresh(_FIRST_STEP, {"NUMBA_CACHE_DIR": cache}).found
        imports: list[Any] = []
        cached: list[Fresh] = []
        for repeat in range(repeats):
            imports.append(run_fresh(_IMPORTS).found)
            cached.append(run_fresh(_FIRST_STEP, {"NUMBA_CACHE_DIR": cache}))
            tell("start-up: with a cache", (repeat + 1) / repeats)
    libraries, own = zip(*imports, strict=True)
    return StartUp(
        libraries=Spread(tuple(libraries)),
        sphframe=Spread(tuple(own)),
        first_compile=first,
        cached=Spread(tuple(fresh.found for fresh in cached)),
        cached_process=Spread(tuple(fresh.seconds for fresh in cached)),
    )
