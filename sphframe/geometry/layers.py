"""Geometry: points in layers behind the walls of a domain, with the volumes that they stand for.

Layer k is the line at the distance (k + 1/2) dx from the domain, with mitred corners. Points divide it evenly between
its corners, in each of which stands a point; behind a wall with a rim they are one spacing apart. A point stands for
its length of the layer times dx. Where layers are too short or meet, as in a sharp edge or in an obstacle that is
thinner than the layers, a point stands for the part of the solid that is nearest to it and is moved to the centroid of
this part, and points are added where the part is large.

Behind straight walls of whole numbers of spacings that meet at right angles this is the square lattice.
"""

from typing import NamedTuple

import numpy as np
import shapely
from scipy.spatial import Voronoi, cKDTree
from shapely import LineString

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.geometry.domain import OPEN, SHARP, Domain, turning

LONGEST_MITRE = 10.0
"""longest mitre over the distance of the layer"""
_LARGE, _FAR = 1.3, 0.8
"""volume, over that of a particle, from which a part of the solid is divided, at this distance from its point, dx"""
_RIM, _CUT, _CORNER = range(3)
"""kinds of places where a layer is cut: opposite the rim of a wall, beside a corner, and in a corner of the layer"""
_DEVIATION = 0.1
"""share by which the volume of a part may differ from length times spacing before it is used instead"""


class LayerPoints(NamedTuple):
    """Points (g, 2), m, their volumes (g,), m^2, and the edges (g,) of the domain nearest to them with feet (g, 2)."""

    position: Array
    volume: Array
    foot: Array
    edge: IntArray


def layer_points(domain: Domain, spacing: float, layers: int) -> LayerPoints:
    """Return points in ``layers`` of one ``spacing`` (m) each behind the walls of ``domain``."""
    found = [
        _along(LineString(ring), domain, (layer + 0.5) * spacing, spacing)
        for layer in range(layers)
        for ring in shapely.get_rings(shapely.get_parts(_grown(domain, (layer + 0.5) * spacing)))
    ]
    position = np.vstack([points for points, _ in found])
    volume = np.concatenate([lengths for _, lengths in found]) * spacing
    reach = 1.5 * layers * spacing
    needed = _behind_walls(position, domain, reach, 3.0 * spacing)
    position, volume = _corrected(position[needed], volume[needed], domain, spacing, layers)
    foot, edge = domain.feet(position)
    kept = (domain.wall[edge] != OPEN) & (np.hypot(*(position - foot).T) < reach)
    return LayerPoints(position[kept], volume[kept], foot[kept], edge[kept])


def _grown(domain: Domain, distance: float) -> shapely.Geometry:
    return shapely.buffer(domain.region, distance, join_style="mitre", mitre_limit=LONGEST_MITRE)


def _along(ring: LineString, domain: Domain, distance: float, spacing: float) -> tuple[Array, Array]:
    """Return points (k, 2) on a closed ``ring`` at the ``distance`` from ``domain``, and the lengths (k,) of each."""
    places, kinds = _breaks(ring, domain, distance, spacing)
    total = ring.length
    if not len(places):
        count = max(round(total / spacing), 3)
        at, lengths = (np.arange(count) + 0.5) * total / count, np.full(count, total / count)
    else:
        spans = (np.roll(places, -1) - places) % total
        spans[spans == 0.0] = total
        middle = shapely.line_interpolate_point(ring, (places + 0.5 * spans) % total)
        open_ended = domain.wall[domain.feet(shapely.get_coordinates(middle))[1]] == OPEN
        firsts, lasts = kinds, np.roll(kinds, -1)
        rims = ((firsts == _RIM) != (lasts == _RIM)) & ~open_ended
        pieces = [_divided(*piece, spacing) for piece in zip(places, spans, firsts, lasts, rims, strict=True)]
        at, lengths = _joined_at_corners(pieces, kinds == _CORNER)
    return shapely.get_coordinates(shapely.line_interpolate_point(ring, at % total)), lengths


