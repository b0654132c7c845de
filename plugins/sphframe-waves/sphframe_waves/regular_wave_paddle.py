"""A piston that makes regular waves."""

import math
from dataclasses import dataclass
from typing import final

import numpy as np
from scipy.optimize import brentq

from sphframe import Array, Motion, RigidBody


@final
@dataclass(frozen=True)
class RegularWavePaddle(RigidBody):
    """A piston along x that makes regular waves by first-order (Biesel) theory.

    ::

        X(t) = r(t) S/2 sin(omega t),    H/S = 2 (cosh 2kd - 1) / (sinh 2kd + 2kd),    omega^2 = g k tanh(kd)

    The ramp r(t) = s^3 (10 - 15 s + 6 s^2), s = t / (ramp_periods T), grows from 0 to 1 with continuous acceleration.

    Source: F. Biesel, F. Suquet, Les appareils generateurs de houle en laboratoire, La Houille Blanche (1951),
    doi:10.1051/lhb/1951033.

    Attributes
    ----------
    wave_height
        H from trough to crest, m.
    period
        T, s.
    depth
        d, m.
    gravity
        m/s^2.
    ramp_periods
        periods over which the motion grows.

    Examples
    --------
    In shallow water the stroke is H / (kd):

    >>> paddle = RegularWavePaddle(wave_height=0.01, period=10.0, depth=0.1)
    >>> round(paddle.stroke * paddle.wavenumber * paddle.depth / paddle.wave_height, 3)
    1.0
    """

    wave_height: float
    period: float
    depth: float
    gravity: float = 9.81
    ramp_periods: float = 2.0

    def __post_init__(self) -> None:
        for name in ("wave_height", "period", "depth", "gravity", "ramp_periods"):
            if not getattr(self, name) > 0.0:
                raise ValueError(f"{name} = {getattr(self, name)} must be positive")
        deep = (2.0 * math.pi / self.period) ** 2 * self.depth / self.gravity
        kd = float(brentq(lambda x: x * math.tanh(x) - deep, 0.0, deep + math.sqrt(deep), xtol=1e-14, rtol=1e-14))
        ratio = 2.0 * (math.cosh(2.0 * kd) - 1.0) / (math.sinh(2.0 * kd) + 2.0 * kd) if kd < 50.0 else 2.0
        object.__setattr__(self, "_wavenumber", kd / self.depth)
        object.__setattr__(self, "_stroke", self.wave_height / ratio)

    @property
    def wavenumber(self) -> float:
        """Wavenumber k, 1/m."""
        return float(vars(self)["_wavenumber"])

    @property
    def stroke(self) -> float:
        """Stroke S of the paddle, from end to end, m."""
        return float(vars(self)["_stroke"])

    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the paddle's motion, which does not depend on the water."""
        omega, half = 2.0 * math.pi / self.period, 0.5 * self.stroke
        sin, cos = half * math.sin(omega * time), half * math.cos(omega * time)
        length = self.ramp_periods * self.period
        s = min(max(time / length, 0.0), 1.0)
        r = s**3 * (10.0 - 15.0 * s + 6.0 * s * s)
        r1 = 30.0 * s * s * (1.0 - s) ** 2 / length
        r2 = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / length**2
        x = r * sin
        u = r1 * sin + r * omega * cos
        a = r2 * sin + 2.0 * r1 * omega * cos - r * omega * omega * sin
        return Motion(np.array([x, 0.0, 0.0]), np.array([u, 0.0, 0.0]), np.array([a, 0.0, 0.0]))
