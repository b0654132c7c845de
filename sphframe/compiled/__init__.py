"""Compiled: the tools with which the loops of Numba are written."""

from sphframe.compiled import cache  # before any loop is declared
from sphframe.compiled.avx512 import prefer_avx512
from sphframe.compiled.borrowed import borrowed
from sphframe.compiled.distance import nearest, offset_between, squared_distance, whole
from sphframe.compiled.fast_exp import fast_exp
from sphframe.compiled.fma import fma
from sphframe.compiled.lanes import LANES
from sphframe.compiled.local_array import local_array
from sphframe.compiled.specialise import compile_part, fingerprint, specialise
from sphframe.compiled.threaded import threaded, threaded_if_long
from sphframe.compiled.threads import default_threads, prefer_fair_threads, use_threads

prefer_fair_threads()