def _breaks(ring: LineString, domain: Domain, distance: float, spacing: float) -> tuple[Array, IntArray]:
    """Return where a ``ring`` is cut (k,), as lengths along it, and the kind of each place (k,).

    It is cut at its corners, opposite the rims of walls, on both sides of right angles of the domain, and where a
    period of it begins, so that all layers between them are divided alike.
    """
    wall, right = domain.wall != OPEN, domain.sharp & (np.abs(domain.turn - 0.5 * np.pi) < 1e-6)
    first, last = wall & ~wall[domain.before], wall & ~wall[domain.after]
    seam = domain.seam
    mitre = domain.normal[seam] + domain.normal[domain.before[seam]]
    opposite = [
        domain.start[first] + distance * domain.normal[first],
        domain.end[last] + distance * domain.normal[last],
        domain.start[right] + distance * domain.normal[right],
        domain.start[right] + distance * domain.normal[domain.before[right]],
        domain.start[seam] + distance * mitre / (0.5 * np.square(mitre).sum(axis=1))[:, None],
    ]
    near = [points[shapely.distance(shapely.points(points), ring) < 1e-6 * spacing] for points in opposite]
    rims, cuts = (shapely.line_locate_point(ring, shapely.points(np.vstack(pair))) for pair in (near[:2], near[2:]))
    points = shapely.get_coordinates(ring)
    edge = np.diff(points, axis=0)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*edge.T))])[:-1]
    corners = along[np.abs(turning(np.roll(edge, 1, axis=0), edge)) > SHARP]
    places: Array = np.concatenate([rims, cuts, corners])
    kinds = np.repeat([_RIM, _CUT, _CORNER], [len(rims), len(cuts), len(corners)])
    order = np.lexsort([kinds, (places / (1e-6 * spacing)).round()])
    places, kinds = places[order], kinds[order]
    apart = np.diff(places, prepend=places[-1:] - ring.length) > 2e-6 * spacing
    return places[apart], kinds[apart]


def _divided(start: float, length: float, first: int, last: int, to_rim: bool, spacing: float) -> tuple[Array, Array]:
    """Divide a piece of a layer: places (k,) of its points and their lengths (k,).

    In a corner stands a point that takes half of the usual length. A piece that leads to a rim (``to_rim``) is divided
    from its other end into lengths of exactly one spacing, and the last length is what is left.
    """
    corners = int(first == _CORNER) + int(last == _CORNER)
    count = max(round(length / spacing - 0.5 * corners), 0 if corners else 1)
    step = length / (count + 0.5 * corners)
    at_rim = to_rim and count > 0
    lengths = np.full(count + corners, spacing if at_rim else step)
    if first == _CORNER:
        lengths[0] *= 0.5
    if last == _CORNER:
        lengths[-1] *= 0.5
    if at_rim:
        rim = 0 if first == _RIM else -1
        lengths[rim] += length - lengths.sum()
    edges = np.concatenate([[0.0], np.cumsum(lengths)])
    at = 0.5 * (edges[:-1] + edges[1:])
    if first == _CORNER:
        at[0] = 0.0
    if last == _CORNER:
        at[-1] = length
    return start + at, lengths


def _joined_at_corners(pieces: list[tuple[Array, Array]], corners: BoolArray) -> tuple[Array, Array]:
    """Join the points at the end of each piece and the start of the next one where both stand in the same corner."""
    places, lengths = [at for at, _ in pieces], [length.copy() for _, length in pieces]
    for k, corner in enumerate(corners):
        if corner and (len(pieces) > 1 or len(places[k]) > 1):
            lengths[k][0] += lengths[k - 1][-1]
            places[k - 1], lengths[k - 1] = places[k - 1][:-1], lengths[k - 1][:-1]
    return np.concatenate(places), np.concatenate(lengths)


def _behind_walls(position: Array, domain: Domain, reach: float, beside: float) -> BoolArray:
    """Whether each position (g, 2) is within ``reach`` of a wall, the nearest edge, or ``beside`` such a position."""
    foot, edge = domain.feet(position)
    within = np.hypot(*(position - foot).T) < reach
    own = within & (domain.wall[edge] != OPEN)
    if beside > 0.0 and np.any(own):
        return np.asarray(own | (within & (cKDTree(position[own]).query(position)[0] < beside)))
    return np.asarray(own)


