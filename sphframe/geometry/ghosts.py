"""Geometry: walls that one body carries: their ghost particles with mirror points, their panels, and what is behind.

A ghost particle at x_G outside the fluid belongs to the nearest point c of a wall. Its mirror point is
x_M = 2 c - x_G, inside the fluid, and its reflection matrix S turns the velocity of the fluid relative to the wall at
the mirror point into that of the ghost for free slip: S = 1 - 2 n n^T next to a face; the product of the faces'
reflections where c lies on an edge or corner, which for two faces of a plane is the point reflection S = -1. Where the
mirror point lies behind another wall or nearer to it than half a spacing, which happens in acute corners, it is moved
to the nearest point half a spacing inside the fluid.

Source: S. Marrone et al. (2011), doi:10.1016/j.cma.2010.12.016; X. Huang et al. (2019), doi:10.3390/w11051110,
section 2.2.
"""

import itertools
from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import Any, NamedTuple, final

import numpy as np
import shapely
from shapely import affinity

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.errors import InputError
from sphframe.geometry.charts import (
    BEYOND,
    THICK,
    THIN,
    Chart,
    back_to_back,
    charts_of,
    seen_mirrors,
    thin_edges,
    thin_solid,
)
from sphframe.geometry.domain import OPEN, Domain, fluid_domain
from sphframe.geometry.layers import layer_points
from sphframe.geometry.shapes import CHORD
from sphframe.geometry.walls import Wall
from sphframe.particles import Periods

_BORDER = 1e-6
"""share of a spacing by which the border between two periods is moved off the lattice"""
NONE = -1
"""index of a wall or body that there is not"""


class GhostPoints(NamedTuple):
    """Fixed ghost particles, in m, as drawn (before any body moves).

    ``position`` (g, dim), ``mirror`` (g, dim); ``foot`` (g, dim) the nearest point of the wall, ``normal`` (g, dim) the
    unit vector from there to the ghost, out of the fluid; ``reflection`` (g, dim, dim) for free slip, ``volume`` (g,)
    in m^dim, ``wall`` (g,) index of the wall that each belongs to. In a corner between two walls, ``other`` (g,) is the
    second wall, else ``NONE``. Its part of the force F on the ghost is (F.d) n with its normal n, ``other_normal``
    (g, dim), and d, ``other_dual`` (g, dim), which is perpendicular to the normal of the first wall and has d.n = 1.
    """

    position: Array
    mirror: Array
    foot: Array
    normal: Array
    reflection: Array
    volume: Array
    wall: IntArray
    other: IntArray
    other_normal: Array
    other_dual: Array

    @classmethod
    def without_corners(cls, *parts: Any) -> "GhostPoints":
        """Return ghosts of which each belongs to one wall, from all fields but the last three."""
        nothing = np.zeros_like(parts[0])
        return cls._make([*parts, np.full(len(nothing), NONE), nothing, nothing])


class Sides(NamedTuple):
    """Sides of plane walls, which hide what is behind them (:mod:`sphframe.geometry.charts`).

    ``ends`` (k, 4): x, y of their starts and ends, m, with the fluid on the left; ``tips`` (k, 2): 1 where these
    are ends of lines, -1 where they are corners between charts, else 0; the ``chart`` (k,) of each side, its ``wall``
    (k,), and whether it is ``thin`` (k,). ``ghost_chart`` (g,) and ``kind`` (g,) are those of the ghosts.
    """

    ends: Array
    tips: IntArray
    chart: IntArray
    wall: IntArray
    thin: BoolArray
    ghost_chart: IntArray
    kind: IntArray


class Panels(NamedTuple):
    """Panel ``centre`` (k, dim), m; ``area`` (k, dim), the area vector out of the fluid, m^(dim-1); ``wall`` (k,)."""

    centre: Array
    area: Array
    wall: IntArray

    @property
    def two_sided(self) -> BoolArray:
        """Whether each panel (k,) is a side of a wall without thickness: another one has the opposite area there."""
        centre, number = np.unique(self.centre.round(9), axis=0, return_inverse=True)
        size, area = np.zeros(len(centre)), np.zeros_like(centre)
        np.add.at(size, number.ravel(), np.linalg.norm(self.area, axis=1))
        np.add.at(area, number.ravel(), self.area)
        return np.asarray((np.linalg.norm(area, axis=1) < 1e-9 * size)[number.ravel()])

    def in_front(self, distance: float) -> "Panels":
        """Return the panels with their centres at a ``distance`` (m) from the wall, within the fluid."""
        size = np.linalg.norm(self.area, axis=1, keepdims=True)
        return self._replace(centre=self.centre - distance * self.area / size)


