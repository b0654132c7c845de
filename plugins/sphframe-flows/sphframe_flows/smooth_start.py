"""A body that starts smoothly."""

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from sphframe import Array, Motion, RigidBody


@final
@dataclass(frozen=True)
class SmoothStart(RigidBody):
    """A body that starts along x to the speed U, with a pulse of acceleration of the form of a Gaussian curve::

        X'' = U / (sqrt(pi) T) exp(-s^2),    X' = U / 2 (erf(s) + erf(s0)),    s = t / T - s0,    s0 = sqrt(ln 1000)

    The acceleration at the start is a thousandth of the largest one, at t = s0 T, and the last speed (1 - 1e-4) U.

    Attributes
    ----------
    speed
        U, m/s.
    duration
        T, s.
    """

    speed: float
    duration: float

    def __post_init__(self) -> None:
        if not self.duration > 0.0:
            raise ValueError(f"duration = {self.duration} must be positive")

    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the motion at ``time``."""
        start, root = math.sqrt(math.log(1000.0)), math.sqrt(math.pi)
        s = max(time, 0.0) / self.duration - start

        def integral(s: float) -> float:
            return s * math.erf(s) + math.exp(-s * s) / root

        way = integral(s) - integral(-start) + math.erf(start) * (s + start)
        along = np.array([self.speed, 0.0, 0.0])
        return Motion(
            0.5 * self.duration * way * along,
            0.5 * (math.erf(s) + math.erf(start)) * along,
            math.exp(-s * s) / (root * self.duration) * along,
        )
