"""Geometry: walls of three dimensions that one body carries: any number of containers and obstacles.

Ghosts fill the solid behind the walls as particles fill a region of fluid (:func:`~sphframe.geometry.fill.fill_mesh`):
on a lattice that fits the walls' faces, and where walls cut its cells, in the centres of Voronoi cells of the solid. A
ghost whose nearest point c of the walls lies on a face is reflected by S = 1 - 2 n n^T; on a sharp edge of direction t
by S = 2 t t^T - 1, which for two faces at right angles is the product of their reflections; in a corner by S = -1.
"""

from collections.abc import Mapping, Sequence
from typing import Any, final

import numpy as np

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.geometry.columns import straight_faces
from sphframe.geometry.domain import OPEN
from sphframe.geometry.fill import fill_mesh
from sphframe.geometry.ghosts import GhostPoints, Panels, WallGroup
from sphframe.geometry.lattice import Lattice
from sphframe.geometry.solid_domain import solid_domain
from sphframe.geometry.solid_edges import SolidEdges
from sphframe.geometry.walls import Wall


@final
class SolidWalls(WallGroup):
    """Walls of three dimensions: surfaces that bound a :class:`~sphframe.geometry.solid_domain.SolidDomain`.

    Parameters
    ----------
    walls
        by their indices; ``fluid`` at the start; ``spacing`` of the particles, m.

    Raises
    ------
    InputError
        when a wall runs through the fluid, or is wet on both sides.
    """

    def __init__(self, walls: Mapping[int, Wall], fluid: Sequence[Any], spacing: float) -> None:
        self.domain = solid_domain(walls, fluid, spacing)
        self._edges, self._spacing = SolidEdges(self.domain, 1e-6 * spacing), spacing
        self._filled: dict[tuple[float, int], tuple[Array, Array]] = {}

    def ghosts(self, spacing: float, layers: int) -> GhostPoints:
        """Return ghosts that fill the solid behind the walls to a depth of ``layers`` times ``spacing`` (m)."""
        position, volume = self._fill(spacing, layers)
        feet = self.domain.chosen_feet(position, 1e-4 * spacing)
        place = self._edges.at(feet, position)
        return GhostPoints(
            position,
            self._inside(2.0 * feet.point - position, feet.depth, spacing),
            feet.point,
            place.normal,
            place.reflection,
            volume,
            place.wall,
            place.other,
            place.other_normal,
            place.other_dual,
        )

    def _fill(self, spacing: float, layers: int) -> tuple[Array, Array]:
        if (spacing, layers) not in self._filled:
            from scipy.spatial import cKDTree
            from trimesh import boolean, creation

            domain, depth = self.domain, layers * spacing
            panels = self.panels(spacing)
            lower, upper = panels.centre.min(axis=0) - depth, panels.centre.max(axis=0) + depth
            walls = domain.surface.submesh([np.flatnonzero(domain.wall != OPEN)], append=True)
            lattice = Lattice.over(lower, upper, spacing, straight_faces(walls))
            reach = depth + 1.5 * spacing
            near = np.isfinite(cKDTree(panels.centre).query(lattice.centre, distance_upper_bound=reach)[0])
            low, high = np.reshape(lattice.corners(np.array([0, -1])), (2, 3, 2))
            whole = float(boolean.intersection([domain.solid, creation.box(bounds=[low[:, 0], high[:, 1]])]).volume)
            position, volume = fill_mesh(domain.solid, lattice, whole, near=near, least=0.25, rings=1, sweeps=4)
            feet = domain.feet(position)
            kept = (domain.wall[feet.triangle] != OPEN) & (feet.depth < depth)
            self._filled[spacing, layers] = position[kept], volume[kept]
        return self._filled[spacing, layers]

    def _inside(self, mirror: Array, depth: Array, spacing: float) -> Array:
        """Move mirror points (g, 3) that are nearer to a wall than their ghosts, of given ``depth`` (g,), are.

        They move along the normal of that wall, to the depth of the ghost but at most half a spacing inside the fluid.
        """
        least = np.minimum(depth, 0.5 * spacing)
        moving = np.arange(len(mirror))
        for _ in range(10):
            feet = self.domain.feet(mirror[moving])
            wrong = feet.depth > -0.98 * least[moving]
            moving, point = moving[wrong], feet.point[wrong]
            if not len(moving):
                break
            normal = self.domain.surface.face_normals[feet.triangle[wrong]]
            mirror[moving] = point - least[moving, None] * normal
        return mirror

    def panels(self, spacing: float) -> Panels:
        """Cut the wetted surface of the walls into panels of about ``spacing`` (m)."""
        from trimesh.remesh import subdivide_to_size

        domain = self.domain
        walled = np.flatnonzero(domain.wall != OPEN)
        surface = domain.surface
        vertices, faces, index = subdivide_to_size(  # type: ignore[no-untyped-call]
            surface.vertices, surface.faces[walled], max_edge=1.5 * spacing, max_iter=40, return_index=True
        )
        corner = vertices[faces]
        area = 0.5 * np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        return _joined(corner.mean(axis=1), area, domain.wall[walled][index], spacing)

    def behind(self, points: Array) -> BoolArray:
        """Return whether each of ``points`` (n, 3), m, lies behind one of the walls, and not on it."""
        return self.domain.behind(points)

    def feet_behind(self, points: Array) -> tuple[BoolArray, Array]:
        """Return which of ``points`` (n, 3), m, lie behind a wall, and their nearest points on the walls."""
        return self.domain.feet_behind(points)

    def thin_place(self, least: float) -> tuple[float, ...] | None:
        """Return a point, m, where the solid within walls is thinner than ``least`` (m); None if there is none.

        There the depth behind the walls has a maximum below half of ``least``; towards a sharp edge it has none.
        """
        from scipy.spatial import cKDTree

        position, _ = self._fill(self._spacing, int(np.ceil(least / self._spacing)))
        depth = self.domain.feet(position).depth
        pairs = cKDTree(position).query_pairs(1.6 * self._spacing, output_type="ndarray")
        lower = np.where(depth[pairs[:, 0]] < depth[pairs[:, 1]], pairs[:, 0], pairs[:, 1])
        highest = depth < 0.499 * least
        highest[lower[np.abs(np.subtract(*depth[pairs].T)) > 1e-6 * least]] = False
        candidates = position[highest]
        for start in range(0, len(candidates), 50):
            place, found = self._deepest(candidates[start : start + 50])
            if np.any(found < 0.499 * least):
                return tuple(place[np.argmin(found)].tolist())
        return None

    def _deepest(self, points: Array) -> tuple[Array, Array]:
        """Move ``points`` (n, 3) to where the depth behind the walls is highest around them; return the depths too.

        The depth is the least distance from several faces. It grows along the shortest vector v in the convex hull of
        the gradients of these distances, found around the point by the method of Frank and Wolfe; v = 0 at a maximum.
        """
        around = np.concatenate([step * np.eye(3) for step in (-0.1, 0.1)]) * self._spacing
        depth, step = self.domain.feet(points).depth, np.full(len(points), 0.5 * self._spacing)
        for _ in range(100):
            places = (points[:, None] + around).reshape(-1, 3)
            feet = self.domain.feet(places)
            gradients = ((places - feet.point) / feet.depth[:, None]).reshape(len(points), -1, 3)
            shortest = gradients.mean(axis=1)
            for n in range(30):
                towards = np.argmin(np.einsum("nkd,nd->nk", gradients, shortest), axis=1)
                shortest += 2.0 / (n + 3.0) * (gradients[np.arange(len(points)), towards] - shortest)
            length = np.linalg.norm(shortest, axis=1)
            moved = points + (step / np.maximum(length, 1e-9))[:, None] * shortest
            new = self.domain.feet(moved).depth
            better = (new > depth + 0.02 * step) & (length > 0.05)
            points, depth = np.where(better[:, None], moved, points), np.where(better, new, depth)
            step = np.where(better, step, 0.5 * step)
            if np.all(step < 0.01 * self._spacing):
                break
        return points, depth


def _joined(centre: Array, area: Array, wall: IntArray, spacing: float) -> Panels:
    """Join triangles of the same wall that look in the same direction within the same cube of one ``spacing``."""
    axis = np.argmax(np.abs(area), axis=1)
    side = np.take_along_axis(area, axis[:, None], axis=1)[:, 0] > 0.0
    key = np.column_stack([np.floor(centre / spacing + 1e-6).astype(np.int64), axis, side, wall])
    _, panel = np.unique(key, axis=0, return_inverse=True)
    panel = panel.ravel()
    size = np.linalg.norm(area, axis=1)
    whole = np.bincount(panel, size)
    middle: Array = np.stack([np.bincount(panel, size * x) / whole for x in centre.T], axis=1)
    vector: Array = np.stack([np.bincount(panel, x) for x in area.T], axis=1).astype(np.float64)
    owner = np.zeros(len(whole), np.int64)
    owner[panel] = wall
    return Panels(middle, vector, owner)
