"""Neighbours: a grid of cells, each at least as wide as the search radius.

The cells of one grid row are numbered consecutively along the last axis, so three neighbouring cells of a row are one
range of the sorted particles. One ring of empty cells surrounds the grid: no loop checks a border.
"""

import math
from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

__all__ = ["Grid", "assign_cells", "counting_sort", "grid_around"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Grid:
    """A grid of cubic cells: ``origin`` (3,) of cell (0, 0, 0), edge ``cell`` in m, ``shape`` (3,) cells per axis.

    In 2-D the first axis has one cell, so that x and y are the second and third axis of one source.
    """

    origin: Array
    cell: float
    shape: tuple[int, int, int]

    @property
    def count(self) -> int:
        """Number of cells."""
        return self.shape[0] * self.shape[1] * self.shape[2]


def grid_around(lower: Array, upper: Array, radius: float) -> Grid:
    """Return the grid whose inner cells cover the box ``lower`` .. ``upper`` (dim,)."""
    dim = len(lower)
    origin = np.zeros(3)
    shape = [1, 1, 1]
    for k in range(dim):
        axis = 3 - dim + k
        shape[axis] = math.floor((upper[k] - lower[k]) / radius) + 4
        origin[axis] = lower[k] - 1.001 * radius  # round-off must not put the lowest particle into the ring
    return Grid(origin, radius, (shape[0], shape[1], shape[2]))


@numba.njit(parallel=True, cache=True)
def assign_cells(rows, dim, origin, cell, shape, cells):  # type: ignore[no-untyped-def]
    """Write the cell number of each row's position to ``cells``; -1 outside the inner cells and their ring."""
    for i in numba.prange(cells.shape[0]):
        number = 0
        for k in range(3):
            index = 0
            if k >= 3 - dim:
                offset = (rows[i, k - 3 + dim] - origin[k]) / cell
                if not (offset >= 0.0 and offset < shape[k]):
                    number = -1
                    break
                index = int(offset)
            number = number * shape[k] + index
        cells[i] = number


@numba.njit(cache=True)
def counting_sort(cells, starts, order):  # type: ignore[no-untyped-def]
    """Sort by cell, keeping the order within one: ``order[starts[c]:starts[c + 1]]`` are the members of cell c.

    Members of cell -1 are left out. Returns the number of sorted members.
    """
    starts[:] = 0
    for i in range(cells.shape[0]):
        if cells[i] >= 0:
            starts[cells[i] + 1] += 1
    for c in range(starts.shape[0] - 1):
        starts[c + 1] += starts[c]
    total = starts[-1]
    for i in range(cells.shape[0] - 1, -1, -1):  # backwards, so that starts[c + 1] counts down to the first member
        c = cells[i]
        if c >= 0:
            starts[c + 1] -= 1
            order[starts[c + 1]] = i
    for c in range(starts.shape[0] - 1):
        starts[c] = starts[c + 1]
    starts[-1] = total
    return total
