"""Loops without parts are compiled for the threads that they run on."""

import importlib

import numba
import numpy as np
import pytest

from sphframe.compiled import threaded


def doubled(values):
    for i in numba.prange(values.shape[0]):
        values[i] *= 2.0


@pytest.mark.parametrize("threads", [1, numba.config.NUMBA_NUM_THREADS])
def test_a_loop_gives_the_same_on_any_number_of_threads(threads):
    numba.set_num_threads(threads)
    values = np.arange(1000.0)
    threaded(doubled)(values)
    np.testing.assert_array_equal(values, 2.0 * np.arange(1000.0))


def test_a_loop_is_compiled_for_threads_only_where_there_are_several(monkeypatch):
    asked = []
    module = importlib.import_module(threaded.__module__)
    monkeypatch.setattr(module, "specialise", lambda loop, parts: asked.append(1) or loop)
    loop, several = threaded(doubled), numba.config.NUMBA_NUM_THREADS
    for threads in (1, 1, several, several):
        numba.set_num_threads(threads)
        loop(np.zeros(3))
    assert len(asked) == len({1, several})
