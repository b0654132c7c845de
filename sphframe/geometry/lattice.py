"""Geometry: a lattice of cells between the straight faces of a shape, and the particles that stand for cut cells."""

import itertools
import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.geometry.shapes import grid

ROUND_OFF = 1e-9
"""share of a cell that is round-off"""
_BLOCK = 4
"""cells along each edge of a block in which the number of particles is right"""


class Fill(NamedTuple):
    """The particles of a region: positions (n, dim), m, and volumes (n,), m^dim, whose sum is that of the region."""

    position: Array
    volume: Array


class Lattice(NamedTuple):
    """A lattice of cells: their centres and widths along each axis, and centres (n, dim) and edges (n, dim) of all."""

    axes: list[tuple[Array, Array]]
    centre: Array
    size: Array

    @classmethod
    def over(cls, lower: Array, upper: Array, spacing: float, edges: Iterable[tuple[int, float]]) -> "Lattice":
        """Cover a box, with cells stretched between those ``edges`` (axis, coordinate) that are far enough apart."""
        axes = []
        for axis, (low, high) in enumerate(zip(lower, upper, strict=True)):
            places: list[float] = []
            for place in (place for k, place in edges if k == axis):
                if all(abs(place - other) >= 1.5 * spacing for other in places):
                    places.append(place)
            places = sorted(places) or [0.5 * (low + high)]
            before, after = (math.ceil(gap / spacing - 1e-6) for gap in (places[0] - low, high - places[-1]))
            after = max(after, 1 if len(places) == 1 and before == 0 else 0)
            pieces = [(places[0] - before * spacing, before, spacing)]
            for start, stop in itertools.pairwise(places):
                count = max(int(np.rint((stop - start) / spacing)), 1)
                pieces.append((start, count, (stop - start) / count))
            pieces.append((places[-1], after, spacing))
            centre = np.concatenate([start + (np.arange(count) + 0.5) * width for start, count, width in pieces])
            axes.append((centre, np.concatenate([np.full(count, width) for _, count, width in pieces])))
        return cls(axes, grid([centre for centre, _ in axes]), grid([width for _, width in axes]))

    def kinds(self, volume: Array, rings: int = 2) -> tuple[BoolArray, BoolArray, BoolArray]:
        """Whether each cell, of which ``volume`` is inside, is cut, is full and at most ``rings`` away, or is full."""
        size = self.size.prod(axis=1)
        full = volume > (1.0 - ROUND_OFF) * size
        cut = ~full & (volume > ROUND_OFF * size)
        mobile = self.grown(cut, rings) & full
        return cut, mobile, full & ~mobile

    def chosen(self, cut: BoolArray, share: Array) -> BoolArray:
        """Choose in each block of cells as many of those that are ``cut`` as they hold, with the largest shares first.

        What is left over when the number in a block is rounded is carried to the next block.
        """
        cells = np.flatnonzero(cut)
        index = np.unravel_index(cells, [len(centre) for centre, _ in self.axes])
        _, block = np.unique(np.stack(index) // _BLOCK, axis=1, return_inverse=True)
        block = block.ravel()
        number = np.diff(np.floor(np.cumsum(np.bincount(block, share[cells])) + 0.5), prepend=0.0)
        order = np.lexsort((cells, -share[cells].round(6), block))
        first = np.searchsorted(block[order], np.arange(len(number)))
        rank = np.arange(len(cells)) - first[block[order]]
        found = np.zeros(len(cut), dtype=np.bool_)
        found[cells[order][rank < number[block[order]]]] = True
        return found

    def filled(
        self, start: Array, mobile: BoolArray, fixed: BoolArray, samples: Array, weights: Array, sweeps: int = 20
    ) -> Fill:
        """Relax particles at ``start`` and in ``mobile`` cells; those in ``fixed`` cells stay."""
        position, volume = _relaxed(np.vstack([start, self.centre[mobile]]), samples, weights, sweeps)
        fixed_volume = self.size[fixed].prod(axis=1)
        return Fill(np.vstack([position, self.centre[fixed]]), np.concatenate([volume, fixed_volume]))

    def corners(self, cells: IntArray) -> tuple[Array, ...]:
        """Return the lower and then the upper coordinates (k,) of ``cells`` along each axis."""
        lower, upper = self.centre[cells] - 0.5 * self.size[cells], self.centre[cells] + 0.5 * self.size[cells]
        return (*lower.T, *upper.T)

    def around(self, points: Array) -> BoolArray:
        """Whether each cell is the one in which a point lies, or its neighbour."""
        found = np.zeros([len(centre) for centre, _ in self.axes], dtype=np.bool_)
        places = [
            np.clip(np.searchsorted(centre, x), 0, len(centre) - 1)
            for x, (centre, _) in zip(points.T, self.axes, strict=True)
        ]
        found[tuple(places)] = True
        return self.grown(found.ravel(), 1)

    def grown(self, cells: BoolArray, rings: int) -> BoolArray:
        """Return ``cells`` with as many ``rings`` of neighbours."""
        from scipy.ndimage import binary_dilation

        block = cells.reshape([len(centre) for centre, _ in self.axes])
        return np.asarray(binary_dilation(block, np.ones((3,) * block.ndim), iterations=rings).ravel())


def _relaxed(position: Array, samples: Array, weights: Array, sweeps: int) -> Fill:
    """Move each particle to the centroid of the ``samples`` (m, dim) nearest to it, until none changes its particle."""
    from scipy.spatial import cKDTree

    nearest = np.full(len(samples), -1)
    volume = np.zeros(len(position))
    for _ in range(sweeps):
        before, nearest = nearest, cKDTree(position).query(samples)[1]
        volume = np.bincount(nearest, weights, len(position)).astype(np.float64)
        if np.array_equal(before, nearest):
            break
        moments = [np.bincount(nearest, weights * x, len(position)) for x in samples.T]
        held = volume > 0.0
        position, volume = np.stack(moments, axis=1)[held] / volume[held, None], volume[held]
    return Fill(position, volume)
