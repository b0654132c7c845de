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

    Attributes
    ----------
    angular_speed
        W, rad/s.
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

    Attributes
    ----------
    amplitude
        A, m.
    angular_frequency
        W, rad/s.
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


@final
@dataclass(frozen=True)
class Roll(BodyForce):
    """The force in a tank that rolls about the origin by the angle T = B sin W t, seen from the tank, in 2-D.

    With the gravity g of the case, turned by -T, and rotation speed and acceleration w = T', T''::

        f = R(-T) g - g + w^2 (x, y) + T'' (y, -x)

    Without the Coriolis force, which is smaller than these by the roll angle.

    Attributes
    ----------
    amplitude
        B, rad.
    angular_frequency
        W, rad/s.
    """

    amplitude: float
    angular_frequency: float

    def placed(self, dimension: int, gravity: Array) -> "Roll":
        """Return the force with the gravity of the case."""
        if dimension != 2:
            raise ValueError(f"a roll is in 2 dimensions, but the case has {dimension}")
        object.__setattr__(self, "_gravity", gravity)
        return self

    def acceleration(self, time: float) -> Array:
        """Return the change of gravity."""
        angle = self.amplitude * math.sin(self.angular_frequency * time)
        (x, y), cosine, sine = vars(self)["_gravity"], math.cos(angle), math.sin(angle)
        return np.array([cosine * x + sine * y - x, cosine * y - sine * x - y])

    def gradient(self, time: float) -> Array:
        """Return the gradient of the forces that grow with the distance from the origin."""
        phase = self.angular_frequency * time
        square = (self.amplitude * self.angular_frequency * math.cos(phase)) ** 2
        turning = -self.amplitude * self.angular_frequency**2 * math.sin(phase)
        return np.array([[square, turning], [-turning, square]])
