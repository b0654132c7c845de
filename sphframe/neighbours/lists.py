"""Neighbours: Verlet lists of all particles within the search radius of a cluster of particles.

A list belongs to a cluster of consecutive particles, which are close together because particles are kept in spatial
order. It holds all particles within the search radius of the box around the cluster, first fluid particles and then
ghosts. A pair loop reads each neighbour once for all members of the cluster. This costs less than the additional pairs,
which are beyond the kernel support and have no weight.

The search radius is the kernel support plus the skin, so the lists are complete while no two particles have approached
each other by more than the skin: while no particle has moved by more than that relative to the walls, and no two near
particles relative to each other.
"""

import math
from collections.abc import Mapping

import numba
import numpy as np
from numpy.typing import NDArray

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.compiled import LANES, threaded, threaded_if_long
from sphframe.neighbours.approach import relative_displacement
from sphframe.neighbours.cells import Grid, cell_number, grid_around, row_number, sort_by_cell
from sphframe.neighbours.motion import LargestMotion, largest_motion, largest_wall_displacement
from sphframe.neighbours.sight import Sight, keep_seen, share_lists
from sphframe.particles import Periods

_PARTS = 2
"""number of parts in which rows are sorted and measured in parallel"""
_NO_ORDER = np.zeros(0, np.int64)
"""stands for the order of rows that are sorted by cell"""


