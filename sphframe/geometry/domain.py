"""Geometry: the part of the plane that the fluid can reach, as bounded by walls.

Walls are lines without direction. They cut the plane into faces. The fluid at the start tells which faces are wet; a
face without fluid belongs to the domain too if the fluid can flow into it above the rim of a wall. Ends of walls that
meet nothing are continued by open edges: along the wall, then upwards. Nothing bounds the fluid there. A line that is
wet on both sides has an edge on each of them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import shapely
from shapely import LineString, Point, Polygon

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.errors import InputError
from sphframe.particles import Periods

OPEN = -1
"""index of the wall of an edge where there is no wall"""
SHARP = np.radians(30.0)
"""smallest change of direction that makes a corner; smaller ones approximate a curve"""
_SAME = 1e-6
"""share of a particle spacing below which two points are the same"""
_NO_SIDES = np.zeros((0, 2, 2))


@dataclass(frozen=True)
class Domain:
    """Polygons that the fluid can reach, in m, and the edges of their boundary, with the fluid on their left.

    Attributes
    ----------
    region
        the domain, with open edges continued far beyond the walls; it contains lines that are wet on both sides.
    start, end
        (m, 2) ends of the edges; ``wall`` (m,) index of their walls, ``OPEN`` where there is none.
    before, after
        (m,) edges that share the start and the end of each edge.
    periods
        of the domain, which contains the copies around the box that is simulated; None if there are none.
    """

    region: shapely.Geometry
    start: Array
    end: Array
    wall: IntArray
    before: IntArray
    after: IntArray
    periods: Periods | None = None

    @cached_property
    def _tree(self) -> shapely.STRtree:
        return shapely.STRtree(shapely.linestrings(np.stack([self.start, self.end], axis=1)))

    @cached_property
    def normal(self) -> Array:
        """Unit normals (m, 2) of the edges, out of the fluid."""
        edge = self.end - self.start
        return np.asarray(np.stack([edge[:, 1], -edge[:, 0]], axis=1) / np.hypot(*edge.T)[:, None])

    @cached_property
    def turn(self) -> Array:
        """Change of direction of the boundary at the start (m,) of each edge, rad; positive where the fluid narrows."""
        return turning(self.normal[self.before], self.normal)

    @cached_property
    def sharp(self) -> BoolArray:
        """Whether the boundary has a corner between two edges of walls at the start (m,) of each edge."""
        return np.asarray((np.abs(self.turn) > SHARP) & (self.wall != OPEN) & (self.wall[self.before] != OPEN))

    @cached_property
    def seam(self) -> BoolArray:
        """Whether each edge (m,) of a wall starts where one period ends and the next one begins."""
        if not self.periods:
            return np.zeros(len(self.wall), dtype=np.bool_)
        length = np.where(self.periods.repeats, self.periods.length, np.inf)
        place = (self.start - self.periods.lower) / length
        on_border = np.any((np.abs(place - np.rint(place)) < 1e-9) & self.periods.repeats, axis=1)
        return np.asarray(on_border & (self.wall != OPEN) & (self.wall[self.before] != OPEN) & ~self.sharp)

    @cached_property
    def two_sided(self) -> BoolArray:
        """Whether each edge (m,) is a side of a line that is wet on both sides."""
        pairs = {(*a, *b) for a, b in zip(self.start.tolist(), self.end.tolist(), strict=True)}
        back = np.hstack([self.end, self.start]).tolist()
        return np.array([tuple(edge) in pairs for edge in back], dtype=np.bool_)

    def feet(self, points: Array) -> tuple[Array, IntArray]:
        """Return the nearest points (n, 2) of the boundary to ``points`` (n, 2), and their edges (n,)."""
        order = self._tree.query_nearest(shapely.points(points), all_matches=False)
        edge = np.empty(len(points), np.int64)
        edge[order[0]] = order[1]
        start, along = self.start[edge], (self.end - self.start)[edge]
        share = np.einsum("ij,ij->i", points - start, along) / np.einsum("ij,ij->i", along, along)
        return start + np.clip(share, 0.0, 1.0)[:, None] * along, edge

    def behind(self, points: Array) -> BoolArray:
        """Return whether each of ``points`` (n, 2) lies behind a wall: outside, and a wall is the nearest edge."""
        shapely.prepare(self.region)
        behind = ~shapely.contains_xy(self.region, points[:, 0], points[:, 1])
        out = np.flatnonzero(behind)
        foot, edge = self.feet(points[out])
        on_wall = np.hypot(*(points[out] - foot).T) <= 1e-9 * (1.0 + np.abs(points[out]).max(initial=0.0))
        behind[out] = (self.wall[edge] != OPEN) & ~on_wall
        return np.asarray(behind)


def turning(before: Array, after: Array) -> Array:
    """Return the angles (m,) from directions ``before`` (m, 2) to ``after`` (m, 2), rad."""
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return np.asarray(np.arctan2(cross, np.einsum("ij,ij->i", before, after)))


def fluid_domain(
    walls: Mapping[str, Sequence[Array]],
    fluid: shapely.Geometry,
    spacing: float,
    *,
    one_sided: Sequence[int] = (),
    two_sided: Sequence[int] = (),
    periods: Periods | None = None,
) -> Domain:
    """Return the domain within ``walls`` that the ``fluid`` can reach.

    Parameters
    ----------
    walls
        for the name of each wall its polylines (k, 2), m; the ends of a closed one are equal.
    fluid
        region of the fluid at the start, m, or a collection of regions; walls may run between two regions.
    spacing
        particle spacing, m. Ends that are closer than a millionth of it are joined.
    one_sided
        indices of walls that are wet on one side only, although the other side can be reached.
    two_sided
        indices of walls that may be wet on both sides.
    periods
        of walls and fluid, which are given with their copies around the box that is simulated.

    Raises
    ------
    InputError
        when a wall runs through the fluid, or fluid can reach both of its sides though they are not
        ``two_sided``; with its name and the place.
    """
    lines = _joined([LineString(line) for wall in walls.values() for line in wall], _SAME * spacing)
    owners = np.array([index for index, wall in enumerate(walls.values()) for _ in wall])
    net = shapely.unary_union(lines)
    lowest, highest = shapely.total_bounds([net, fluid]).reshape(2, 2)
    margin = 100.0 * spacing + 0.1 * float(np.max(highest - lowest))
    frame = shapely.box(*(lowest - margin), *(highest + margin))
    single = shapely.union_all(np.array(lines)[np.isin(owners, one_sided)])
    inner = frame
    if periods:  # walls go straight on where more copies would follow
        end = np.where(periods.repeats, periods.length - _SAME * spacing, np.inf)
        lower, upper = lowest - margin, highest + margin
        inner = shapely.box(
            *np.maximum(periods.lower - end, lower), *np.minimum(periods.lower + periods.length + end, upper)
        )
    rims, bars = _open_edges(net, single, frame, inner, 8.0 * spacing)
    edges = shapely.unary_union([net, frame.boundary, *rims, *bars])
    faces = shapely.get_parts(shapely.polygonize(shapely.get_parts(edges)))
    core = shapely.union_all(shapely.buffer(shapely.get_parts(fluid), -0.25 * spacing))
    core = fluid if core.is_empty else core  # a sliver on the other side of a wall does not count
    wet = shapely.area(shapely.intersection(faces, core)) > 1e-6 * min(core.area, spacing**2)
    region = shapely.union_all(faces[_reached(faces, wet, shapely.union_all(rims), frame)])
    sides = _both_sides(edges, net, region, _SAME * spacing)
    domain = replace(domain_of(region, lines, owners, _SAME * spacing, sides), periods=periods)
    _check_two_sided(domain, list(walls), core, two_sided, spacing)
    return domain


def _both_sides(edges: shapely.Geometry, net: shapely.Geometry, region: shapely.Geometry, closest: float) -> Array:
    """Return the segments (k, 2, 2) of the ``edges`` that lie on walls within the ``region``."""
    within = shapely.difference(shapely.intersection(net, region), shapely.buffer(region.boundary, closest))
    if shapely.length(within) <= closest:
        return _NO_SIDES
    pieces = [np.stack([line[:-1], line[1:]], axis=1) for line in map(shapely.get_coordinates, edges.geoms)]
    segments = np.concatenate(pieces)
    distance = shapely.distance(within, shapely.points(segments.mean(axis=1)))
    return np.asarray(segments[distance <= closest])


def _check_two_sided(
    domain: Domain, names: list[str], core: shapely.Geometry, two_sided: Sequence[int], spacing: float
) -> None:
    edges = np.flatnonzero(domain.two_sided)
    sides = shapely.linestrings(np.stack([domain.start, domain.end], axis=1)[edges])
    crossing = shapely.length(shapely.intersection(sides, core)) > _SAME * spacing
    wrong = crossing | ~np.isin(domain.wall[edges], two_sided)
    if np.sum(shapely.length(sides[wrong])) <= spacing:
        return
    k = int(np.argmax(crossing) if np.any(crossing) else np.argmax(wrong))
    place = shapely.point_on_surface(shapely.intersection(sides[k], core) if crossing[k] else sides[k])
    at = f"wall {names[domain.wall[edges[k]]]!r}", f"at ({place.x:.6g}, {place.y:.6g})"
    if crossing[k]:
        raise InputError(f"{at[0]} runs through the fluid {at[1]}: draw the fluid within the walls, up to their lines")
    raise InputError(
        f"{at[0]} has fluid on both sides, or fluid that can flow to its other side, {at[1]}: draw a closed wall around"
        " what is solid; draw a wall without thickness as a polyline, an arc or a polygon of two points; or set"
        " one_sided = true for a wall whose back stays dry"
    )


def _joined(lines: list[LineString], closest: float) -> list[LineString]:
    """Return ``lines`` whose ends lie exactly on the lines that they meet within ``closest``, m."""
    for index, line in enumerate(lines):
        ends = shapely.get_point(line, [0, -1])
        for other in (k for k in range(len(lines)) if k != index):
            near = ends[shapely.distance(ends, lines[other]) <= closest]
            if len(near):
                lines[other] = shapely.snap(lines[other], shapely.multipoints(near), closest)
    return lines


def _open_edges(
    net: shapely.Geometry, single: shapely.Geometry, frame: Polygon, within: Polygon, onward: float
) -> tuple[list[LineString], list[LineString]]:
    """Return open edges from the ends of walls that meet nothing: those that the fluid may cross, and those that not.

    An edge continues its wall for the length ``onward`` and then goes upwards, or upwards at once where something is in
    the way. It is left out where there is still something in the way. From a wall in ``single``, and outside of
    ``within``, it goes straight on.
    """
    ends: dict[tuple[float, ...], list[Array]] = {}
    for line in shapely.get_parts(net):
        points = shapely.get_coordinates(line)
        for here, inner in ((points[0], points[1]), (points[-1], points[-2])):
            ends.setdefault(tuple(here), []).append(here - inner)
    top, size = frame.bounds[3], frame.length
    rims, bars = [], []
    for point, directions in ends.items():
        if len(directions) > 1:
            continue
        here = np.array(point)
        along = directions[0] / np.hypot(*directions[0])
        further = here + onward * along
        on_single = not single.is_empty and shapely.distance(Point(point), single) == 0.0
        if on_single or not within.contains(Point(point)):
            bars.append(shapely.intersection(LineString([here, here + size * along]), frame))
            continue
        for path in ([here, further, (further[0], top)], [here, (here[0], top)]):
            edge = LineString(path)
            if edge.is_simple and shapely.intersection(edge, net).equals(Point(point)):
                rims.append(edge)
                break
    return rims, bars


def _reached(faces: Array, wet: BoolArray, rims: shapely.Geometry, frame: Polygon) -> BoolArray:
    """Return which of the ``faces`` are ``wet`` or can be reached from such a face across the ``rims`` of walls.

    A dry face at the bottom or at a side of the ``frame`` is outside: water does not flow over the rim of a tank.
    """
    left, bottom, right, top = frame.bounds
    outer = LineString([(left, top), (left, bottom), (right, bottom), (right, top)])
    edges = shapely.boundary(faces)
    inside = wet | (shapely.length(shapely.intersection(edges, outer)) == 0.0)
    across = shapely.intersection(edges, rims)
    reached, frontier = wet.copy(), list(np.flatnonzero(wet))
    while frontier:
        shared = shapely.length(shapely.intersection(across, across[frontier.pop()])) > 0.0
        new = np.flatnonzero(shared & inside & ~reached)
        reached[new] = True
        frontier.extend(new)
    return reached


def domain_of(
    region: shapely.Geometry, lines: Sequence[LineString], owners: IntArray, closest: float, sides: Array = _NO_SIDES
) -> Domain:
    """Return the domain of a ``region``, whose edges on the ``lines`` are those of the walls ``owners``.

    Each of the ``sides`` (k, 2, 2) is an edge in both directions.
    """
    rings = [
        shapely.get_coordinates(ring)
        for polygon in shapely.get_parts(region)
        for ring in shapely.get_rings(shapely.orient_polygons(polygon))
    ]
    start = np.vstack([*(points[:-1] for points in rings), sides[:, 0], sides[:, 1]])
    end = np.vstack([*(points[1:] for points in rings), sides[:, 1], sides[:, 0]])
    tree = shapely.STRtree(lines)
    edge, line = tree.query_nearest(shapely.points(0.5 * (start + end)), max_distance=closest)
    wall = np.full(len(start), len(owners))
    np.minimum.at(wall, edge, owners[line])
    wall[wall == len(owners)] = OPEN
    return Domain(region, start, end, wall, *_neighbours(start, end))


def _neighbours(start: Array, end: Array) -> tuple[IntArray, IntArray]:
    """Return the edges before and after each edge, from ``start`` (m, 2) to ``end`` (m, 2), with the fluid on its left.

    Where several edges start from one point, the next one is the first that is met clockwise from the edge backwards.
    """
    leaving: dict[tuple[float, ...], list[int]] = {}
    for k, point in enumerate(start.tolist()):
        leaving.setdefault(tuple(point), []).append(k)
    angle = np.arctan2(*(end - start).T[::-1])
    after = np.empty(len(start), np.int64)
    for k, point in enumerate(end.tolist()):
        others = np.array(leaving[tuple(point)])
        turned = (angle[k] + np.pi - angle[others]) % (2.0 * np.pi)
        turned[turned < 1e-9] = 2.0 * np.pi  # back along the other side of the same line
        after[k] = others[np.argmin(turned)]
    before = np.empty_like(after)
    before[after] = np.arange(len(start))
    return before, after
