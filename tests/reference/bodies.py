"""A rigid body that moves freely, in the plane and in space."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from .kernels import Array
from .walls import turn


def turned(position: Array, angle: Array) -> Array:
    """A rotation vector after a further turn by ``angle``, in the plane a sum."""
    if len(angle) == 1:
        return position + angle
    return (Rotation.from_rotvec(angle) * Rotation.from_rotvec(position)).as_rotvec()


@dataclass
class FreeBody:
    """M A = F + m g and I alpha + omega x I omega = M about the centre of mass.

    ``inertia`` (1, 1) or (3, 3): as drawn. ``position``, ``velocity``, ``acceleration`` (3,) or (6,): displacement of
    the centre of mass and rotation, and their rates; the acceleration is that of the last evaluation. ``load``: force
    and moment then.
    """

    mass: float
    inertia: Array
    gravity: Array
    position: Array
    velocity: Array
    acceleration: Array

    def __post_init__(self) -> None:
        self.dim, self.load = len(self.gravity), np.zeros_like(self.velocity)

    @classmethod
    def none(cls, dim: int) -> "FreeBody":
        """The body of a scene without a free one: it remains at rest."""
        size = 2 * dim - 3
        return cls(np.inf, np.eye(size), np.zeros(dim), *np.zeros((3, dim + size)))

    def __call__(self, time: float) -> tuple[Array, Array, Array]:
        """The motion."""
        return self.position, self.velocity, self.acceleration

    def respond(self, load: Array) -> None:
        """Take the acceleration from force and moment of the fluid."""
        self.load = load
        self.acceleration = self.accelerated(self.velocity)

    def accelerated(self, velocity: Array) -> Array:
        """The acceleration at a velocity under the last load."""
        moment, inertia = self.load[self.dim :], self.inertia
        if self.dim == 3:
            matrix, omega = turn(self.position), velocity[3:]
            inertia = matrix @ inertia @ matrix.T
            moment = moment - np.cross(omega, inertia @ omega)
        return np.append(self.load[: self.dim] / self.mass + self.gravity, np.linalg.solve(inertia, moment))

    def kick(self, dt: float) -> None:
        """Advance the velocity by Heun's method, as the acceleration depends on it."""
        first = self.accelerated(self.velocity)
        self.velocity = self.velocity + 0.5 * dt * (first + self.accelerated(self.velocity + dt * first))

    def moved(self, by: Array) -> Array:
        """The position after displacement and turn ``by``."""
        return np.append(self.position[: self.dim] + by[: self.dim], turned(self.position[self.dim :], by[self.dim :]))

    def rate_since(self, start: "FreeBody") -> Array:
        """The rate of displacement and turn since the position at ``start``: that of the turn is dexp^-1(omega)."""
        rate = self.velocity.copy()
        if self.dim == 3:
            angle, omega = Rotation.from_matrix(turn(self.position) @ turn(start.position).T).as_rotvec(), rate[3:]
            rate[3:] = omega - np.cross(angle, omega) / 2.0 + np.cross(angle, np.cross(angle, omega)) / 12.0
        return rate