def _corrected(position: Array, volume: Array, domain: Domain, spacing: float, layers: int) -> tuple[Array, Array]:
    """Return the points with those added that the solid needs, and the volumes of all (see the module's docstring)."""
    solid = shapely.difference(_grown(domain, layers * spacing), domain.region)
    own = _behind_walls(position, domain, 1.5 * layers * spacing, 0.0)
    free = np.zeros(len(position), dtype=np.bool_)
    nearest = _NearestParts(solid)
    for sweep in range(12):
        parts = nearest.to(position)
        areas = shapely.area(parts)
        free |= own & (np.abs(areas - volume) > _DEVIATION * np.maximum(volume, 0.1 * spacing**2))
        volume = np.where(free, areas, volume)
        position[free] = shapely.get_coordinates(_middle(parts[free]))
        large = own & (areas > _LARGE * spacing**2)
        rest = shapely.difference(parts[large], shapely.buffer(shapely.points(position[large]), _FAR * spacing))
        rest = shapely.get_parts(rest)
        new = shapely.get_coordinates(_middle(rest[shapely.area(rest) > 0.02 * spacing**2]))
        new = _apart(new, 0.7 * spacing)
        if not len(new) and sweep >= 4:
            break
        position, volume = np.vstack([position, new]), np.concatenate([volume, np.zeros(len(new))])
        free, own = (np.concatenate([flags, np.ones(len(new), dtype=np.bool_)]) for flags in (free, own))
    areas = shapely.area(nearest.to(position))
    return position, np.where(free, areas, volume)


class _NearestParts:
    """The parts of a ``solid`` that are nearest to points, some of which move and to which others are added."""

    def __init__(self, solid: shapely.Geometry) -> None:
        self._solid, self._pieces = solid, shapely.STRtree(shapely.get_parts(solid))
        self._position, self._parts = np.empty((0, 2)), np.empty(0, dtype=object)
        self._neighbours = np.empty((0, 2), dtype=np.int64)

    def to(self, position: Array) -> Array:
        """Return the part nearest to each position (g, 2); the first of them are those of the last call, in order.

        A cell of the Voronoi diagram changes only if its point or that of a neighbour, before or after, has moved.
        """
        if np.array_equal(position, self._position):
            return self._parts
        low, high = position.min(axis=0), position.max(axis=0)
        far = np.max(high - low) + 1.0
        around = np.array([low - far, high + far, [low[0] - far, high[1] + far], [high[0] + far, low[1] - far]])
        cells = Voronoi(np.vstack([position, around]))
        between = cells.ridge_points[np.all(cells.ridge_points < len(position), axis=1)]
        moved = np.ones(len(position), dtype=np.bool_)
        moved[: len(self._position)] = np.any(position[: len(self._position)] != self._position, axis=1)
        pairs = np.vstack([self._neighbours, between])
        moved[pairs[np.any(moved[pairs], axis=1)]] = True
        regions = [cells.regions[k] for k in cells.point_region[: len(position)][moved]]
        numbers = np.repeat(np.arange(len(regions)), [len(region) for region in regions])
        rings = shapely.linearrings(cells.vertices[np.concatenate(regions)], indices=numbers)
        parts = np.append(self._parts, np.empty(len(position) - len(self._parts), dtype=object))
        parts[moved] = self._within(shapely.polygons(rings))
        self._position, self._parts, self._neighbours = position.copy(), parts, between
        return parts

    def _within(self, cells: Array) -> Array:
        """Return the intersection of each cell with the solid, or with the only piece of it that the cell meets."""
        met, pieces = self._pieces.query(cells)
        once = np.bincount(met)[met] == 1
        solids = np.full(len(cells), self._solid, dtype=object)
        solids[met[once]] = self._pieces.geometries[pieces[once]]
        return np.asarray(shapely.intersection(cells, solids))


def _middle(polygons: Array) -> Array:
    """Return a point of each polygon: its centroid if it contains it."""
    centroid = shapely.centroid(polygons)
    return np.asarray(np.where(shapely.contains(polygons, centroid), centroid, shapely.point_on_surface(polygons)))


def _apart(points: Array, least: float) -> Array:
    """Return those of ``points`` (k, 2) that are not within ``least`` of an earlier one."""
    kept = np.ones(len(points), dtype=np.bool_)
    for i, j in sorted(cKDTree(points).query_pairs(least)) if len(points) else ():
        if kept[i]:
            kept[j] = False
    return points[kept]
