"""Neighbours: lists of all particles within the search radius, good until two may have approached by the skin.

A list serves a cluster of consecutive particles, which touch each other since particles are kept in spatial order: it
holds whatever is within the search radius of the box around them, first fluid particles and then ghosts. A pair loop
reads each neighbour once for all members of the cluster: that costs less than the pairs too many, which lie beyond the
kernel support and get no weight. The search radius is the kernel support plus
the skin, so the lists stay complete while no two particles have approached each other by more than the skin: while
nothing has moved further than that against the walls, and no two particles near each other against one another.
"""

import math

import numba
import numpy as np
from numpy.typing import NDArray

from sphframe.neighbours.approach import relative_displacement
from sphframe.neighbours.cells import Grid, bounding_box, cell_number, grid_around, row_number, sort_by_cell

__all__ = ["NeighbourLists"]

Array = NDArray[np.float64]

_PARTS = 2
"""of the rows that are sorted, or looked at, at the same time"""


class NeighbourLists:
    """Neighbour lists of the fluid particles and of the boundary's evaluation points.

    Attributes
    ----------
    cluster: number of particles that share a list; the list of a single particle holds exactly its neighbours, that of
        several also the members of the cluster themselves.
    width: of the rows of the grid, m: the edge of the cube that a cluster should fill.
    fluid: (clusters, capacity) uint32; row c holds ``fluid_counts[c]`` fluid neighbours, then ``ghost_counts[c]``
        ghosts, as indices of rows.
    points: (g, capacity) uint32 fluid neighbours of each evaluation point, ``point_counts`` (g,) of them.
    """

    def __init__(
        self,
        dim: int,
        fluid_count: int,
        ghost_count: int,
        support: float,
        skin: float,
        cluster: int = 1,
        width: float | None = None,
    ) -> None:
        self.dim = dim
        self.support = support
        self.skin = skin
        self.cluster = cluster
        self.width = 0.5 * self.radius if width is None else width
        self.fluid_count = fluid_count
        self.ghost_count = ghost_count
        clusters = -(-fluid_count // cluster)
        self.fluid = np.empty((clusters, 8), np.uint32)
        self.fluid_counts = np.zeros(clusters, np.uint32)
        self.ghost_counts = np.zeros(clusters, np.uint32)
        self.points = np.empty((ghost_count, 8), np.uint32)
        self.point_counts = np.zeros(ghost_count, np.uint32)
        self.grid = Grid(np.zeros(3), np.ones(3), (1, 1, 1))
        self.starts = np.zeros(2, np.int64)
        self.rebuilds = 0
        self._cells = np.zeros(fluid_count, np.int64)
        self._order = np.zeros(fluid_count, np.int64)
        self._ghost_cells = np.zeros(ghost_count, np.int64)
        self._ghost_order = np.zeros(ghost_count, np.int64)
        self._ghost_starts = np.zeros(2, np.int64)
        self._tallies = np.zeros((_PARTS, 1), np.int64)
        self._lower, self._upper = np.zeros(dim), np.zeros(dim)
        self._boxes = np.zeros((_PARTS, 1, 6))

    @property
    def radius(self) -> float:
        """Search radius, m."""
        return self.support + self.skin

    def sort(self, rows: Array) -> NDArray[np.int64]:
        """Make the grid around the fluid ``rows`` (n, width) and return the order in which the rows must be put."""
        bounding_box(rows, self.fluid_count, self.dim, self._lower, self._upper)
        self.grid = grid_around(self._lower, self._upper, self.width, 1.1 * self.radius)  # with all ghosts that matter
        if self._tallies.shape[1] != self.grid.count:
            self._tallies = np.zeros((_PARTS, self.grid.count), np.int64)
            self.starts = np.zeros(self.grid.count + 1, np.int64)
            self._ghost_starts = np.zeros(self.grid.count + 1, np.int64)
        self._sort(rows, self._cells, self.starts, self._order)
        return self._order

    def _sort(self, rows: Array, cells: NDArray[np.int64], starts: NDArray[np.int64], order: NDArray[np.int64]) -> None:
        grid = self.grid
        sort_by_cell(rows, self.dim, grid.origin, grid.cell, grid.shape, cells, self._tallies, starts, order)

    def build(self, rows: Array, evaluation_points: Array) -> None:
        """Build the lists for ``rows`` (n + g, width), whose fluid part is in the order that :meth:`sort` returned."""
        grid, n = self.grid, self.fluid_count
        self._sort(rows[n:], self._ghost_cells, self._ghost_starts, self._ghost_order)
        while True:
            longest = _list_particles(
                rows, n, self.cluster, self.dim, self.radius, grid.origin, grid.cell, grid.shape,
                self.starts, self._ghost_starts, self._ghost_order, self.fluid, self.fluid_counts, self.ghost_counts,
            )  # fmt: skip
            if longest < self.fluid.shape[1]:
                break
            self.fluid = np.empty((len(self.fluid), _capacity(longest)), np.uint32)
        self.points = self._around(evaluation_points, rows, self.points, self.point_counts)
        self.rebuilds += 1

    def last(self, rows: Array, reference: Array, moved: float, walls: float, ahead: float) -> bool:
        """Return whether the lists stay complete for fluid ``rows`` that lay at ``reference`` (n, dim) when they were
        built, have ``moved`` at most so much since, m, and will move ``ahead`` more at most, and for walls that will
        have moved by ``walls`` at most."""
        if moved + ahead + walls > self.skin:
            return False
        if 2.0 * (moved + ahead) <= self.skin:
            return True
        edge = self.radius + self.skin  # what lay further apart cannot have come within the support
        shape = np.ones(3, np.int64)
        shape[: self.dim] = np.floor((self._upper - self._lower) / edge) + 3
        cubes = int(shape.prod())
        if self._boxes.shape[1] < cubes:
            self._boxes = np.empty((_PARTS, cubes, 6))
        apart = relative_displacement(rows, reference, self.dim, self._lower, edge, shape, self._boxes[:, :cubes])
        return bool(apart + 2.0 * ahead <= self.skin)

    def around(self, points: Array, rows: Array) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        """Return lists (k, capacity) of the fluid near any ``points`` (k, dim) and their lengths (k,)."""
        counts = np.zeros(len(points), np.uint32)
        return self._around(points, rows, np.empty((len(points), 8), np.uint32), counts), counts

    def _around(
        self, points: Array, rows: Array, lists: NDArray[np.uint32], counts: NDArray[np.uint32]
    ) -> NDArray[np.uint32]:
        """List the fluid near ``points`` in ``lists``, or in a longer array where that is too short."""
        grid = self.grid
        while True:
            longest = _list_points(
                points, rows, self.dim, self.radius, grid.origin, grid.cell, grid.shape, self.starts, lists, counts,
            )  # fmt: skip
            if longest < lists.shape[1]:
                return lists
            lists = np.empty((len(points), _capacity(longest)), np.uint32)


def _capacity(longest: int) -> int:
    """Room for a list of ``longest`` neighbours and some compression."""
    return -(-int(longest * 1.1 + 4) // 8) * 8


@numba.njit(inline="always")
def _cell_range(lower, upper, origin, cell, count):  # type: ignore[no-untyped-def]
    """Return the first and the last of ``count`` cells that overlap an interval; the last may be below the first."""
    first = (lower - origin) / cell
    last = (upper - origin) / cell
    if not (last >= 0.0 and first < count):
        return 0, -1
    return int(max(first, 0.0)), int(min(last, count - 1.0))


@numba.njit(inline="always")
def _gap(x, lower, upper):  # type: ignore[no-untyped-def]
    """Return the distance from ``x`` to an interval."""
    gap = lower - x if lower - x > x - upper else x - upper
    return gap if gap > 0.0 else 0.0


@numba.njit(inline="always")
def _box_distance2(rows, j, dim, x0, x1, y0, y1, z0, z1):  # type: ignore[no-untyped-def]
    """Return the squared distance of row ``j`` from a box; an unsigned ``j`` needs no check for negative numbers."""
    d2 = _gap(rows[j, 0], x0, x1) ** 2 + _gap(rows[j, 1], y0, y1) ** 2
    return d2 + _gap(rows[j, 2], z0, z1) ** 2 if dim == 3 else d2


@numba.njit(inline="always")
def _reach(radius, lower, upper, origin, cell, index):  # type: ignore[no-untyped-def]
    """Return how far along its cells a row may hold what is within ``radius`` of the box ``lower`` .. ``upper``.

    ``index`` is the row's in the other direction, in which the box's edges are given; 0 where it is out of reach.
    """
    start = origin + index * cell
    gap = max(start - upper, lower - (start + cell))
    return math.sqrt(max(radius * radius - max(gap, 0.0) ** 2, 0.0))


@numba.njit(error_model="numpy")
def _near_any(rows, j, first, last, dim, limit):  # type: ignore[no-untyped-def]
    """Whether row ``j`` lies within the search radius of any of the rows ``first`` .. ``last``."""
    for i in range(first, last):
        d2 = 0.0
        for k in range(dim):
            d2 += (rows[j, k] - rows[i, k]) ** 2
        if d2 < limit:
            return True
    return False


@numba.njit(error_model="numpy")
def _select(rows, members, begin, end, first, last, dim, limit):  # type: ignore[no-untyped-def]
    """Keep of ``members[begin:end]`` what is near a member of the cluster, and not a lone particle itself."""
    kept = begin
    for k in range(begin, end):
        j = members[k]
        members[kept] = j
        lone = last - first == 1 and j == first
        kept += 1 if not lone and _near_any(rows, j, first, last, dim, limit) else 0
    return kept


@numba.njit(parallel=True, cache=True, error_model="numpy")
def _list_particles(  # type: ignore[no-untyped-def]
    rows, n, cluster, dim, radius, origin, cell, shape, starts, ghost_starts, ghost_order,
    lists, counts, ghost_counts,
):  # fmt: skip
    """List the neighbours of each cluster; returns the longest list, which must stay below the capacity."""
    reach = radius * (1.0 + 1e-9)
    limit = radius * radius
    room = lists.shape[1] - 1  # the last place is scratch
    longest = 0
    for c in numba.prange(counts.shape[0]):
        first = c * cluster
        last = min(first + cluster, n)
        x0 = x1 = rows[first, 0]
        y0 = y1 = rows[first, 1]
        z0 = z1 = rows[first, dim - 1]
        for i in range(first + 1, last):
            x0 = min(x0, rows[i, 0])
            x1 = max(x1, rows[i, 0])
            y0 = min(y0, rows[i, 1])
            y1 = max(y1, rows[i, 1])
            z0 = min(z0, rows[i, dim - 1])
            z1 = max(z1, rows[i, dim - 1])
        alone = last - first == 1
        wide = max(max(x1 - x0, y1 - y0), z1 - z0) > 1.5 * radius
        if dim == 2:
            a0, a1 = 0, 0
            b0, b1 = _cell_range(x0 - reach, x1 + reach, origin[1], cell[1], shape[1])
        else:
            a0, a1 = _cell_range(x0 - reach, x1 + reach, origin[0], cell[0], shape[0])
            b0, b1 = _cell_range(y0 - reach, y1 + reach, origin[1], cell[1], shape[1])
        found = 0
        members = lists[c]
        for kind in range(2):
            for a in range(a0, a1 + 1):
                across = _reach(reach, x0, x1, origin[0], cell[0], a) if dim == 3 else reach
                for b in range(b0, b1 + 1):
                    if dim == 3:
                        along = _reach(across, y0, y1, origin[1], cell[1], b)
                    else:
                        along = _reach(across, x0, x1, origin[1], cell[1], b)
                    c0, c1 = _cell_range(z0 - along, z1 + along, origin[2], cell[2], shape[2])
                    if c1 < c0:
                        continue
                    row = row_number(shape, a, b)
                    left = cell_number(shape, row, c0)
                    right = cell_number(shape, row, c1)
                    if kind == 0:
                        begin, end = starts[min(left, right)], starts[max(left, right) + 1]
                        for j in range(np.uint64(begin), np.uint64(end)):
                            members[min(found, room)] = j  # stays only if it is near: no branch to be mispredicted
                            found += 1 if _box_distance2(rows, j, dim, x0, x1, y0, y1, z0, z1) < limit else 0
                    else:
                        begin, end = ghost_starts[min(left, right)], ghost_starts[max(left, right) + 1]
                        for k in range(np.uint64(begin), np.uint64(end)):
                            ghost = np.uint64(ghost_order[k]) + np.uint64(n)
                            members[min(found, room)] = ghost
                            found += 1 if _box_distance2(rows, ghost, dim, x0, x1, y0, y1, z0, z1) < limit else 0
            if (wide or alone) and found <= room:
                found = _select(rows, members, counts[c] if kind == 1 else 0, found, first, last, dim, limit)
            if kind == 0:
                counts[c] = found
        ghost_counts[c] = found - counts[c]
        longest = max(longest, found)
    return longest


@numba.njit(parallel=True, cache=True, error_model="numpy")
def _list_points(points, rows, dim, radius, origin, cell, shape, starts, lists, counts):  # type: ignore[no-untyped-def]
    """List the fluid neighbours of each point; returns the longest list, which must stay below the capacity."""
    reach = radius * (1.0 + 1e-9)
    limit = radius * radius
    room = lists.shape[1] - 1
    longest = 0
    for i in numba.prange(points.shape[0]):
        x = points[i, 0]
        y = points[i, 1]
        z = points[i, dim - 1]
        if dim == 2:
            a0, a1 = 0, 0
            b0, b1 = _cell_range(x - reach, x + reach, origin[1], cell[1], shape[1])
        else:
            a0, a1 = _cell_range(x - reach, x + reach, origin[0], cell[0], shape[0])
            b0, b1 = _cell_range(y - reach, y + reach, origin[1], cell[1], shape[1])
        found = 0
        members = lists[i]
        for a in range(a0, a1 + 1):
            across = _reach(reach, x, x, origin[0], cell[0], a) if dim == 3 else reach
            for b in range(b0, b1 + 1):
                if dim == 3:
                    along = _reach(across, y, y, origin[1], cell[1], b)
                else:
                    along = _reach(across, x, x, origin[1], cell[1], b)
                c0, c1 = _cell_range(z - along, z + along, origin[2], cell[2], shape[2])
                if c1 < c0:
                    continue
                row = row_number(shape, a, b)
                left = cell_number(shape, row, c0)
                right = cell_number(shape, row, c1)
                begin, end = starts[min(left, right)], starts[max(left, right) + 1]
                for j in range(np.uint64(begin), np.uint64(end)):
                    members[min(found, room)] = j
                    found += 1 if _box_distance2(rows, j, dim, x, x, y, y, z, z) < limit else 0
        counts[i] = found
        longest = max(longest, found)
    return longest
