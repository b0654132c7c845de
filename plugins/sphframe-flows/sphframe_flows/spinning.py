"""A body that turns at a constant speed."""

from dataclasses import dataclass
from typing import final

import numpy as np

from sphframe import Array, Motion, RigidBody


@final
@dataclass(frozen=True)
class Spinning(RigidBody):
    """A body in the plane that turns about its ``centre``, m, with ``angular_speed``, rad/s, after a ``ramp_time``, s.

    During the ramp the speed grows as s^2 (3 - 2 s), s = t / ramp_time.

    Attributes
    ----------
    angular_speed
        rad/s, positive counter-clockwise.
    ramp_time
        time in which the speed grows from zero, s.
    centre
        point about which the body turns, m.
    """

    angular_speed: float
    ramp_time: float = 0.0
    centre: tuple[float, ...] = (0.0, 0.0)

    def __post_init__(self) -> None:
        if not self.ramp_time >= 0.0:
            raise ValueError(f"ramp_time = {self.ramp_time} must not be negative")

    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the rotation at ``time``."""
        ramp = self.ramp_time
        s = min(max(time / ramp, 0.0), 1.0) if ramp > 0.0 else 1.0
        angle = ramp * s**3 * (1.0 - 0.5 * s) + max(time - ramp, 0.0)
        rate = 6.0 * s * (1.0 - s) / ramp if ramp > 0.0 else 0.0
        turned = self.angular_speed * np.array([0.0, 0.0, 1.0])
        return Motion(angle * turned, s * s * (3.0 - 2.0 * s) * turned, rate * turned)
