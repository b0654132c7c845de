"""Slices of borrowed arrays read and write the array itself, and its memory is released once, by its owner."""

import sys
import weakref

import numba
import numpy as np

from sphframe.compiled import borrowed


@numba.njit
def _doubled(array):
    own = borrowed(array)
    for k in range(array.shape[0]):
        part = own[k : k + 1]
        part[0] *= 2.0
    return own[1:].sum()


def test_borrowed_slices_are_those_of_the_array():
    array = np.arange(4.0)
    owners = sys.getrefcount(array)
    assert _doubled(array) == 12.0
    assert array.tolist() == [0.0, 2.0, 4.0, 6.0]
    assert sys.getrefcount(array) == owners
    gone = weakref.ref(array)
    del array
    assert gone() is None
