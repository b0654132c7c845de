"""Body forces of moving frames of reference."""

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from sphframe import Array, BodyForce


@final
@dataclass(frozen=True)
class RotatingFrame(BodyForce):
    """The centrifugal force of a frame that turns about the last axis, through the origin: f = W^2 (x, 0) or (x, y, 0).

    It is the only one on fluid that turns with the frame; the Coriolis force on any other motion is left out.
    ``angular_speed``: W, rad/s.
    """

    angular_speed: float

    def placed(self, dimension: int, gravity: Array) -> "RotatingFrame":
        """Return the force with the dimension of the case."""
        object.__setattr__(self, "_dimension", dimension)
        return self

    def acceleration(self, time: float) -> Array:
        """Return zero, the force on the axis."""
        return np.zeros(vars(self)["_dimension"])

    def gradient(self, time: float) -> Array:
        """Return W^2 for the directions across the axis."""
        across = np.ones(vars(self)["_dimension"])
        across[-1] = 0.0
        return self.angular_speed**2 * np.diag(across)


@final
@dataclass(frozen=True)
class Surge(BodyForce):
    """The force in a tank that is displaced by X = A (1 - cos W t) along x: f = -X''.

    ``amplitude``: A, m; ``angular_frequency``: W, rad/s.
    """

    amplitude: float
    angular_frequency: float

    def placed(self, dimension: int, gravity: Array) -> "Surge":
        """Return the force with the dimension of the case."""
        object.__setattr__(self, "_dimension", dimension)
        return self

    def acceleration(self, time: float) -> Array:
        """Return -A W^2 cos W t along x."""
        force = np.zeros(vars(self)["_dimension"])
        force[0] = -self.amplitude * self.angular_frequency**2 * math.cos(self.angular_frequency * time)
        return force
