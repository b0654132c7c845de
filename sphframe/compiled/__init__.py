"""Compiled: the tools with which the loops of Numba are written."""

from sphframe.compiled.distance import nearest, offset_between, squared_distance
from sphframe.compiled.fast_exp import fast_exp
from sphframe.compiled.fma import fma
from sphframe.compiled.lanes import LANES
from sphframe.compiled.local_array import local_array
from sphframe.compiled.specialise import compile_part, fingerprint, specialise

__all__ = [
    "LANES",
    "compile_part",
    "fast_exp",
    "fingerprint",
    "fma",
    "local_array",
    "nearest",
    "offset_between",
    "specialise",
    "squared_distance",
]
