"""Geometry: the particles that fill a region, each with the volume of its own cell."""

import itertools
import math
from collections.abc import Iterable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import shapely

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.geometry.columns import parts_inside, straight_faces
from sphframe.geometry.regions import Region
from sphframe.geometry.shapes import CHORD, Box, grid

_PARTS = 8
"""parts along each edge into which cells near an outline are divided"""
_RINGS = 2
"""cells around those that the outline cuts whose particles are relaxed with them"""
_SWEEPS = 20
_BLOCK = 4
"""cells along each edge of a block in which the number of particles is right"""
_ROUND_OFF = 1e-9


class Fill(NamedTuple):
    """The particles of a region: positions (n, dim), m, and volumes (n,), m^dim, whose sum is that of the region."""

    position: Array
    volume: Array


@lru_cache(maxsize=32)
def fill(region: Region, spacing: float) -> Fill:
    """Return the particles that fill ``region``, about one ``spacing`` (m) apart.

    They lie at the centres of lattice cells, stretched so that the lattice fits all straight edges of the outline that
    are parallel to an axis and at least 1.5 spacings apart. Where an outline cuts cells, the particles of these and of
    two cells around become the centres of their Voronoi cells within the region, by Lloyd's algorithm: the first layer
    follows the outline, half a spacing inside, and each volume is that of a Voronoi cell.

    Parameters
    ----------
    region: what is filled; the result is kept, so that the arrays are read-only.
    spacing: m.

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
    return (_filled_area if region.dimension == 2 else _filled_solid)(region, spacing)


def _filled_area(region: Region, spacing: float) -> Fill:
    area = region.geometry(CHORD * spacing)
    lower, upper = np.reshape(area.bounds, (2, 2))
    lattice = _Lattice.over(lower, upper, spacing, straight_edges(area))
    near = np.flatnonzero(lattice.around(shapely.get_coordinates(shapely.segmentize(area.boundary, 0.25 * spacing))))
    shapely.prepare(area)
    size = lattice.size.prod(axis=1)
    volume = np.where(shapely.contains_xy(area, lattice.centre), size, 0.0)
    cells = shapely.intersection(shapely.box(*lattice.corners(near)), area)
    volume[near] = shapely.area(cells)
    cut, mobile, fixed = lattice.kinds(volume)
    cells = cells[cut[near]]
    start = shapely.get_coordinates(shapely.centroid(cells[lattice.chosen(cut, volume / size)[cut]]))
    parts = [_parts(shapely.box(*lattice.corners(np.flatnonzero(which)))) for which in (cut, mobile)]
    parts[0] = shapely.intersection(parts[0], cells[:, None])
    samples = np.concatenate([part.ravel() for part in parts])
    samples = samples[~shapely.is_empty(samples)]
    return lattice.filled(
        start, mobile, fixed, shapely.get_coordinates(shapely.centroid(samples)), shapely.area(samples)
    )


def _filled_solid(region: Region, spacing: float) -> Fill:
    mesh = region.geometry(0.02 * spacing)
    lattice = _Lattice.over(mesh.bounds[0], mesh.bounds[1], spacing, straight_faces(mesh))
    size = lattice.size.prod(axis=1)
    volume, moment = np.zeros(len(size)), np.zeros((len(size), 3))
    for cell, centre, part in parts_inside(mesh, lattice.axes):
        volume += np.bincount(cell, part, len(size))
        moment += np.stack([np.bincount(cell, part * x, len(size)) for x in centre.T], axis=1)
    cut, mobile, fixed = lattice.kinds(volume)
    chosen = lattice.chosen(cut, volume / size)
    found = [
        (centre[which], part[which] * np.where(cut[cell[which]], exact, 1.0))
        for exact in [(mesh.volume - size[mobile | fixed].sum()) / max(volume[cut].sum(), 1e-300)]
        for cell, centre, part in parts_inside(mesh, lattice.axes)
        for which in [np.flatnonzero((cut | mobile)[cell])]
    ]
    samples, weights = (np.concatenate(arrays) for arrays in zip(*found, strict=True))
    return lattice.filled(moment[chosen] / volume[chosen, None], mobile, fixed, samples, weights)


def common_part(one: Region, other: Region, spacing: float) -> tuple[float, Array] | None:
    """Return the measure (m2 or m3) and the centre (dim,) of what two regions have in common; None if they only touch.

    An overlap thinner than a hundredth of a ``spacing`` is round-off; between solids other than boxes, than a tenth.
    """
    if one.dimension == 2:
        common = one.geometry(CHORD * spacing).intersection(other.geometry(CHORD * spacing))
        thin = common.buffer(-0.005 * spacing).is_empty
        return None if thin else (float(common.area), shapely.get_coordinates(common.centroid)[0])
    bounds = np.array([one.bounds(), other.bounds()])
    lower, upper = bounds[:, 0].max(axis=0), bounds[:, 1].min(axis=0)
    if np.any(upper - lower < 0.01 * spacing):
        return None
    if isinstance(one, Box) and isinstance(other, Box):
        return float(np.prod(upper - lower)), 0.5 * (lower + upper)
    lattice = _Lattice.over(lower, upper, spacing, ())
    size = lattice.size.prod(axis=1)
    twice = -size
    for region in (one, other):
        for cell, _, part in parts_inside(region.geometry(0.02 * spacing), lattice.axes):
            twice += np.bincount(cell, part, len(size))
    twice[twice < 0.1 * size] = 0.0
    return (float(twice.sum()), twice @ lattice.centre / twice.sum()) if twice.any() else None


class _Lattice(NamedTuple):
    """A lattice of cells: their centres and widths along each axis, and centres (n, dim) and edges (n, dim) of all."""

    axes: list[tuple[Array, Array]]
    centre: Array
    size: Array

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
        return cls(axes, grid([centre for centre, _ in axes]), grid([width for _, width in axes]))

    def kinds(self, volume: Array) -> tuple[BoolArray, BoolArray, BoolArray]:
        """Whether each cell, of which ``volume`` is inside, is cut, is full and near those, or is full and far."""
        size = self.size.prod(axis=1)
        full = volume > (1.0 - _ROUND_OFF) * size
        cut = ~full & (volume > _ROUND_OFF * size)
        mobile = self.grown(cut, _RINGS) & full
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

    def filled(self, start: Array, mobile: BoolArray, fixed: BoolArray, samples: Array, weights: Array) -> Fill:
        """Relax particles at ``start`` and in ``mobile`` cells; those in ``fixed`` cells stay."""
        position, volume = _relaxed(np.vstack([start, self.centre[mobile]]), samples, weights)
        fixed_volume = self.size[fixed].prod(axis=1)
        return Fill(np.vstack([position, self.centre[fixed]]), np.concatenate([volume, fixed_volume]))

    def corners(self, cells: IntArray) -> tuple[Array, ...]:
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
        from scipy.ndimage import binary_dilation

        block = cells.reshape([len(centre) for centre, _ in self.axes])
        return np.asarray(binary_dilation(block, np.ones((3,) * block.ndim), iterations=rings).ravel())


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
        held = volume > 0.0
        position, volume = np.stack(moments, axis=1)[held] / volume[held, None], volume[held]
    return Fill(position, volume)
