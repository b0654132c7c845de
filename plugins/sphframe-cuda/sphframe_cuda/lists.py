"""Neighbour lists of single particles on the device."""

from typing import Any, final

import numpy as np

from sphframe.devices import NeighbourLists, list_particles, list_points, mark_near, room_for
from sphframe_cuda.arrays import fetched, put, room
from sphframe_cuda.loops import Loop
from sphframe_cuda.templates import take_rows


@final
class DeviceLists(NeighbourLists):
    """Lists of each particle, whatever ``cluster`` says, that the device makes from the processor's grid of cells.

    All arrays are those of the device; ``position`` (n, dim), m, are the fluid's where the lists were built.
    """

    SKIN = THINNEST = 0.4
    """more than the processor's, as a search takes as long as several steps, and longer lists take hardly any time"""

    _list_particles, _mark_near, _list_points = Loop(list_particles), Loop(mark_near), Loop(list_points)
    _take = Loop(take_rows)

    def __init__(
        self, dim: int, fluid_count: int, ghost_count: int, support: float, skin: float, cluster: int = 1,
        *arguments: Any, **options: Any,
    ) -> None:  # fmt: skip
        super().__init__(dim, fluid_count, ghost_count, support, skin, 1, *arguments, **options)
        n = self.fluid_count
        self.fluid, self.fluid_counts, self.ghost_counts = _lists(n, 8), room((n,), np.uint32), room((n,), np.uint32)
        self.shares, self.points, self.point_counts = put(self.shares), _lists(0, 8), room((0,), np.uint32)
        self.position: Any = None
        self._search: Any = None

    def build(self, rows: Any, evaluation_points: Any) -> None:
        """Build the lists for ``rows`` (n + g, dim or more) of the processor."""
        super().build(rows, evaluation_points)
        self.near, self.left = put(self.near), put(self.left)

    def list_particles(self, rows: Any) -> None:
        """List the neighbours of the fluid ``rows``."""
        rows = put(rows[:, : self.dim])
        self.position = rows[: self.fluid_count]
        grid, *others = self.search
        self._search = (type(grid)(*map(put, grid)), *map(put, others))
        while True:
            longest = self._list_particles(
                rows, self.fluid_count, 1, self.dim, self.radius, self.half_edge, *self._search,
                self.fluid, self.fluid_counts, self.ghost_counts,
            )  # fmt: skip
            if longest < self.fluid.shape[1]:
                break
            self.fluid = _lists(self.fluid_count, room_for(longest))

    def find_near(self, points: Any) -> Any:
        """Return, on the processor, which ghosts (g,) are listed or may have fluid near their ``points`` (g, dim)."""
        near = put(np.zeros(self.ghost_count, np.bool_))
        grid, starts, _, _, _, shifts, _ = self._search
        self._mark_near(
            put(points), self.fluid_count, self.dim, self.radius, grid, starts, shifts,
            self.fluid, self.fluid_counts, self.ghost_counts, near,
        )  # fmt: skip
        return fetched(near)

    def list_points(self, points: Any, rows: Any, ghosts: Any) -> None:
        """List the fluid near ``points`` (k, dim)."""
        count, capacity = len(points), self.points.shape[1]
        grid, starts, no_order, _, _, shifts, _ = self._search
        places, self.point_counts = put(self.periods.wrapped(points)), room((count,), np.uint32)
        if count > len(self.points):
            self.points = _lists(count + count // 8, capacity)
        while True:
            longest = self._list_points(
                places, self.position, self.dim, self.radius, grid, starts, no_order, shifts, self.points,
                self.point_counts,
            )  # fmt: skip
            if longest < capacity:
                break
            capacity = room_for(longest)
            self.points = _lists(count + count // 8, capacity)

    def of_points(self, places: Any) -> tuple[Any, Any, Any]:
        """Return, on the processor, ghosts at ``places`` (k,) of ``near``, the lists of their points, and lengths."""
        chosen, found = put(places), _lists(len(places), self.points.shape[1])
        self._take(self.points, chosen, found)
        return fetched(self.near)[places], fetched(found), fetched(self.point_counts)[places]


def _lists(count: int, capacity: int) -> Any:
    """Return lists whose entries of the same place are beside each other, as threads read them."""
    return room((count, capacity), np.uint32, order="F")
