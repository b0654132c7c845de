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

from abc import ABC, abstractmethod
from typing import NamedTuple, final

import numpy as np
import shapely

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.geometry.domain import OPEN, fluid_domain
from sphframe.geometry.layers import LONGEST_MITRE, layer_points
from sphframe.geometry.shapes import CHORD
from sphframe.geometry.walls import Wall

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


class Panels(NamedTuple):
    """Panel ``centre`` (k, dim), m; ``area`` (k, dim), the area vector out of the fluid, m^(dim-1); ``wall`` (k,)."""

    centre: Array
    area: Array
    wall: IntArray


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

    @abstractmethod
    def ends(self) -> list[End]:
        """Return the ends of walls from which the boundary of the domain continues in the open."""

    @abstractmethod
    def thin_place(self, least: float) -> tuple[float, ...] | None:
        """Return a point, m, where the solid within walls is thinner than ``least`` (m); None if there is none."""


@final
class PlaneWalls(WallGroup):
    """Walls of two dimensions: lines that bound a :class:`~sphframe.geometry.domain.Domain`.

    Parameters
    ----------
    walls: by their indices; ``fluid`` at the start, m; ``spacing`` of the particles, m.

    Raises
    ------
    InputError: when the side of the fluid is ambiguous.
    """

    def __init__(self, walls: dict[int, Wall], fluid: shapely.Geometry, spacing: float) -> None:
        self._indices = np.array([*walls, NONE])  # the last stands for OPEN
        single = [k for k, wall in enumerate(walls.values()) if wall.one_sided]
        outlines = {wall.name: wall.outline(CHORD * spacing) for wall in walls.values()}
        self.domain = fluid_domain(outlines, fluid, spacing, one_sided=single)

    def ghosts(self, spacing: float, layers: int) -> GhostPoints:
        """Return ghosts in layers at (k + 1/2) ``spacing`` (m) behind the walls."""
        domain = self.domain
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
        return GhostPoints(
            position,
            self._inside(2.0 * foot - position, spacing),
            foot,
            normal,
            reflection,
            volume,
            self._indices[wall],
            self._indices[other],
            np.where(shared, second, 0.0),
            np.where(shared, dual, 0.0),
        )

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
        return Panels(centre, area, self._indices[domain.wall[walled][place]])

    def thin_place(self, least: float) -> tuple[float, ...] | None:
        """Return a point, m, where the solid within walls is thinner than ``least`` (m); None if there is none.

        A solid is thick enough where a square of this width fits; a sharp edge belongs to what is behind it.
        """
        solid = shapely.difference(
            shapely.buffer(self.domain.region, 2.0 * least, join_style="mitre"), self.domain.region
        )
        core = shapely.buffer(solid, -0.499 * least, join_style="mitre", mitre_limit=LONGEST_MITRE)
        thick = shapely.buffer(core, 0.5 * least, join_style="mitre", mitre_limit=LONGEST_MITRE)
        thin = shapely.get_parts(shapely.difference(solid, thick))
        thin = thin[shapely.area(thin) > 0.01 * least**2]
        if not len(thin):
            return None
        place = shapely.point_on_surface(thin[0])
        return place.x, place.y

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
        return found

    def behind(self, points: Array) -> BoolArray:
        """Return whether each of ``points`` (n, 2), m, lies behind one of the walls, and not on it."""
        return self.domain.behind(points)
