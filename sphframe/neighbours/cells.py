"""Neighbours: a grid of cells and the order of particles along it.

Cells are numbered along the last axis, row after row, every other row backwards: consecutive cells are adjacent, and
consecutive particles sorted by cell are close together. The cells of one row that a box overlaps are always one range
of numbers. A row is as wide as the cluster of particles that shares a neighbour list, and its cells are half as long,
so that consecutive particles fill a cube and not a long strip.
"""

import math
from typing import NamedTuple

import numba
import numpy as np

from sphframe.arrays import Array, IntArray
from sphframe.compiled import threaded_if_long


class Grid(NamedTuple):
    """A grid of cells: ``origin`` (3,) of cell (0, 0, 0), edges ``cell`` (3,) in m, ``shape`` (3,) cells per axis.

    In 2-D the first axis has one cell, so that x and y are the second and third axis of one source.
    """

    origin: Array
    cell: Array
    shape: IntArray

    @property
    def size(self) -> int:
        """Number of cells."""
        return int(self.shape.prod())


def grid_around(lower: Array, upper: Array, width: float, margin: float) -> Grid:
    """Return the grid, in rows of the given ``width``, that covers the box ``lower`` .. ``upper`` (dim,) and ``margin``
    around it."""
    dim = len(lower)
    origin = np.zeros(3)
    cell = np.array([width, width, 0.5 * width])
    shape = np.ones(3, np.int64)
    for k in range(dim):
        axis = 3 - dim + k
        origin[axis] = lower[k] - margin - 0.001 * width  # round-off must not put the lowest particle outside
        shape[axis] = math.floor((upper[k] + margin - origin[axis]) / cell[axis]) + 1
    return Grid(origin, cell, shape)


@numba.njit(error_model="numpy", forceinline=True)
def row_number(shape, a, b):  # type: ignore[no-untyped-def]
    """Return the number of the row of cells (a, b, :)."""
    return a * shape[1] + (shape[1] - 1 - b if a % 2 else b)


@numba.njit(error_model="numpy", forceinline=True)
def cell_number(shape, row, c):  # type: ignore[no-untyped-def]
    """Return the number of the cell with index ``c`` in a row."""
    return row * shape[2] + (shape[2] - 1 - c if row % 2 else c)


@threaded_if_long
def sort_by_cell(rows, dim, grid, cells, tallies, starts, order):  # type: ignore[no-untyped-def]
    """Sort rows by cell, keeping the order within one: ``order[starts[c]:starts[c + 1]]`` are the members of cell c.

    The rows are counted, and put in their places, in as many parts as ``tallies`` (parts, cells) has; the result does
    not depend on their number. ``cells`` (n,) is scratch; rows outside the grid are left out.
    """
    n = cells.shape[0]
    parts = tallies.shape[0]
    count = tallies.shape[1]
    for part in numba.prange(parts):
        tally = tallies[part]
        tally[:] = 0
        for i in range(part * n // parts, (part + 1) * n // parts):
            inside = True
            a = b = c = 0
            for k in range(dim):
                axis = 3 - dim + k
                offset = (rows[i, k] - grid.origin[axis]) / grid.cell[axis]
                if not (offset >= 0.0 and offset < grid.shape[axis]):
                    inside = False
                    break
                a, b, c = b, c, int(offset)
            cells[i] = cell_number(grid.shape, row_number(grid.shape, a, b), c) if inside else -1
            if inside:
                tally[cells[i]] += 1
    total = 0
    for c in range(count):
        starts[c] = total
        for part in range(parts):
            members = tallies[part, c]
            tallies[part, c] = total
            total += members
    starts[count] = total
    for part in numba.prange(parts):
        tally = tallies[part]
        for i in range(part * n // parts, (part + 1) * n // parts):
            if cells[i] >= 0:
                order[tally[cells[i]]] = i
                tally[cells[i]] += 1
