"""A rigid body that moves freely in the plane."""

from dataclasses import dataclass

import numpy as np

from .kernels import Array


@dataclass
class FreeBody:
    """M A = F + m g and I alpha = M about the centre of mass; one of infinite mass remains as it is.

    ``position``, ``velocity``, ``acceleration`` (3,): displacement of the centre of mass and angle, and their rates.
    """

    mass: float
    inertia: float
    gravity: Array
    position: Array
    velocity: Array
    acceleration: Array

    @classmethod
    def none(cls, dim: int) -> "FreeBody":
        """The body of a scene without a free one."""
        return cls(np.inf, np.inf, np.zeros(dim), *np.zeros((3, 3)))

    def __call__(self, time: float) -> tuple[Array, Array, Array]:
        """The motion; the acceleration is that of the last evaluation."""
        return self.position, self.velocity, self.acceleration

    def respond(self, load: Array) -> None:
        """Take the acceleration from force and moment (3,) of the fluid."""
        self.acceleration = load / [self.mass, self.mass, self.inertia]
        self.acceleration[:2] += self.gravity