class End(NamedTuple):
    """Open end of a wall: its point, the direction of the wall's prolongation, and the normal out of the fluid."""

    wall: int
    point: Array
    onward: Array
    outward: Array


class WallGroup(ABC):
    """Walls that are carried by the same body, or are all at rest, and together bound the fluid."""

    @abstractmethod
    def ghosts(self, spacing: float, layers: int) -> GhostPoints:
        """Return ghosts in layers at (k + 1/2) ``spacing`` (m) behind the walls."""

    @abstractmethod
    def panels(self, spacing: float) -> Panels:
        """Cut the wetted surface of the walls into panels of about ``spacing`` (m)."""

    @abstractmethod
    def behind(self, points: Array) -> BoolArray:
        """Return whether each of ``points`` (n, dim), m, lies behind one of the walls, and not on it."""

    def ends(self) -> list[End]:
        """Return the ends of walls from which the boundary of the domain continues in the open; none in 3-D."""
        return []

    def thin_place(self, least: float) -> tuple[float, ...] | None:
        """Return a point, m, where a solid thinner than ``least`` (m) cannot hold fluid; None if there is none."""
        return None


@final
class NoWalls(WallGroup):
    """Space without walls, in ``dim`` dimensions."""

    def __init__(self, dim: int) -> None:
        self._points, self._none = np.empty((0, dim)), np.empty(0, np.int64)

    def ghosts(self, spacing: float, layers: int) -> GhostPoints:
        """Return no ghosts."""
        points, none = self._points, self._none
        reflection = np.empty((0, points.shape[1], points.shape[1]))
        return GhostPoints.without_corners(points, points, points, points, reflection, np.empty(0), none)

    def panels(self, spacing: float) -> Panels:
        """Return no panels."""
        return Panels(self._points, self._points, self._none)

    def behind(self, points: Array) -> BoolArray:
        """Return that none of ``points`` (n, dim) lies behind a wall."""
        return np.zeros(len(points), dtype=np.bool_)


