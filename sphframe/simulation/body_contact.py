"""Simulation: contact of bodies that move under their load with walls, and with each other.

A point of one surface that lies behind another, by delta along the normal n out of the fluid, is pushed back::

    F = -n max(m omega^2 delta + 2 zeta m omega (u - u_wall).n, 0) delta / sum delta

with the sum over all points of one surface behind the other, so that the stiffness of a contact does not depend on the
number of its points. m is the mass of the body, or the reduced mass of two; omega = 0.2 c0 / h follows in time steps of
the fluid; a body at rest on a bed sinks in by g / omega^2, a few hundredths of a particle spacing. With zeta = 0.7
bodies hardly rebound. There is no friction. The points are the centres of the panels and the corners of the walls.

Only bodies whose walls enclose a solid touch others, and walls without thickness are refused beside them. Surfaces that
are drawn into each other, such as a flap in a bed, do not touch.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from sphframe.arrays import Array
from sphframe.boundary.boundary import Boundary
from sphframe.errors import InputError
from sphframe.geometry import Panels, Wall, directions_to_world, moments, to_body_frame, to_world, turning_velocities
from sphframe.interfaces import Motion

FREQUENCY, DAMPING = 0.2, 0.7
_DRAWN_INTO = 0.05


class Penetration(NamedTuple):
    """The deepest ``depth`` (m) of a body (its index) in a wall (its name)."""

    depth: float
    body: int
    wall: str


class _Surface(NamedTuple):
    """A wall as drawn: ``points`` to test; ``centre``, ``normal`` and ``size`` of its panels, and their search tree."""

    body: int
    points: Array
    centre: Array
    normal: Array
    size: Array
    tree: Any


class BodyContacts:
    """Contact forces of the bodies of ``boundary``, whose ``walls`` are cut into ``panels``.

    Attributes
    ----------
    deepest
        the deepest penetration at the last evaluation; None without contact.
    """

    def __init__(
        self, boundary: Boundary, walls: Sequence[Wall], panels: Panels, *, spacing: float, frequency: float
    ) -> None:
        self._boundary, self._spacing, self._frequency = boundary, spacing, frequency
        self._masses = [float(getattr(body, "mass", 0.0) or np.inf) for body in boundary.bodies.values()]
        self._names = [wall.name for wall in walls]
        self._pairs: list[tuple[int, int]] = []
        self.deepest: Penetration | None = None
        moving = [k for k, body in enumerate(boundary.bodies.values()) if body.needs_load and self._encloses(k, panels)]
        if not moving:
            return
        lines = panels.wall[panels.two_sided]
        if len(lines):
            names = list(boundary.bodies)
            raise InputError(
                f"wall {walls[lines[0]].name!r} is a line without thickness, and body {names[moving[0]]!r}, which moves"
                " under its load, might touch it: bodies touch solids only; draw the wall as a closed outline"
            )
        self._surfaces = [_surface(boundary, wall, panels, index) for index, wall in enumerate(walls)]
        rest = [Motion(*np.zeros((3, 3 * boundary.dim - 3))) for _ in boundary.bodies]
        for wall, owner in enumerate(boundary.wall_body.tolist()):
            for k in moving:
                once = owner not in moving or owner > k  # each pair of bodies
                if once and owner != k and np.all(self._touching(k, wall, rest)[2] < _DRAWN_INTO * spacing):
                    self._pairs.append((k, wall))

    def _encloses(self, body: int, panels: Panels) -> bool:
        """Whether the walls of a body enclose a solid: their area vectors add up to zero."""
        own = (self._boundary.wall_body[panels.wall] == body) & ~panels.two_sided
        area = panels.area[own]
        return len(area) > 0 and float(np.linalg.norm(area.sum(axis=0))) < 1e-6 * float(np.abs(area).sum())

    def add_loads(self, motions: Sequence[Motion], loads: Array) -> None:
        """Add the contact forces and their moments to ``loads`` (bodies, 3 or 6)."""
        self.deepest = None
        for k, wall in self._pairs:
            other = self._surfaces[wall].body
            mass = 1.0 / (1.0 / self._masses[k] + (1.0 / self._masses[other] if other >= 0 else 0.0))
            points, normal, depth = self._touching(k, wall, motions)
            if not len(depth):
                continue
            deepest = float(depth.max())
            if self.deepest is None or deepest > self.deepest.depth:
                self.deepest = Penetration(deepest, k, self._names[wall])
            speed = self._velocity(k, points, motions) - self._velocity(other, points, motions)
            approach = np.einsum("ij,ij->i", speed, normal)
            push = mass * self._frequency * (self._frequency * depth + 2.0 * DAMPING * approach)
            force = -normal * (np.maximum(push, 0.0) * depth / depth.sum())[:, None]
            self._add(loads, k, points, force, motions)
            if other >= 0:
                self._add(loads, other, points, -force, motions)

    def _touching(self, k: int, wall: int, motions: Sequence[Motion]) -> tuple[Array, Array, Array]:
        """Return the points of body ``k`` behind the ``wall``, and those of the wall behind the walls of the body.

        Returns
        -------
        tuple[Array, Array, Array]
            Points (c, dim), the directions (c, dim) in which the body has come too far, and the depths (c,).
        """
        found = []
        for own in (surface for surface in self._surfaces if surface.body == k):
            for tested, other, sense in ((own, self._surfaces[wall], 1.0), (self._surfaces[wall], own, -1.0)):
                present = self._to_world(tested.points, tested.body, motions)
                points, normal, depth = self._behind(other, present, motions)
                found.append((points, sense * normal, depth))
        points, normals, depths = (np.concatenate(parts) for parts in zip(*found, strict=True))
        return points, normals, depths

    def _behind(self, other: _Surface, points: Array, motions: Sequence[Motion]) -> tuple[Array, Array, Array]:
        """Return those of the present ``points`` that lie behind a surface, with its normals and the depths."""
        drawn, body = points, other.body
        if body >= 0:
            drawn = to_body_frame(points, motions[body].position, self._boundary.centres[body])
        distance, nearest = other.tree.query(drawn, distance_upper_bound=2.0 * self._spacing)
        near = np.isfinite(distance)
        points, drawn, nearest = points[near], drawn[near], nearest[near]
        normal, offset = other.normal[nearest], drawn - other.centre[nearest]
        depth = np.einsum("ij,ij->i", offset, normal)
        beside = np.linalg.norm(offset - depth[:, None] * normal, axis=1)
        behind = (depth > 0.0) & (beside <= 0.75 * other.size[nearest])
        normal = normal[behind]
        if body >= 0:
            normal = directions_to_world(normal, motions[body].position)
        return points[behind], normal, depth[behind]

    def _to_world(self, points: Array, body: int, motions: Sequence[Motion]) -> Array:
        return points if body < 0 else to_world(points, motions[body].position, self._boundary.centres[body])

    def _arms(self, body: int, points: Array, motions: Sequence[Motion]) -> Array:
        return np.asarray(points - self._boundary.centres[body] - motions[body].position[: points.shape[1]])

    def _velocity(self, body: int, points: Array, motions: Sequence[Motion]) -> Array:
        """Return the velocity (n, dim) of a body at ``points``."""
        if body < 0:
            return np.zeros_like(points)
        dim, velocity = points.shape[1], motions[body].velocity
        turning = turning_velocities(velocity[dim:], self._arms(body, points, motions))
        return np.asarray(velocity[:dim] + turning)

    def _add(self, loads: Array, body: int, points: Array, force: Array, motions: Sequence[Motion]) -> None:
        dim = points.shape[1]
        loads[body, :dim] += force.sum(axis=0)
        loads[body, dim:] += moments(self._arms(body, points, motions), force).sum(axis=0)


def _surface(boundary: Boundary, wall: Wall, panels: Panels, index: int) -> _Surface:
    from scipy.spatial import cKDTree

    own = panels.wall == index
    area, centre = panels.area[own], panels.centre[own]
    length = np.linalg.norm(area, axis=1)
    size = length ** (1.0 / (boundary.dim - 1))
    points = np.vstack([centre, *wall.outline()])
    return _Surface(int(boundary.wall_body[index]), points, centre, area / length[:, None], size, cKDTree(centre))
