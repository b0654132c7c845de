"""Geometry: charts, the pieces into which thin walls cut the boundary of a domain, each with ghosts of its own.

A wall is thin where fluid lies within the kernel's support behind it. Ghosts behind one side of it then lie in the
fluid on the other side, or among the ghosts of that side, and a particle must see those of its own side alone. The
boundary is therefore cut at the ends of lines and at the convex corners of thin solids, and each piece, a chart, is
continued straight by one support beyond its cuts. A particle sees a ghost if the first wall on the way to it is one of
the ghost's own chart, and another particle if there is no thin wall on the way
(:mod:`sphframe.neighbours.sight`). So each particle sees its surroundings filled once: by the fluid in its line of
sight, and behind each wall by the ghosts of one chart.
"""

from typing import NamedTuple

import numpy as np
import shapely
from shapely import LineString

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.geometry.domain import OPEN, SHARP, Domain, domain_of
from sphframe.geometry.layers import LONGEST_MITRE

THICK, THIN, BEYOND = range(3)
_BACK = np.pi - 1e-6
"""change of direction at the end of a line"""
_STRIP = 0.45
"""width over spacing of the strip of fluid that stands for the domain of a chart"""
_RIM = 8.0
"""length over spacing by which the open end of a chart is continued"""


class Chart(NamedTuple):
    """A piece of the boundary: its ``edges`` (m,) in the domain, and the ``strip`` of fluid in front of them.

    ``kind`` (e,) of each edge of the strip: ``THICK``, ``THIN``, or ``BEYOND`` for the continuation of a wall.
    ``tips`` (2,): 1 where it starts and ends at the end of a line, -1 at a corner between it and another chart, else 0.
    """

    edges: IntArray
    strip: Domain
    kind: IntArray
    tips: IntArray


def thin_solid(region: shapely.Geometry, least: float) -> tuple[float, float] | None:
    """Return a point, m, where the solid around ``region`` is thinner than ``least`` (m); None if there is none.

    A solid is thick enough where a square of this width fits; a sharp edge belongs to what is behind it.
    """
    solid = shapely.difference(shapely.buffer(region, 2.0 * least, join_style="mitre"), region)
    core = shapely.buffer(solid, -0.499 * least, join_style="mitre", mitre_limit=LONGEST_MITRE)
    thick = shapely.buffer(core, 0.5 * least, join_style="mitre", mitre_limit=LONGEST_MITRE)
    thin = shapely.get_parts(shapely.difference(solid, thick))
    thin = thin[shapely.area(thin) > 0.01 * least**2]
    if not len(thin):
        return None
    place = shapely.point_on_surface(thin[0])
    return place.x, place.y


def thin_edges(domain: Domain, support: float) -> BoolArray:
    """Return whether each edge (m,) of walls has fluid within one ``support`` (m) behind it."""
    behind = support * domain.normal
    strips = shapely.polygons(
        np.stack([domain.start, domain.end, domain.end + behind, domain.start + behind, domain.start], axis=1)
    )
    shapely.prepare(domain.region)
    wet = shapely.area(shapely.intersection(strips, domain.region)) > 1e-6 * support * np.hypot(
        *(domain.end - domain.start).T
    )
    return np.asarray((domain.two_sided | wet) & (domain.wall != OPEN))


def charts_of(domain: Domain, thin: BoolArray, spacing: float, layers: int) -> list[Chart]:
    """Cut the boundary of ``domain``, whose ``thin`` edges (m,) have fluid behind them, into charts."""
    walled, reach = domain.wall != OPEN, layers * spacing
    convex = (domain.turn < -SHARP) | (np.abs(domain.turn) > _BACK)
    first = walled & (~walled[domain.before] | (convex & (thin | thin[domain.before])))
    return [_chart(domain, chain, first, thin, spacing, reach) for chain in _chains(domain, walled, first)]


def _chains(domain: Domain, walled: BoolArray, first: BoolArray) -> list[IntArray]:
    """Return the edges of each piece of the boundary, in their order; ``first`` (m,) marks where pieces start."""
    left, chains = walled.copy(), []
    for start in [*np.flatnonzero(first), *np.flatnonzero(walled)]:
        chain: list[int] = []
        k = int(start)
        while left[k] and not (chain and first[k]):
            left[k] = False
            chain.append(k)
            k = int(domain.after[k])
        if chain:
            chains.append(np.array(chain))
    return chains