@final
class PlaneWalls(WallGroup):
    """Walls of two dimensions: lines that bound a :class:`~sphframe.geometry.domain.Domain`.

    Parameters
    ----------
    walls
        by their indices; ``fluid`` at the start, m; ``spacing`` of the particles, m; ``periods`` of both.

    Raises
    ------
    InputError
        when the side of the fluid is ambiguous.
    """

    def __init__(
        self, walls: dict[int, Wall], fluid: shapely.Geometry, spacing: float, periods: Periods | None = None
    ) -> None:
        self._indices = np.array([*walls, NONE])  # the last stands for OPEN
        self._spacing = spacing
        single = [k for k, wall in enumerate(walls.values()) if wall.one_sided]
        lines = [k for k, wall in enumerate(walls.values()) if wall.is_line and not wall.one_sided]
        outlines = {wall.name: wall.outline(CHORD * spacing) for wall in walls.values()}
        self._periods = Periods.none(2) if periods is None else periods
        if self._periods:  # the walls and the fluid of all boxes around the one that is simulated
            _check_extents(walls.values(), self._periods, spacing)
            shifts = self._periods.shifts()
            outlines = {
                name: [piece + shift for piece in _at_home(lines, self._periods) for shift in shifts]
                for name, lines in outlines.items()
            }
            fluid = shapely.geometrycollections([affinity.translate(fluid, *shift) for shift in shifts])
        self.domain = fluid_domain(outlines, fluid, spacing, one_sided=single, two_sided=lines, periods=self._periods)
        self._cut: dict[int, tuple[BoolArray, list[Chart]]] = {}
        self._filled: dict[tuple[float, int], tuple[GhostPoints, IntArray, IntArray]] = {}

    def _charts(self, layers: int) -> tuple[BoolArray, list[Chart]]:
        """Return which edges are thin, and the charts; no charts where no wall is thinner than the layers."""
        if layers not in self._cut:
            domain, reach = self.domain, (layers - 0.3) * self._spacing
            thin = np.zeros(len(domain.wall), dtype=np.bool_)
            if np.any(domain.two_sided) or thin_solid(domain.region, reach) is not None:
                thin = thin_edges(domain, reach)
            if self._periods and np.any(thin):
                x, y = self.domain.start[thin][0]
                raise InputError(
                    f"the wall at ({x:.6g}, {y:.6g}) is thinner than the kernel's support, which is not possible in a"
                    " case with periodic directions: make it as thick as the support, or choose a smaller"
                    " particle_spacing"
                )
            self._cut[layers] = thin, charts_of(domain, thin, self._spacing, layers) if np.any(thin) else []
        return self._cut[layers]

    def ghosts(self, spacing: float, layers: int) -> GhostPoints:
        """Return ghosts in layers at (k + 1/2) ``spacing`` (m) behind the walls."""
        return self._made(spacing, layers)[0]

    def sides(self, spacing: float, layers: int) -> Sides:
        """Return the sides of the walls, and of the ghosts that :meth:`ghosts` returns."""
        _, ghost_chart, kind = self._made(spacing, layers)
        thin, charts = self._charts(layers)
        walls = [np.flatnonzero(self.domain.wall != OPEN)] if not charts else [chart.edges for chart in charts]
        edges, number = np.concatenate(walls), np.repeat(np.arange(len(walls)), [len(own) for own in walls])
        ends = np.hstack([self.domain.start, self.domain.end])[edges]
        tips = np.zeros((len(ends), 2), np.int64)
        for own, chart in enumerate(charts):
            tips[np.flatnonzero(number == own)[[0, -1]], [0, 1]] = chart.tips
        return Sides(ends, tips, number, self._indices[self.domain.wall[edges]], thin[edges], ghost_chart, kind)

    def _made(self, spacing: float, layers: int) -> tuple[GhostPoints, IntArray, IntArray]:
        """Return the ghosts, their charts (g,) and the kinds (g,) of their walls; made once, for ghosts and sides."""
        if (spacing, layers) not in self._filled:
            self._filled[spacing, layers] = self._make(spacing, layers)
        return self._filled[spacing, layers]

    def _make(self, spacing: float, layers: int) -> tuple[GhostPoints, IntArray, IntArray]:
        charts = self._charts(layers)[1]
        if not charts:
            ghosts, edge = self._ghosts_behind(self.domain, spacing, layers)
            own: Any = self._periods.at_home(ghosts.position, _BORDER * spacing)
            ghosts = GhostPoints(*(part[own] for part in ghosts))
            thick = np.zeros(len(ghosts.wall), np.int64)
            return ghosts._replace(mirror=self._inside(ghosts.mirror, spacing)), thick, thick
        parts, numbers, kinds = [], [], []
        for number, chart in enumerate(charts):
            ghosts, edge = self._ghosts_behind(chart.strip, spacing, layers)
            kind = chart.kind[edge]
            within = (kind != BEYOND) | (np.einsum("ij,ij->i", ghosts.normal, chart.strip.normal[edge]) > 1.0 - 1e-6)
            ghosts, kind = GhostPoints(*(part[within] for part in ghosts)), kind[within]
            in_fluid = shapely.contains_xy(self.domain.region, ghosts.position[:, 0], ghosts.position[:, 1])
            kind[in_fluid & (kind == THICK)] = THIN  # in a corner with a thin wall
            mirror, reflection = seen_mirrors(self.domain, ghosts.foot, ghosts.mirror, ghosts.reflection)
            parts.append(ghosts._replace(mirror=self._inside(mirror, spacing), reflection=reflection))
            numbers.append(np.full(len(kind), number))
            kinds.append(kind)
        together = GhostPoints(*map(np.concatenate, zip(*parts, strict=True)))
        return together, np.concatenate(numbers), np.concatenate(kinds)

    def _ghosts_behind(self, domain: Domain, spacing: float, layers: int) -> tuple[GhostPoints, IntArray]:
        """Return ghosts behind the walls of ``domain``, and the edge (g,) nearest to each."""
        position, volume, foot, edge = layer_points(domain, spacing, layers)
        offset = position - foot
        depth = np.hypot(*offset.T)[:, None]
        at_end = np.hypot(*(foot - domain.end[edge]).T) <= 1e-9 * (depth[:, 0] + spacing)
        at_start = np.hypot(*(foot - domain.start[edge]).T) <= 1e-9 * (depth[:, 0] + spacing)
        later = np.where(at_end, domain.after[edge], edge)  # the edge that starts in the corner, if there is one
        corner = (at_end | at_start) & domain.sharp[later]
        earlier = domain.before[later]
        normal = offset / np.maximum(depth, 1e-300)
        identity = np.eye(2)
        reflection = np.where(
            corner[:, None, None], -identity, identity - 2.0 * normal[:, :, None] * normal[:, None, :]
        )
        wall = np.where(corner, domain.wall[earlier], domain.wall[edge])
        other = np.where(corner & (domain.wall[later] != wall), domain.wall[later], OPEN)
        shared = (other != OPEN)[:, None]
        first, second = domain.normal[earlier], domain.normal[later]
        across = np.stack([-first[:, 1], first[:, 0]], axis=1)
        dual = across / np.where(shared, np.einsum("ij,ij->i", across, second)[:, None], 1.0)
        ghosts = GhostPoints(
            position,
            2.0 * foot - position,
            foot,
            normal,
            reflection,
            volume,
            self._indices[wall],
            self._indices[other],
            np.where(shared, second, 0.0),
            np.where(shared, dual, 0.0),
        )
        return ghosts, edge

    def _inside(self, mirror: Array, spacing: float) -> Array:
        """Move mirror points (g, 2) that lie behind a wall, or too near to one, half a spacing inside the fluid."""
        within = shapely.buffer(self.domain.region, -0.5 * spacing, join_style="mitre")
        if not within.is_empty:
            points = shapely.points(mirror)
            near = shapely.distance(within, points) > 0.01 * spacing
            line = shapely.shortest_line(within, points[near])
            mirror[near] = shapely.get_coordinates(shapely.get_point(line, 0))
        return mirror

    def panels(self, spacing: float) -> Panels:
        """Cut the wetted surface of the walls into panels of at most ``spacing`` (m), at least one per edge."""
        domain = self.domain
        walled = domain.wall != OPEN
        edge = (domain.end - domain.start)[walled]
        count = np.maximum(np.ceil(np.hypot(*edge.T) / spacing - 1e-9).astype(int), 1)
        place = np.repeat(np.arange(len(edge)), count)
        share = (np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count) + 0.5) / count[place]
        centre = domain.start[walled][place] + share[:, None] * edge[place]
        area = np.stack([edge[:, 1], -edge[:, 0]], axis=1)[place] / count[place, None]
        panels = Panels(centre, area, self._indices[domain.wall[walled][place]])
        own: Any = self._periods.at_home(centre, _BORDER * spacing)
        return Panels(*(part[own] for part in panels))

    def thin_place(self, least: float) -> tuple[float, ...] | None:
        """Return a point, m, where a solid thinner than ``least`` (m) cannot hold fluid; None if there is none.

        That is where it has no corner between its sides, so that they are not charts of their own.
        """
        charts = self._charts(int(np.ceil(least / self._spacing - 1e-9)))[1]
        return next((place for chart in charts if (place := back_to_back(self.domain, chart, least))), None)

    def on_line(self, point: tuple[float, ...]) -> bool:
        """Return whether a ``point``, m, is on a wall without thickness, so that its side is not known."""
        sides = np.stack([self.domain.start, self.domain.end], axis=1)[self.domain.two_sided]
        distance = shapely.distance(shapely.linestrings(sides), shapely.Point(point))
        return bool(np.any(distance < 0.005 * self._spacing))

    def ends(self) -> list[End]:
        """Return the ends of walls from which the boundary of the domain continues in the open."""
        domain = self.domain
        wall, along = domain.wall, domain.end - domain.start
        along /= np.hypot(*along.T)[:, None]
        found = []
        for k in np.flatnonzero(wall != OPEN):
            index = int(self._indices[wall[k]])
            if wall[domain.before[k]] == OPEN:
                found.append(End(index, domain.start[k], -along[k], domain.normal[k]))
            if wall[domain.after[k]] == OPEN:
                found.append(End(index, domain.end[k], along[k], domain.normal[k]))
        own = self._periods.at_home(np.array([end.point for end in found]).reshape(-1, 2), 0.0)
        return [end for end, at_home in zip(found, own, strict=True) if at_home]

    def behind(self, points: Array) -> BoolArray:
        """Return whether each of ``points`` (n, 2), m, lies behind one of the walls, and not on it."""
        return self.domain.behind(self._periods.wrapped(points))


