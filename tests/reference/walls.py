"""Walls as drawn, carried by their bodies, and the fluid around them at one moment."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from .kernels import Array, Gaussian
from .weights import Around

Motion = tuple[Array, Array, Array]
"""displacement and turn, velocity, acceleration of a body: (3,) in 2-D, (6,) in 3-D"""


def turn(motion: Array) -> Array:
    """The rotation matrix of a body."""
    dim = 2 if len(motion) == 3 else 3
    return Rotation.from_rotvec([0.0, 0.0, motion[2]] if dim == 2 else motion[3:]).as_matrix()[:dim, :dim]


def cross(omega: Array, arm: Array) -> Array:
    """Omega x arm, in the plane if omega has one component."""
    return np.cross(omega, arm) if len(omega) == 3 else omega * np.stack([-arm[:, 1], arm[:, 0]], axis=1)


class Walls:
    """Ghosts as ``drawn``, and the ``bodies`` with their ``centres`` that carry them; ``at_rest``: sliding velocity.

    Attributes: ``ghost``, ``mirror``, ``foot``, ``normal``, ``reflection`` at present, ``u`` and ``b`` = rho0 (f -
    a_wall) of the foot; ``dual``, ``other_normal`` of second walls in corners. ``box``: places of its faces by axis.
    """

    def __init__(
        self,
        drawn: Any,
        wall_body: Sequence[int],
        centres: Array,
        bodies: Sequence[Callable[[float], Motion]],
        at_rest: Array,
        period: Array,
        box: Sequence[Sequence[float]] | None = None,
    ) -> None:
        self.drawn, self.wall_body, self.centres, self.bodies = drawn, wall_body, centres, bodies
        self.box, self.at_rest, self.period, self.dim = box, at_rest, period, drawn.position.shape[1]
        self.body = np.array(wall_body)[drawn.wall]

    def nearest(self, offset: Array) -> Array:
        """Offsets to the nearest copies along directions that repeat themselves."""
        return offset - np.rint(offset / np.where(self.period > 0.0, self.period, np.inf)) * self.period

    def wrapped(self, points: Array) -> Array:
        """The points of the box at the origin that stand for points."""
        return points - np.floor(points / np.where(self.period > 0.0, self.period, np.inf)) * self.period

    def motion_at(self, foot: Array, body: int) -> tuple[Array, Array]:
        """Velocity and acceleration of a body at points."""
        place, velocity, rate = self.motions[body]
        arm, omega = foot - self.centres[body] - place[: self.dim], velocity[self.dim :]
        turning = cross(omega, arm)
        acceleration = rate[: self.dim] + cross(rate[self.dim :], arm) + cross(omega, turning)
        return velocity[: self.dim] + turning, acceleration

    def move(self, time: float, rho0: float, force: Array, gradient: Array) -> None:
        """Carry the ghosts; set b at their feet, where no pressure grows along a period."""
        d = self.drawn
        self.rho0, self.force, self.gradient = rho0, force, gradient
        self.ghost, self.mirror, self.foot, self.normal = (a.copy() for a in (d.position, d.mirror, d.foot, d.normal))
        self.reflection, self.dual, self.other_normal = (a.copy() for a in (d.reflection, d.other_dual, d.other_normal))
        self.u, acceleration = self.at_rest.copy(), np.zeros_like(d.position)
        self.motions = [tuple(map(np.asarray, body(time))) for body in self.bodies]
        for k, (place, _, _) in enumerate(self.motions):
            own, matrix = self.body == k, turn(place)
            for array in (self.ghost, self.mirror, self.foot):
                array[own] = (array[own] - self.centres[k]) @ matrix.T + self.centres[k] + place[: self.dim]
            for array in (self.normal, self.dual, self.other_normal):
                array[own] = array[own] @ matrix.T
            self.reflection[own] = matrix @ self.reflection[own] @ matrix.T
            self.u[own], acceleration[own] = self.motion_at(self.foot[own], k)
        self.b = self.balanced(self.foot, acceleration)
        self.depth = np.einsum("gk,gk->g", self.ghost - self.foot, self.normal)

    def balanced(self, foot: Array, acceleration: Array) -> Array:
        """rho0 (f - a_wall)."""
        return self.rho0 * (self.force + foot @ self.gradient.T - acceleration) * (self.period == 0.0)

    def in_frame(self, x: Array) -> Array:
        """Points in the frame in which the first body was drawn."""
        place = self.motions[0][0]
        return (x - self.centres[0] - place[: self.dim]) @ turn(place) + self.centres[0]

    def out_of_frame(self, x: Array, foot: Array, axes: Array) -> tuple[Array, Array, Array, Array]:
        """Points of that frame at present, velocity and b of the wall at their feet, and the reflection along axes."""
        place = self.motions[0][0]
        matrix = turn(place)
        x, foot = ((of - self.centres[0]) @ matrix.T + self.centres[0] + place[: self.dim] for of in (x, foot))
        velocity, acceleration = self.motion_at(foot, 0)
        reflection = matrix @ np.diag(np.where(axes, -1.0, 1.0)) @ matrix.T
        return x, velocity, self.balanced(foot, acceleration), np.tile(reflection, (len(x), 1, 1))

    def around(self, kernel: Gaussian, points: Array, x: Array, volumes: Array) -> Around:
        """The fluid around points of the ghosts."""
        offset = self.nearest(x[None] - points[:, None])
        return Around(kernel, offset, volumes, self.normal, self.ghost - points)

    def loads(self, x: Array, forces: Array) -> Array:
        """Force and moment of the reactions (n, g, dim), the second wall of a corner takes its part; or of images."""
        found = np.zeros((len(self.wall_body), 3 if self.dim == 2 else 6))
        if forces.shape[1] != len(self.drawn.wall):  # images in the only wall there is
            forces = forces.sum(axis=1, keepdims=True) * (np.arange(len(self.drawn.wall)) == 0)[:, None]
        along = np.einsum("igk,gk->ig", forces, self.dual) * (self.drawn.other >= 0)
        second = along[:, :, None] * self.other_normal
        for wall, body in enumerate(self.wall_body):
            centre = self.centres[body] + self.motions[body][0][: self.dim] if body >= 0 else np.zeros(self.dim)
            own = ((self.drawn.wall == wall)[None, :, None] * (forces - second)).sum(axis=1)
            own += ((self.drawn.other == wall)[None, :, None] * second).sum(axis=1)
            arm = x - centre
            moment = arm[:, :1] * own[:, 1:2] - arm[:, 1:2] * own[:, :1] if self.dim == 2 else np.cross(arm, own)
            found[wall] = np.hstack([own, moment]).sum(axis=0)
        return found