def _chart(domain: Domain, chain: IntArray, first: BoolArray, thin: BoolArray, spacing: float, reach: float) -> Chart:
    points = np.vstack([domain.start[chain], domain.end[chain[-1:]]])
    walls = domain.wall[chain]
    closed = bool(domain.after[chain[-1]] == chain[0] and not first[chain[0]])
    lines = [LineString(points[k : k + 2]) for k in range(len(chain))]
    owners = walls
    line, tips = points, np.zeros(2, np.int64)
    if not closed:
        ends = np.array([chain[0], chain[-1]])
        along = (domain.end - domain.start)[ends]
        along *= np.array([[-1.0], [1.0]]) / np.hypot(*along.T)[:, None]
        cut = np.asarray(domain.wall[np.array([domain.before[ends[0]], domain.after[ends[1]]])] != OPEN)
        length = np.where(cut, reach, _RIM * spacing)
        further = points[[0, -1]] + length[:, None] * along
        at_tip = np.abs(domain.turn[[chain[0], domain.after[chain[-1]]]]) > _BACK
        tips = np.where(cut, np.where(at_tip, 1, -1), 0)
        for k in np.flatnonzero(cut):
            lines.append(LineString([points[[0, -1]][k], further[k]]))
            owners = np.append(owners, walls[[0, -1]][k])
        line = np.vstack([further[:1], points, further[1:]])
    strip = _strip_beside(line, closed, spacing)
    made = domain_of(strip, lines, owners, 1e-6 * spacing)
    nearest = shapely.STRtree(lines).nearest(shapely.points(0.5 * (made.start + made.end)))
    kind = np.concatenate([np.where(thin[chain], THIN, THICK), np.full(len(lines) - len(chain), BEYOND)])[nearest]
    return Chart(chain, made, kind, tips)


def _strip_beside(line: Array, closed: bool, spacing: float) -> shapely.Geometry:
    """Return the strip on the left of a ``line`` (k, 2)."""
    width = _STRIP * spacing
    tube = shapely.buffer(LineString(line), width, cap_style="flat", join_style="mitre", mitre_limit=LONGEST_MITRE)
    cut = line
    if not closed:  # a line that ends exactly on the edge of the tube might not cut it
        along = np.array([line[0] - line[1], line[-1] - line[-2]])
        along *= spacing / np.hypot(*along.T)[:, None]
        cut = np.vstack([line[0] + along[0], line, line[-1] + along[1]])
    pieces = shapely.get_parts(
        shapely.polygonize(shapely.get_parts(shapely.unary_union([tube.boundary, LineString(cut)])))
    )
    edge = np.diff(line, axis=0)
    left = np.stack([-edge[:, 1], edge[:, 0]], axis=1) / np.hypot(*edge.T)[:, None]
    inside = 0.5 * (line[:-1] + line[1:]) + 1e-3 * width * left
    tree = shapely.STRtree(pieces)
    chosen = np.unique(tree.query(shapely.points(inside), predicate="within")[1])
    return shapely.union_all(pieces[chosen])


def back_to_back(domain: Domain, chart: Chart, reach: float) -> tuple[float, float] | None:
    """Return a point, m, where a chart's own back is within ``reach`` (m) behind it; None if there is none.

    The ghosts behind both sides of the solid would be seen from each of them.
    """
    start, end, normal = (part[chart.edges] for part in (domain.start, domain.end, domain.normal))
    middle, length = 0.5 * (start + end), np.hypot(*(end - start).T)
    for k in range(len(start)):
        offset = middle - start[k]
        depth, along = offset @ normal[k], offset @ (end[k] - start[k]) / length[k]
        facing = (normal @ normal[k] < -0.5) & (depth > 0.0) & (depth < reach) & (along >= 0.0) & (along <= length[k])
        if np.any(facing):
            x, y = middle[np.argmax(facing)]
            return float(x), float(y)
    return None


def seen_mirrors(domain: Domain, foot: Array, mirror: Array, reflection: Array) -> tuple[Array, Array]:
    """Return ``mirror`` points (g, 2) and ``reflection`` matrices, reflected again in walls in front of these points.

    They are seen from the walls of their ghosts, at ``foot`` (g, 2).
    """
    walled = np.flatnonzero(domain.wall != OPEN)
    tree = shapely.STRtree(shapely.linestrings(np.stack([domain.start, domain.end], axis=1)[walled]))
    mirror, reflection = mirror.copy(), reflection.copy()
    seen_from = foot + 1e-6 * (mirror - foot)
    for _ in range(2):
        ghost, edge = tree.query(shapely.linestrings(np.stack([seen_from, mirror], axis=1)), predicate="intersects")
        edge = walled[edge]
        start, normal = domain.start[edge], domain.normal[edge]
        far, near = (np.einsum("ij,ij->i", points[ghost] - start, normal) for points in (mirror, seen_from))
        into = (far > 0.0) & (near < 0.0)
        ghost, edge, share = ghost[into], edge[into], near[into] / (near - far)[into]
        order = np.lexsort([share, ghost])
        ghost, place = np.unique(ghost[order], return_index=True)
        edge, share = edge[order][place], share[order][place][:, None]
        normal, start = domain.normal[edge], domain.start[edge]
        depth = np.einsum("ij,ij->i", mirror[ghost] - start, normal)[:, None]
        crossing = seen_from[ghost] + share * (mirror[ghost] - seen_from[ghost])
        mirror[ghost] -= 2.0 * depth * normal
        seen_from[ghost] = crossing - 1e-6 * depth * normal
        turned = np.eye(2) - 2.0 * normal[:, :, None] * normal[:, None, :]
        reflection[ghost] = turned @ reflection[ghost]
    return mirror, reflection