def _check_extents(walls: Iterable[Wall], periods: Periods, spacing: float) -> None:
    """Refuse walls that are longer than a period."""
    for wall in walls:
        extent = np.subtract(*wall.bounds()[::-1])
        for axis in np.flatnonzero(periods.repeats & (extent > periods.length + 1e-9 * spacing)):
            raise InputError(
                f"wall {wall.name!r} extends over {extent[axis]:g} m along {'xy'[axis]}, more than the period of"
                f" {periods.length[axis]:g} m: draw what repeats itself once"
            )


def _at_home(lines: list[Array], periods: Periods) -> list[Array]:
    """Return the pieces of ``lines`` (k, 2), m, in the box that repeats itself, cut at its border."""
    upper = periods.lower + periods.length
    far = 1.0 + max(float(np.abs(line).max()) for line in lines) + float(np.abs([periods.lower, upper]).max())
    box = shapely.box(*np.where(periods.repeats, periods.lower, -far), *np.where(periods.repeats, upper, far))
    pieces = []
    for line, shift in itertools.product(lines, periods.shifts()):
        for part in shapely.get_parts(shapely.intersection(shapely.LineString(line + shift), box)):
            points = shapely.get_coordinates(part)
            for border in (periods.lower, upper):
                points = np.where((np.abs(points - border) < 1e-12 * far) & periods.repeats, border, points)
            if len(points) > 1:
                pieces.append(points)
    return pieces
