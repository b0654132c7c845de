"""Geometry: the particles that fill a region, each with the volume of its own cell."""

import itertools
import math
from collections.abc import Iterable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import shapely

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.geometry.regions import Region
from sphframe.geometry.shapes import Box, grid

_PARTS = 8
"""parts along each edge into which cells near an outline are divided"""
_RINGS = 2
"""cells around those that the outline cuts whose particles are relaxed with them"""
_SWEEPS = 20
_ROUND_OFF = 1e-9


class Fill(NamedTuple):
    """The particles of a region: positions (n, dim), m, and volumes (n,), m^dim, whose sum is that of the region."""

    position: Array
    volume: Array


@lru_cache(maxsize=32)
def fill(region: Region, spacing: float) -> Fill:
    """Return the particles that fill ``region``, about one ``spacing`` (m) apart.

    They lie at the centres of lattice cells, stretched so that the lattice fits all straight edges of the outline that
    are parallel to an axis and at least 1.5 spacings apart. Where an outline cuts cells, the
    particles of these and of two cells around become the centres of their Voronoi cells within the region, by Lloyd's
    algorithm: the first layer follows the outline, half a spacing inside, and each volume is that of a Voronoi cell.

    References
    ----------
    Q. Du, V. Faber, M. Gunzburger, Centroidal Voronoi tessellations, SIAM Review 41 (1999), 637-676,
    doi:10.1137/S0036144599352836.
    """
    filled = _filled(region, spacing)
    for array in filled:
        array.flags.writeable = False  # it is kept for the next call
    return filled


def _filled(region: Region, spacing: float) -> Fill:
    if isinstance(region, Box):
        lower, upper = region.bounds()
        lattice = _Lattice.over(lower, upper, spacing, [*enumerate(lower), *enumerate(upper)])
        return Fill(lattice.centre, lattice.size.prod(axis=1))
    area = region.geometry(1e-3 * spacing)
    lower, upper = np.reshape(area.bounds, (2, 2))
    lattice = _Lattice.over(lower, upper, spacing, straight_edges(area))
    near = np.flatnonzero(lattice.around(shapely.get_coordinates(shapely.segmentize(area.boundary, 0.25 * spacing))))
    shapely.prepare(area)
    size = lattice.size.prod(axis=1)
    volume = np.where(shapely.contains_xy(area, lattice.centre), size, 0.0)
    cells = shapely.intersection(shapely.box(*lattice.corners(near)), area)
    volume[near] = shapely.area(cells)
    inside = volume > (1.0 - _ROUND_OFF) * size
    cut = ~inside & (volume > _ROUND_OFF * size)
    if not cut.any():
        return Fill(lattice.centre[inside], size[inside])
    cells = cells[cut[near]]
    mobile = lattice.grown(cut, _RINGS) & inside
    fixed = inside & ~mobile
    start = shapely.get_coordinates(shapely.centroid(cells[_evenly(cells, volume[cut] / size[cut], area)]))
    parts = [_parts(shapely.box(*lattice.corners(np.flatnonzero(which)))) for which in (cut, mobile)]
    parts[0] = shapely.intersection(parts[0], cells[:, None])
    samples = np.concatenate([part.ravel() for part in parts])
    samples = samples[~shapely.is_empty(samples)]
    relaxed = _relaxed(
        np.vstack([start, lattice.centre[mobile]]),
        shapely.get_coordinates(shapely.centroid(samples)),
        shapely.area(samples),
    )
    return Fill(np.vstack([relaxed.position, lattice.centre[fixed]]), np.concatenate([relaxed.volume, size[fixed]]))


