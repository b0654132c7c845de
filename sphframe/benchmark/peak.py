"""Benchmark: measured peak rates of the machine: multiply-adds and reading from memory."""

import time
from dataclasses import dataclass

import numba
import numpy as np

from sphframe.benchmark.timing import Spread
from sphframe.compiled import fma, local_array

_CHAINS = 128
"""numbers that are multiplied and added to independently: enough to fill all pipelines"""
_ROUNDS = 1_000_000
_STREAM = 1 << 24
"""numbers that are read in one pass, 134 MB: more than any cache holds"""


@dataclass(frozen=True)
class Peak:
    """Of one thread, in double precision: ``multiply_adds`` per second, and ``bytes_read`` from memory per second."""

    multiply_adds: Spread
    bytes_read: Spread


def measure_peak(repeats: int) -> Peak:
    """Measure both, one sample per repeat."""
    values = np.ones((_STREAM // _CHAINS, _CHAINS))
    _multiply_add(1)
    _read(values[:1])
    rounds, streams = [], []
    for _ in range(repeats):
        began = time.perf_counter()
        _multiply_add(_ROUNDS)
        half = time.perf_counter()
        _read(values)
        streams.append(8.0 * _STREAM / (time.perf_counter() - half))
        rounds.append(_CHAINS * _ROUNDS / (half - began))
    return Peak(Spread(tuple(rounds)), Spread(tuple(streams)))


@numba.njit(cache=True)
def _multiply_add(rounds):  # type: ignore[no-untyped-def]
    chains = local_array(_CHAINS)
    for k in range(_CHAINS):
        chains[k] = k
    for _ in range(rounds):
        for k in range(_CHAINS):
            chains[k] = fma(chains[k], 0.5, 1.0)
    total = 0.0
    for k in range(_CHAINS):
        total += chains[k]
    return total


@numba.njit(cache=True)
def _read(values):  # type: ignore[no-untyped-def]
    sums = local_array(_CHAINS)
    for k in range(_CHAINS):
        sums[k] = 0.0
    for block in range(values.shape[0]):
        for k in range(_CHAINS):
            sums[k] += values[block, k]
    total = 0.0
    for k in range(_CHAINS):
        total += sums[k]
    return total
