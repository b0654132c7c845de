"""A body that oscillates."""

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from sphframe import Array, Motion, RigidBody


@final
@dataclass(frozen=True)
class Oscillating(RigidBody):
    """A body that oscillates along x, X = r(t) a sin(omega t), with the ramp r = s^3 (10 - 15 s + 6 s^2) of one period.

    In the ramp s is the time over the period, at most 1.

    Attributes
    ----------
    amplitude
        a, m.
    angular_frequency
        omega, rad/s.
    """

    amplitude: float
    angular_frequency: float

    def __post_init__(self) -> None:
        if not self.angular_frequency > 0.0:
            raise ValueError(f"angular_frequency = {self.angular_frequency} must be positive")

    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the motion at ``time``."""
        along = np.array([1.0, 0.0, 0.0])
        return Motion(*(part * along for part in self.along_x(time)))

    def along_x(self, time: float) -> tuple[float, float, float]:
        """Return displacement, velocity and acceleration along x at ``time``."""
        omega = self.angular_frequency
        period = 2.0 * math.pi / omega
        s = min(max(time / period, 0.0), 1.0)
        r, r1 = s**3 * (10.0 - 15.0 * s + 6.0 * s * s), 30.0 * s * s * (1.0 - s) ** 2 / period
        r2 = 60.0 * s * (1.0 - 3.0 * s + 2.0 * s * s) / period**2
        sine, cosine = self.amplitude * math.sin(omega * time), self.amplitude * math.cos(omega * time)
        return r * sine, r1 * sine + r * omega * cosine, (r2 - r * omega**2) * sine + 2.0 * r1 * omega * cosine
