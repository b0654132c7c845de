"""Neighbours: lists of all particles within the search radius, good until something has crossed half the skin.

A list holds, row by row, first the fluid neighbours and then the ghosts. The search radius is the kernel support
plus the skin, so the lists stay complete while no two particles have approached each other by more than the skin.
"""

import numba
import numpy as np
from numpy.typing import NDArray

from sphframe.neighbours.cells import Grid, assign_cells, counting_sort, grid_around

__all__ = ["NeighbourLists"]

Array = NDArray[np.float64]


class NeighbourLists:
    """Neighbour lists of the fluid particles and of the boundary's evaluation points.

    Attributes
    ----------
    fluid: (n, capacity) uint32; row i holds ``fluid_counts[i]`` fluid neighbours, then ``ghost_counts[i]`` ghosts,
        as indices of rows.
    points: (g, capacity) uint32 fluid neighbours of each evaluation point, ``point_counts`` (g,) of them.
    """

    def __init__(self, dim: int, fluid_count: int, ghost_count: int, support: float, skin: float) -> None:
        self.dim = dim
        self.support = support
        self.skin = skin
        self.fluid_count = fluid_count
        self.ghost_count = ghost_count
        self.fluid = np.empty((fluid_count, 0), np.uint32)
        self.fluid_counts = np.zeros(fluid_count, np.uint32)
        self.ghost_counts = np.zeros(fluid_count, np.uint32)
        self.points = np.empty((ghost_count, 0), np.uint32)
        self.point_counts = np.zeros(ghost_count, np.uint32)
        self.grid = Grid(np.zeros(3), 1.0, (1, 1, 1))
        self.starts = np.zeros(2, np.int64)
        self.rebuilds = 0
        self._cells = np.zeros(fluid_count, np.int64)
        self._order = np.zeros(fluid_count, np.int64)
        self._ghost_cells = np.zeros(ghost_count, np.int64)
        self._ghost_order = np.zeros(ghost_count, np.int64)

    @property
    def radius(self) -> float:
        """Search radius, m."""
        return self.support + self.skin

    def sort(self, rows: Array) -> NDArray[np.int64]:
        """Make the grid around the fluid ``rows`` (n, width) and return the order in which the rows must be put."""
        position = rows[: self.fluid_count, : self.dim]
        self.grid = grid_around(position.min(axis=0), position.max(axis=0), self.radius)
        if self.starts.shape[0] != self.grid.count + 1:
            self.starts = np.zeros(self.grid.count + 1, np.int64)
        assign_cells(rows, self.dim, self.grid.origin, self.grid.cell, self.grid.shape, self._cells)
        counting_sort(self._cells, self.starts, self._order)
        return self._order

    def build(self, rows: Array, evaluation_points: Array) -> None:
        """Build the lists for ``rows`` (n + g, width), whose fluid part is in the order that :meth:`sort` returned."""
        grid, n = self.grid, self.fluid_count
        ghosts = rows[n:]
        assign_cells(ghosts, self.dim, grid.origin, grid.cell, grid.shape, self._ghost_cells)
        ghost_starts = np.zeros(grid.count + 1, np.int64)
        counting_sort(self._ghost_cells, ghost_starts, self._ghost_order)
        stencil = _stencil(grid, self.dim)
        while True:
            longest = _list_particles(
                rows, n, self.dim, self.radius, grid.origin, grid.cell, grid.shape, stencil,
                self.starts, ghost_starts, self._ghost_order, self.fluid, self.fluid_counts, self.ghost_counts,
            )  # fmt: skip
            if longest <= self.fluid.shape[1]:
                break
            self.fluid = np.empty((n, _capacity(longest)), np.uint32)
        self.points = self._around(evaluation_points, rows, self.points, self.point_counts)
        self.rebuilds += 1

    def around(self, points: Array, rows: Array) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        """Return lists (k, capacity) of the fluid near any ``points`` (k, dim) and their lengths (k,)."""
        counts = np.zeros(len(points), np.uint32)
        return self._around(points, rows, np.empty((len(points), 0), np.uint32), counts), counts

    def _around(
        self, points: Array, rows: Array, lists: NDArray[np.uint32], counts: NDArray[np.uint32]
    ) -> NDArray[np.uint32]:
        """List the fluid near ``points`` in ``lists``, or in a longer array where that is too short."""
        grid = self.grid
        while True:
            longest = _list_points(
                points, rows, self.dim, self.radius, grid.origin, grid.cell, grid.shape,
                _stencil(grid, self.dim), self.starts, lists, counts,
            )  # fmt: skip
            if longest <= lists.shape[1]:
                return lists
            lists = np.empty((len(points), _capacity(longest)), np.uint32)


