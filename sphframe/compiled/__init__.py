"""Compiled: the tools with which the loops of Numba are written."""

from sphframe.compiled import cache  # noqa: F401  (before any loop is declared)
from sphframe.compiled.avx512 import prefer_avx512
from sphframe.compiled.borrowed import borrowed
from sphframe.compiled.distance import nearest, offset_between, squared_distance
from sphframe.compiled.fast_exp import fast_exp
from sphframe.compiled.fma import fma
from sphframe.compiled.lanes import LANES
from sphframe.compiled.local_array import local_array
from sphframe.compiled.specialise import compile_part, fingerprint, specialise
from sphframe.compiled.threaded import threaded, threaded_if_long
from sphframe.compiled.threads import default_threads, prefer_fair_threads, use_threads

__all__ = [
    "LANES",
    "borrowed",
    "compile_part",
    "default_threads",
    "fast_exp",
    "fingerprint",
    "fma",
    "local_array",
    "nearest",
    "offset_between",
    "prefer_avx512",
    "specialise",
    "squared_distance",
    "threaded",
    "threaded_if_long",
    "use_threads",
]

prefer_fair_threads()
