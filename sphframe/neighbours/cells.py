"""Neighbours: a grid of cells, half as wide as the search radius, and the order of particles along it.

Cells are numbered along the last axis, row after row, every other row backwards: consecutive cells touch, and so do
particles sorted by cell. The cells of one row that a box overlaps are always one range of numbers.
"""

import math
from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

__all__ = ["Grid", "assign_cells", "cell_number", "counting_sort", "grid_around"]

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


def grid_around(lower: Array, upper: Array, cell: float, margin: float) -> Grid:
    """Return the grid whose cells cover the box ``lower`` .. ``upper`` (dim,) and ``margin`` around it."""
    dim = len(lower)
    origin = np.zeros(3)
    shape = [1, 1, 1]
    for k in range(dim):
        axis = 3 - dim + k
        origin[axis] = lower[k] - margin - 0.001 * cell  # round-off must not put the lowest particle outside
        shape[axis] = math.floor((upper[k] + margin - origin[axis]) / cell) + 1
    return Grid(origin, cell, (shape[0], shape[1], shape[2]))


@numba.njit(inline="always")
def row_number(shape, a, b):  # type: ignore[no-untyped-def]
    """Return the number of the row of cells (a, b, :)."""
    return a * shape[1] + (shape[1] - 1 - b if a % 2 else b)


@numba.njit(inline="always")
def cell_number(shape, row, c):  # type: ignore[no-untyped-def]
    """Return the number of the cell with index ``c`` in a row."""
    return row * shape[2] + (shape[2] - 1 - c if row % 2 else c)


@numba.njit(parallel=True, cache=True)
def assign_cells(rows, dim, origin, cell, shape, cells):  # type: ignore[no-untyped-def]
    """Write the cell number of each row's position to ``cells``; -1 outside the grid."""
    for i in numba.prange(cells.shape[0]):
        inside = True
        a = b = c = 0
        for k in range(dim):
            axis = 3 - dim + k
            offset = (rows[i, k] - origin[axis]) / cell
            if not (offset >= 0.0 and offset < shape[axis]):
                inside = False
                break
            index = int(offset)
            if axis == 0:
                a = index
            elif axis == 1:
                b = index
            else:
                c = index
        cells[i] = cell_number(shape, row_number(shape, a, b), c) if inside else -1


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
