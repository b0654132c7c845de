"""A piston that makes a solitary wave."""

import math
from dataclasses import dataclass
from typing import Literal, final

import numpy as np

from sphframe import Array, Motion, RigidBody

_LEAD = 3.8
"""phase at the start: the wave's elevation at the paddle is then A sech^2(3.8) = 0.002 A"""


@final
@dataclass(frozen=True)
class SolitaryWavePaddle(RigidBody):
    """A piston along x whose velocity is that of the water under a solitary wave, averaged over the depth.

    With the elevation eta = A sech^2 theta, theta = k (c (t - t0) - X), at the moving paddle::

        dX/dt = c eta / (d + eta)    which integrates exactly to    X = A / (k d) tanh theta

    an implicit equation for X, solved to round-off at every time. The stroke is 2 A / (k d). c = sqrt(g (d + A)), and
    k is that of a theory: Rayleigh's sqrt(3 A / (4 d^2 (d + A))) or Boussinesq's sqrt(3 A / (4 d^3)).

    The convention of time: the paddle starts at t = 0 with theta = -3.8, from where its displacement is measured, and
    is in the middle of its stroke at :attr:`mid_stroke_time` t0 = (3.8 + A/d) / (k c).

    Attributes
    ----------
    wave_height
        A, m.
    depth
        d, m.
    gravity
        m/s^2.
    theory
        ``"rayleigh"`` or ``"boussinesq"``.

    Notes
    -----
    Departs from the paper, which names no paddle.

    Source: D. G. Goring, Tsunamis: the propagation of long waves onto a shelf, PhD thesis, Caltech (1978),
    doi:10.7907/QX84-8J34; K. Guizien, E. Barthelemy (2002), doi:10.1080/00221680209499946.

    Examples
    --------
    >>> paddle = SolitaryWavePaddle(wave_height=0.15, depth=0.25)
    >>> round(paddle.speed, 3), round(paddle.stroke, 3), round(paddle.arrival_time(10.0), 2)
    (1.981, 0.566, 5.95)
    """

    wave_height: float
    depth: float
    theory: Literal["rayleigh", "boussinesq"] = "rayleigh"
    gravity: float = 9.81

    def __post_init__(self) -> None:
        for name in ("wave_height", "depth", "gravity"):
            if not getattr(self, name) > 0.0:
                raise ValueError(f"{name} = {getattr(self, name)} must be positive")
        if self.theory not in ("rayleigh", "boussinesq"):
            raise ValueError(f"theory = {self.theory!r} must be 'rayleigh' or 'boussinesq'")

    @property
    def wavenumber(self) -> float:
        """Wavenumber k of the theory, 1/m."""
        height, depth = self.wave_height, self.depth
        scale = depth + height if self.theory == "rayleigh" else depth
        return math.sqrt(0.75 * height / (depth * depth * scale))

    @property
    def speed(self) -> float:
        """Speed c of the wave, m/s."""
        return math.sqrt(self.gravity * (self.depth + self.wave_height))

    @property
    def stroke(self) -> float:
        """Stroke 2 A / (k d) of the paddle, m."""
        return 2.0 * self.wave_height / (self.wavenumber * self.depth)

    @property
    def mid_stroke_time(self) -> float:
        """Time t0 at which the paddle is in the middle of its stroke and the crest leaves it, s."""
        return (_LEAD + self.wave_height / self.depth * math.tanh(_LEAD)) / (self.wavenumber * self.speed)

    def arrival_time(self, x: float, speed: float | None = None) -> float:
        """Time at which the crest is ``x`` m from where the paddle starts, at ``speed`` (by default c), s."""
        middle = 0.5 * self.stroke * math.tanh(_LEAD)
        return self.mid_stroke_time + (x - middle) / (self.speed if speed is None else speed)

    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the paddle's motion, which does not depend on the water."""
        k, ratio = self.wavenumber, self.wave_height / self.depth
        phase = k * self.speed * (max(time, 0.0) - self.mid_stroke_time)
        theta = _solve(phase, ratio)
        sech2 = 1.0 / math.cosh(min(abs(theta), 300.0)) ** 2
        x = ratio / k * (math.tanh(theta) + math.tanh(_LEAD))
        u = self.speed * ratio * sech2 / (1.0 + ratio * sech2)
        # theta' = k (c - u), eta'/A = -2 sech^2 tanh theta', u' = c d eta' / (d + eta)^2
        rate = k * (self.speed - u)
        a = -2.0 * self.speed * ratio * sech2 * math.tanh(theta) * rate / (1.0 + ratio * sech2) ** 2
        if time < 0.0:
            x, u, a = 0.0, 0.0, 0.0
        return Motion(np.array([x, 0.0, 0.0]), np.array([u, 0.0, 0.0]), np.array([a, 0.0, 0.0]))


def _solve(phase: float, ratio: float) -> float:
    """Theta from theta + ratio tanh(theta) = phase; the left side is monotone, so Newton's iteration converges."""
    theta = phase / (1.0 + ratio) if abs(phase) < 1.0 + ratio else phase - math.copysign(ratio, phase)
    for _ in range(50):
        tanh = math.tanh(theta)
        change = (theta + ratio * tanh - phase) / (1.0 + ratio * (1.0 - tanh * tanh))
        theta -= change
        if abs(change) <= 1e-15 * (1.0 + abs(theta)):
            break
    return theta