def _capacity(longest: int) -> int:
    """Room for a list of ``longest`` neighbours and some compression."""
    return -(-int(longest * 1.1 + 4) // 8) * 8


def _stencil(grid: Grid, dim: int) -> NDArray[np.int64]:
    """Offsets from a cell to the first cell of each neighbouring run of three cells along the last axis."""
    _, ny, nz = grid.shape
    planes = (0,) if dim == 2 else (-1, 0, 1)
    return np.array([(a * ny + b) * nz - 1 for a in planes for b in (-1, 0, 1)], np.int64)


@numba.njit(parallel=True, cache=True, error_model="numpy")
def _list_particles(  # type: ignore[no-untyped-def]
    rows, n, dim, radius, origin, cell, shape, stencil, starts, ghost_starts, ghost_order, lists, counts, ghost_counts
):
    """List the neighbours of each fluid particle; returns the longest list, which may exceed the capacity."""
    capacity = lists.shape[1]
    limit = radius * radius
    longest = 0
    for i in numba.prange(n):
        x = rows[i, 0]
        y = rows[i, 1]
        z = rows[i, dim - 1]
        if dim == 2:
            c = int((x - origin[1]) / cell) * shape[2] + int((y - origin[2]) / cell)
        else:
            c = (int((x - origin[0]) / cell) * shape[1] + int((y - origin[1]) / cell)) * shape[2]
            c += int((z - origin[2]) / cell)
        found = 0
        for s in range(stencil.shape[0]):
            first = c + stencil[s]
            for j in range(starts[first], starts[first + 3]):
                dx = rows[j, 0] - x
                dy = rows[j, 1] - y
                d2 = dx * dx + dy * dy
                if dim == 3:
                    dz = rows[j, 2] - z
                    d2 += dz * dz
                if d2 < limit and j != i:
                    if found < capacity:
                        lists[i, found] = j
                    found += 1
        counts[i] = found
        for s in range(stencil.shape[0]):
            first = c + stencil[s]
            for k in range(ghost_starts[first], ghost_starts[first + 3]):
                j = n + ghost_order[k]
                dx = rows[j, 0] - x
                dy = rows[j, 1] - y
                d2 = dx * dx + dy * dy
                if dim == 3:
                    dz = rows[j, 2] - z
                    d2 += dz * dz
                if d2 < limit:
                    if found < capacity:
                        lists[i, found] = j
                    found += 1
        ghost_counts[i] = found - counts[i]
        longest = max(longest, found)
    return longest


@numba.njit(parallel=True, cache=True, error_model="numpy")
def _list_points(  # type: ignore[no-untyped-def]
    points, rows, dim, radius, origin, cell, shape, stencil, starts, lists, counts
):
    """List the fluid neighbours of each point; returns the longest list, which may exceed the capacity."""
    capacity = lists.shape[1]
    limit = radius * radius
    longest = 0
    for i in numba.prange(points.shape[0]):
        counts[i] = 0
        x = points[i, 0]
        y = points[i, 1]
        z = points[i, dim - 1]
        c = 0
        inside = True
        for k in range(dim):
            axis = 3 - dim + k
            offset = (points[i, k] - origin[axis]) / cell
            if not (offset >= 0.0 and offset < shape[axis]):
                inside = False
                break
            index = int(offset)
            if index == 0 or index == shape[axis] - 1:  # in the outer ring: search from the nearest inner cell
                index = min(max(index, 1), shape[axis] - 2)
            c = c * shape[axis] + index
        if not inside:
            continue
        found = 0
        for s in range(stencil.shape[0]):
            first = c + stencil[s]
            for j in range(starts[first], starts[first + 3]):
                dx = rows[j, 0] - x
                dy = rows[j, 1] - y
                d2 = dx * dx + dy * dy
                if dim == 3:
                    dz = rows[j, 2] - z
                    d2 += dz * dz
                if d2 < limit:
                    if found < capacity:
                        lists[i, found] = j
                    found += 1
        counts[i] = found
        longest = max(longest, found)
    return longest