class NeighbourLists:
    """Neighbour lists of the fluid particles and of the boundary's evaluation points.

    They keep the positions from which they were built, and decide from them how long they remain valid.

    Attributes
    ----------
    cluster
        number of particles that share a list; that of several also holds the members of the cluster themselves.
    width
        width of the rows of the cell grid, m: the edge of the cube that a cluster should fill.
    fluid
        (clusters, capacity) uint32; row c holds ``fluid_counts[c]`` fluid neighbours, then ``ghost_counts[c]`` ghosts,
        as indices of rows. Ghosts that stand for edges are listed to ``half_edge``, m, beyond the radius.
    near
        (k,) the ghosts that are in a list or may have fluid near their evaluation point; ``left`` (m,) those that were
        when the lists were last built, and are no longer, until they have been filled without neighbours.
    points
        (k, capacity) uint32 fluid neighbours of the evaluation points of the ghosts ``near``, ``point_counts`` (k,) of
        them.
    walls_move
        whether ghosts and evaluation points may move.
    sight
        the sides of walls, at present, where walls are thin; None where nothing hides a neighbour. With it,
        ``shares`` (clusters, capacity, LANES) are those in which the members of a cluster of LANES see the entries of
        ``fluid``, and ``points`` has only what is seen, at the time of the search (:mod:`sphframe.neighbours.sight`).
    """

    SKIN, THINNEST = 0.1, 0.05
    """bounds of the skin of a run's lists over the kernel support: fluid at rest needs none"""

    def __init__(
        self,
        dim: int,
        fluid_count: int,
        ghost_count: int,
        support: float,
        skin: float,
        cluster: int = 1,
        width: float | None = None,
        sight: Sight | None = None,
        periods: Periods | None = None,
        *,
        walls_move: bool = True,
        half_edge: float = 0.0,
    ) -> None:
        self.half_edge, self.sight, self.walls_move = half_edge, sight, walls_move
        self.periods = Periods.none(dim) if periods is None else periods
        self._shifts = np.zeros((len(self.periods.shifts()), 3))
        self._shifts[:, :dim] = self.periods.shifts()
        self.dim, self.support, self.skin, self._thickest = dim, support, skin, skin
        self.shares, self._narrow = np.zeros((1, 1, LANES), np.uint8), np.full(3, np.inf)
        narrow = self.periods.length - 2.0 * (self.radius + half_edge)
        np.copyto(self._narrow[:dim], narrow, where=self.periods.repeats)
        self.cluster, self.fluid_count, self.ghost_count = cluster, fluid_count, ghost_count
        self.width = 0.5 * self.radius if width is None else width
        clusters = -(-fluid_count // cluster)
        self.fluid = np.empty((clusters, 8), np.uint32)
        self.fluid_counts, self.ghost_counts = np.zeros(clusters, np.uint32), np.zeros(clusters, np.uint32)
        self.points, self.point_counts = np.empty((0, 8), np.uint32), np.zeros(0, np.uint32)
        self.near = self.left = np.zeros(0, np.int64)
        self._is_near = np.ones(ghost_count, np.bool_)  # so that at first all others are left
        self._fluid_reference, self._sides_reference = np.zeros((fluid_count, dim)), np.zeros((0, 4))
        self._ghost_reference = self._point_reference = np.zeros((ghost_count, dim))
        self._grid = Grid(np.zeros(3), np.ones(3), np.ones(3, np.int64))
        self._starts, self._ghost_starts = np.zeros(2, np.int64), np.zeros(2, np.int64)
        self._cells, self._order = np.zeros(fluid_count, np.int32), np.zeros(fluid_count, np.int64)
        self._ghost_cells, self._ghost_order = np.zeros(ghost_count, np.int32), np.zeros(ghost_count, np.int64)
        self._tallies, self._boxes = np.zeros((_PARTS, 1), np.int64), np.zeros((_PARTS, 1, 6))
        self._lower, self._upper = np.zeros(dim), np.zeros(dim)

    def resized(self, fluid_count: int) -> "NeighbourLists":
        """Return lists of the same kind for another number of fluid particles, not yet built."""
        lists = type(self)(
            self.dim, fluid_count, self.ghost_count, self.support, self._thickest, self.cluster, self.width, self.sight,
            self.periods, walls_move=self.walls_move, half_edge=self.half_edge,
        )  # fmt: skip
        lists._is_near = self._is_near
        return lists

    @property
    def radius(self) -> float:
        """Search radius, m."""
        return self.support + self.skin

    @property
    def search(self) -> tuple[Grid, IntArray, IntArray, IntArray, IntArray, Array, Array]:
        """What :func:`list_particles` searches, from ``grid`` to ``narrow``."""
        return self._grid, self._starts, _NO_ORDER, self._ghost_starts, self._ghost_order, self._shifts, self._narrow

    def adapt_skin(self, stride: float) -> None:
        """Choose the skin of the next lists: ten times the ``stride`` of a particle in a step, m, within its bounds."""
        if self.sight is None:  # what is seen changes with the search
            self.skin = min(max(10.0 * stride, self.THINNEST * self.support), self._thickest)

    def sort(self, rows: Array) -> IntArray:
        """Make the grid around the fluid ``rows`` (n, width) and return the order in which the rows must be put.

        In periodic directions they must lie in the box that repeats itself, as ghosts in :meth:`build` must.
        """
        for k in range(self.dim):
            self._lower[k], self._upper[k] = rows[: self.fluid_count, k].min(), rows[: self.fluid_count, k].max()
        np.copyto(self._lower, self.periods.lower, where=self.periods.repeats)
        np.copyto(self._upper, self.periods.lower + self.periods.length, where=self.periods.repeats)
        margin = 1.1 * (self.radius + self.half_edge)  # includes all ghosts within reach
        self._grid = grid_around(self._lower, self._upper, self.width, margin)
        if self._tallies.shape[1] != self._grid.size:
            self._tallies = np.zeros((_PARTS, self._grid.size), np.int64)
            self._starts = np.zeros(self._grid.size + 1, np.int64)
            self._ghost_starts = np.zeros(self._grid.size + 1, np.int64)
        sort_by_cell(rows, self.dim, self._grid, self._cells, self._tallies, self._starts, self._order)
        return self._order

    def build(self, rows: Array, evaluation_points: Array) -> None:
        """Build the lists for ``rows`` (n + g, width), whose fluid part is in the order that :meth:`sort` returned."""
        grid, n, ghosts = self._grid, self.fluid_count, rows[self.fluid_count :, : self.dim]
        sort_by_cell(rows[n:], self.dim, grid, self._ghost_cells, self._tallies, self._ghost_starts, self._ghost_order)
        self.list_particles(rows)
        near = self.find_near(self.periods.wrapped(evaluation_points))
        self.near, self.left = np.flatnonzero(near), np.flatnonzero(self._is_near & ~near)
        self._is_near = near
        of_ghosts = self.sight is not None and np.array_equal(evaluation_points, ghosts)
        self.list_points(evaluation_points[self.near], rows, self.near if of_ghosts else _NO_ORDER)
        self._fluid_reference[:] = rows[:n, : self.dim]
        self._ghost_reference, self._point_reference = ghosts, evaluation_points
        if self.walls_move:
            self._ghost_reference, self._point_reference = ghosts.copy(), evaluation_points.copy()

    def list_particles(self, rows: Array) -> None:
        """List the neighbours of the fluid ``rows``."""
        n = self.fluid_count
        while True:
            longest = list_particles(
                rows, n, self.cluster, self.dim, self.radius, self.half_edge, *self.search,
                self.fluid, self.fluid_counts, self.ghost_counts,
            )  # fmt: skip
            if longest < self.fluid.shape[1]:
                break
            self.fluid = np.empty((len(self.fluid), room_for(longest)), np.uint32)
        if self.sight is not None:
            if self.shares.shape[:2] != self.fluid.shape:
                self.shares = np.zeros((*self.fluid.shape, LANES), np.uint8)
            share_lists(
                rows, n, self.radius, self.fluid, self.fluid_counts, self.ghost_counts, self.shares, self.sight
            )  # fmt: skip
            self._sides_reference = self.sight.ends.copy()

    def find_near(self, points: Array) -> BoolArray:
        """Return which ghosts (g,), with evaluation ``points`` (g, dim), are listed or may have fluid near theirs."""
        near = np.zeros(self.ghost_count, np.bool_)
        mark_near(
            points, self.fluid_count, self.dim, self.radius, self._grid, self._starts, self._shifts,
            self.fluid, self.fluid_counts, self.ghost_counts, near,
        )  # fmt: skip
        return near

    def list_points(self, points: Array, rows: Array, ghosts: IntArray) -> None:
        """List the fluid ``rows`` near ``points`` (k, dim), at which the ``ghosts`` (k,) are, if any is given."""
        count = len(points)
        if count > len(self.points):
            self.points = np.empty((count + count // 8, self.points.shape[1]), np.uint32)
        self.point_counts = np.zeros(count, np.uint32)
        self.points = self._around(points, rows, self.points[:count], self.point_counts, ghosts)

    def largest_motion(self, rows: Array) -> LargestMotion:
        """Return the largest speed of the fluid ``rows``, and their largest displacement since :meth:`build`."""
        return LargestMotion(*largest_motion(rows, self._fluid_reference, self.dim))

    def remain_valid(
        self, rows: Array, evaluation_points: Array, motion: LargestMotion, *, wall_speed: float, interval: float
    ) -> bool:
        """Return whether the lists will still hold all neighbours after a further ``interval``.

        Parameters
        ----------
        rows
            (n + g, width) fluid and ghosts at present; ``evaluation_points`` (g, dim), m.
        motion
            of the fluid, from :meth:`largest_motion`.
        wall_speed
            largest speed of a wall, m/s.
        interval
            time for which everything is taken to keep its speed, s.
        """
        ahead, walls = motion.speed * interval, wall_speed * interval
        if self.walls_move:
            walls += largest_wall_displacement(
                rows[self.fluid_count :], self._ghost_reference, evaluation_points, self._point_reference
            )
        if motion.displacement + ahead + walls > self.skin:
            return False
        if 2.0 * (motion.displacement + ahead) <= self.skin:
            return True
        if self.periods:
            return False
        return self._relative_displacement(rows) + 2.0 * ahead <= self.skin

    def _relative_displacement(self, rows: Array) -> float:
        edge = self.radius + self.skin  # particles that were further apart cannot have come within the support
        shape = np.ones(3, np.int64)
        shape[: self.dim] = np.floor((self._upper - self._lower) / edge) + 3
        if self._boxes.shape[1] < shape.prod():
            self._boxes = np.empty((_PARTS, shape.prod(), 6))
        reference, boxes = self._fluid_reference, self._boxes
        return float(relative_displacement(rows, reference, self.dim, self._lower, edge, shape, boxes))

    def state(self) -> dict[str, Array]:
        """Return copies of the positions from which the lists were built; they determine the lists, with the skin."""
        state = {"fluid": self._fluid_reference, "ghosts": self._ghost_reference, "points": self._point_reference}
        state |= {"skin": np.array(self.skin)} | ({} if self.sight is None else {"sides": self._sides_reference})
        return {name: array.copy() for name, array in state.items()}

    def restore(self, state: Mapping[str, Array], rows: Array) -> None:
        """Build the lists that :meth:`state` describes; the positions in ``rows`` (n + g, width) are overwritten."""
        self.skin = float(state["skin"])
        rows[: self.fluid_count, : self.dim] = state["fluid"]
        rows[self.fluid_count :, : self.dim] = state["ghosts"]
        if self.sight is not None:
            self.sight.ends[:] = state["sides"]
        self.sort(rows)  # the particles are in order; this makes the cell grid
        self.build(rows, state["points"])
        self.left = self.near[:0]  # they are as they were filled before the state was saved

    def of_points(self, places: IntArray) -> tuple[IntArray, NDArray[np.uint32], NDArray[np.uint32]]:
        """Return ghosts (k,) at these ``places`` of ``near``, the lists (k, capacity) of their points, and lengths."""
        return self.near[places], self.points[places], self.point_counts[places]

    def around(self, points: Array, rows: Array) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        """Return lists (k, capacity) of the fluid near any ``points`` (k, dim) and their lengths (k,)."""
        counts = np.zeros(len(points), np.uint32)
        lists = np.empty((len(points), self.points.shape[1]), np.uint32)  # as long as those near the walls are
        return self._around(points, rows, lists, counts), counts

    def _around(
        self, points: Array, rows: Array, lists: NDArray[np.uint32], counts: NDArray[np.uint32],
        ghosts: IntArray = _NO_ORDER,
    ) -> NDArray[np.uint32]:  # fmt: skip
        """List the fluid near ``points`` in ``lists``, or a longer array; ``ghosts`` (k,) are those at these points."""
        while True:
            longest = list_points(
                self.periods.wrapped(points), rows, self.dim, self.radius, self._grid, self._starts, _NO_ORDER,
                self._shifts, lists, counts,
            )  # fmt: skip
            if longest < lists.shape[1]:
                if self.sight is not None:
                    keep_seen(points, rows, self.radius, lists, counts, ghosts, self.sight)
                return lists
            lists = np.empty((len(points), room_for(longest)), np.uint32)


def room_for(longest: int) -> int:
    """Room for a list of ``longest`` neighbours and some compression."""
    return -(-int(longest * 1.06 + 4) // 8) * 8


@numba.njit(error_model="numpy", forceinline=True)
def _cell_range(lower, upper, origin, cell, count):  # type: ignore[no-untyped-def]
    """Return the first and the last of ``count`` cells that overlap an interval; the last may be below the first."""
    first = (lower - origin) / cell
    last = (upper - origin) / cell
    if not (last >= 0.0 and first < count):
        return 0, -1
    return int(max(first, 0.0)), int(min(last, count - 1.0))


@numba.njit(error_model="numpy", forceinline=True)
def _gap(x, lower, upper):  # type: ignore[no-untyped-def]
    """Return the distance from ``x`` to an interval."""
    gap = lower - x if lower - x > x - upper else x - upper
    return gap if gap > 0.0 else 0.0


@numba.njit(error_model="numpy", forceinline=True)
def _box_distance2(rows, j, dim, box):  # type: ignore[no-untyped-def]
    """Return the squared distance of row ``j`` from a box; an unsigned ``j`` needs no check for negative numbers."""
    d2 = _gap(rows[j, 0], box[0], box[1]) ** 2 + _gap(rows[j, 1], box[2], box[3]) ** 2
    return d2 + _gap(rows[j, 2], box[4], box[5]) ** 2 if dim == 3 else d2


@numba.njit(error_model="numpy", forceinline=True)
def _reach(radius, lower, upper, origin, cell, index):  # type: ignore[no-untyped-def]
    """Return how far along its cells a row may hold what is within ``radius`` of the box ``lower`` .. ``upper``.

    ``index`` is the row's in the other direction, in which the box's edges are given; 0 where it is out of reach.
    """
    start = origin + index * cell
    gap = max(start - upper, lower - (start + cell))
    return math.sqrt(max(radius * radius - max(gap, 0.0) ** 2, 0.0))


@numba.njit(error_model="numpy")
def _near_any(rows, j, first, last, dim, limit, shift):  # type: ignore[no-untyped-def]
    """Whether row ``j``, moved by ``shift``, lies within the search radius of any of the rows ``first`` .. ``last``."""
    for i in range(first, last):
        d2 = 0.0
        for k in range(dim):
            d2 += (rows[j, k] - rows[i, k] + shift[k]) ** 2
        if d2 < limit:
            return True
    return False


@numba.njit(error_model="numpy")
def _select(rows, members, begin, end, first, last, dim, limit, shift, alone):  # type: ignore[no-untyped-def]
    """Keep of ``members[begin:end]`` what is near a member of the cluster, and not the particle itself if ``alone``.

    The members stand for their copies moved by ``shift`` (3,).
    """
    kept = begin
    for k in range(begin, end):
        j = members[k]
        members[kept] = j
        kept += 1 if not (alone and j == first) and _near_any(rows, j, first, last, dim, limit, shift) else 0
    return kept


@numba.njit(error_model="numpy", forceinline=True)
def _collect(rows, dim, box, radius, grid, starts, order, first, members, found):  # type: ignore[no-untyped-def]
    """List in ``members``, from place ``found`` on, the rows within ``radius`` of ``box`` (x0, x1, y0, y1, z0, z1).

    The members of cell c are the rows ``first + order[starts[c]:starts[c + 1]]``, or ``starts[c]`` .. ``starts[c + 1]``
    themselves where ``order`` is empty. Returns the number of members; those without room are counted only.
    """
    x0, x1, y0, y1, z0, z1 = box
    origin, cell, shape = grid.origin, grid.cell, (grid.shape[0], grid.shape[1], grid.shape[2])  # no write changes it
    reach = radius * (1.0 + 1e-9)
    limit = radius * radius
    room, found = np.uint64(members.shape[0] - 1), np.uint64(found)  # the last place is scratch
    if dim == 2:
        a0, a1 = 0, 0
        b0, b1 = _cell_range(x0 - reach, x1 + reach, origin[1], cell[1], shape[1])
    else:
        a0, a1 = _cell_range(x0 - reach, x1 + reach, origin[0], cell[0], shape[0])
        b0, b1 = _cell_range(y0 - reach, y1 + reach, origin[1], cell[1], shape[1])
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
            begin, end = np.uint64(starts[min(left, right)]), np.uint64(starts[max(left, right) + 1])
            if order.shape[0] == 0:
                for j in range(begin, end):
                    members[min(found, room)] = j  # stays only if it is near, without a branch that is hard to predict
                    found += np.uint64(1) if _box_distance2(rows, j, dim, box) < limit else np.uint64(0)
            else:
                for k in range(begin, end):
                    ordered = np.uint64(order[k]) + np.uint64(first)
                    members[min(found, room)] = ordered
                    found += np.uint64(1) if _box_distance2(rows, ordered, dim, box) < limit else np.uint64(0)
    return np.int64(found)


@numba.njit(error_model="numpy")
def _may_be_near(x, y, z, dim, radius, grid, starts):  # type: ignore[no-untyped-def]
    """Whether a cell that is within ``radius`` of the point in each direction has members."""
    origin, cell, shape = grid.origin, grid.cell, grid.shape
    a0, a1 = 0, 0
    if dim == 3:
        a0, a1 = _cell_range(x - radius, x + radius, origin[0], cell[0], shape[0])
        b0, b1 = _cell_range(y - radius, y + radius, origin[1], cell[1], shape[1])
    else:
        b0, b1 = _cell_range(x - radius, x + radius, origin[1], cell[1], shape[1])
    c0, c1 = _cell_range(z - radius, z + radius, origin[2], cell[2], shape[2])
    if c1 < c0:
        return False
    for a in range(a0, a1 + 1):
        for b in range(b0, b1 + 1):
            row = row_number(shape, a, b)
            left = cell_number(shape, row, c0)
            right = cell_number(shape, row, c1)
            if starts[max(left, right) + 1] > starts[min(left, right)]:
                return True
    return False


@threaded_if_long
def mark_near(  # type: ignore[no-untyped-def]
    points, n, dim, radius, grid, starts, shifts, lists, counts, ghost_counts, near
):
    """Set ``near`` (g,) for ghosts in the ``lists``, and for those with ``points`` (g, dim) that may be near fluid."""
    for c in numba.prange(counts.shape[0]):
        for k in range(counts[c], counts[c] + ghost_counts[c]):
            near[lists[c, k] - n] = True
    for g in numba.prange(points.shape[0]):
        for s in range(shifts.shape[0]):
            if not near[g]:
                x, y = points[g, 0] - shifts[s, 0], points[g, 1] - shifts[s, 1]
                z = points[g, dim - 1] - shifts[s, dim - 1]
                near[g] = _may_be_near(x, y, z, dim, radius, grid, starts)


@numba.njit(error_model="numpy")
def _without_repeats(members, begin, middle, end):  # type: ignore[no-untyped-def]
    """Keep of ``members[middle:end]`` what is not in ``members[begin:middle]``; return the new end."""
    kept = middle
    for k in range(middle, end):
        j = members[k]
        new = True
        for m in range(begin, middle):
            new = new and members[m] != j
        members[kept] = j
        kept += 1 if new else 0
    return kept


@numba.njit(error_model="numpy")
def _gather(  # type: ignore[no-untyped-def]
    rows, dim, box, radius, grid, starts, order, row, shifts, first, last, selected, repeated, alone, members, begin
):
    """List in ``members``, from place ``begin`` on, what is near a cluster with its copies; return the end.

    ``row``: the first row that the ``order`` counts from; of the cluster ``first`` .. ``last`` only what is near a
    particle is kept if ``selected``, not the particle itself if ``alone``, and each neighbour once if it may be
    ``repeated``.
    """
    x0, x1, y0, y1, z0, z1 = box
    limit = radius * radius
    room = members.shape[0] - 1
    found = begin
    for s in range(shifts.shape[0]):
        shift = shifts[s]
        sz = shift[dim - 1]
        moved = (x0 - shift[0], x1 - shift[0], y0 - shift[1], y1 - shift[1], z0 - sz, z1 - sz)
        before = found
        found = _collect(rows, dim, moved, radius, grid, starts, order, row, members, found)
        if selected and found <= room:
            found = _select(rows, members, before, found, first, last, dim, limit, shift, alone)
        if s > 0 and repeated and found <= room:
            found = _without_repeats(members, begin, before, found)
    return found


@threaded
def list_particles(  # type: ignore[no-untyped-def]
    rows, n, cluster, dim, radius, half_edge, grid, starts, no_order, ghost_starts, ghost_order, shifts, narrow,
    lists, counts, ghost_counts,
):  # fmt: skip
    """List the neighbours of each cluster; returns the longest list, which must stay below the capacity.

    Copies are moved by ``shifts`` (m, 3). A cluster whose box exceeds ``narrow`` (3,) may meet a neighbour twice.
    """
    longest = zero = np.int64(0)  # a literal would have the functions compiled again for its own type
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
        box = (x0, x1, y0, y1, z0, z1)
        selected = last - first == 1 or max(x1 - x0, y1 - y0, z1 - z0) > 1.5 * radius
        repeated = x1 - x0 >= narrow[0] or y1 - y0 >= narrow[1] or (dim == 3 and z1 - z0 >= narrow[2])
        members = lists[c]
        found = _gather(
            rows, dim, box, radius, grid, starts, no_order, zero, shifts, first, last, selected, repeated, cluster == 1,
            members, zero,
        )  # fmt: skip
        counts[c] = found
        found = _gather(
            rows, dim, box, radius + half_edge, grid, ghost_starts, ghost_order, n, shifts, first, last, selected,
            repeated, cluster == 1, members, found,
        )  # fmt: skip
        ghost_counts[c] = found - counts[c]
        longest = max(longest, found)
    return longest


@threaded
def list_points(  # type: ignore[no-untyped-def]
    points, rows, dim, radius, grid, starts, no_order, shifts, lists, counts
):
    """List the fluid neighbours of each point; returns the longest list, which must stay below the capacity."""
    longest, zero, no = np.int64(0), np.int64(0), np.bool_(False)
    for i in numba.prange(points.shape[0]):
        x, y, z = points[i, 0], points[i, 1], points[i, dim - 1]
        box = (x, x, y, y, z, z)
        counts[i] = _gather(
            rows, dim, box, radius, grid, starts, no_order, zero, shifts, zero, zero, no, no, no, lists[i], zero
        )
        longest = max(longest, counts[i])
    return longest