class _Lattice(NamedTuple):
    """Centres (n, dim) and edges (n, dim) of the cells of a lattice with ``shape`` cells along the axes."""

    centre: Array
    size: Array
    shape: tuple[int, ...]

    @classmethod
    def over(cls, lower: Array, upper: Array, spacing: float, edges: Iterable[tuple[int, float]]) -> "_Lattice":
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
        return cls(grid([a[0] for a in axes]), grid([a[1] for a in axes]), tuple(len(a[0]) for a in axes))

    def corners(self, cells: IntArray) -> tuple[Array, ...]:
        lower, upper = self.centre[cells] - 0.5 * self.size[cells], self.centre[cells] + 0.5 * self.size[cells]
        return (*lower.T, *upper.T)

    def around(self, points: Array) -> BoolArray:
        """Whether each cell is the one in which a point lies, or its neighbour."""
        found = np.zeros(self.shape, dtype=np.bool_)
        index = []
        for axis, count in enumerate(self.shape):
            line = np.moveaxis(self.centre.reshape(*self.shape, -1)[..., axis], axis, 0).reshape(count, -1)[:, 0]
            index.append(np.clip(np.searchsorted(line, points[:, axis]), 0, count - 1))
        found[tuple(index)] = True
        return self.grown(found.ravel(), 1)

    def grown(self, cells: BoolArray, rings: int) -> BoolArray:
        from scipy.ndimage import binary_dilation

        block = np.ones((3,) * len(self.shape))
        return np.asarray(binary_dilation(cells.reshape(self.shape), block, iterations=rings).ravel())


def straight_edges(area: Any) -> list[tuple[int, float]]:
    """Return (axis, coordinate) of the edges of a plane ``area`` on which a coordinate is constant, longest first."""
    found = []
    for ring in shapely.get_parts(area.boundary):
        points = shapely.get_coordinates(ring)
        edge = np.abs(np.diff(points, axis=0))
        for axis in (0, 1):
            length = edge[:, 1 - axis]
            straight = edge[:, axis] <= _ROUND_OFF * length
            found += [(-length[k], axis, points[k, axis]) for k in np.flatnonzero(straight)]
    return [(axis, float(place)) for _, axis, place in sorted(found)]


def _evenly(cells: Any, share: Array, area: Any) -> BoolArray:
    """Choose as many of the ``cells`` (n,) as they hold together: where the sum of their shares passes k + 1/2.

    The sum follows the outline of ``area``, so that no part of it has more or fewer particles than another.
    """
    rings = shapely.get_parts(area.boundary)
    centre = shapely.centroid(cells)
    ring = shapely.distance(rings[:, None], centre).argmin(axis=0)
    order = np.lexsort((shapely.line_locate_point(rings[ring], centre), ring))
    chosen = np.zeros(len(cells), dtype=np.bool_)
    chosen[order] = np.diff(np.floor(np.cumsum(share[order]) + 0.5), prepend=0.0) > 0.0
    return chosen


def _parts(boxes: Any) -> Any:
    """Divide ``boxes`` (n,) into equal parts (n, parts)."""
    lower_x, lower_y, upper_x, upper_y = shapely.bounds(boxes).T[:, :, None]
    i, j = np.divmod(np.arange(_PARTS**2), _PARTS)
    width, height = (upper_x - lower_x) / _PARTS, (upper_y - lower_y) / _PARTS
    x, y = lower_x + i * width, lower_y + j * height
    return shapely.box(x, y, x + width, y + height)


def _relaxed(position: Array, samples: Array, weights: Array) -> Fill:
    """Move each particle to the centroid of the ``samples`` (m, dim) nearest to it, until none changes its particle."""
    from scipy.spatial import cKDTree

    nearest = np.full(len(samples), -1)
    volume = np.zeros(len(position))
    for _ in range(_SWEEPS):
        before, nearest = nearest, cKDTree(position).query(samples)[1]
        volume = np.bincount(nearest, weights, len(position)).astype(np.float64)
        if np.array_equal(before, nearest):
            break
        moments = [np.bincount(nearest, weights * x, len(position)) for x in samples.T]
        position = np.stack(moments, axis=1) / volume[:, None]
    return Fill(position, volume)
