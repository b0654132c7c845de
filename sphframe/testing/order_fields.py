"""Testing: walls, and flows beside them that continue analytically through them, in two dimensions.

A wall is the zero of F(x, y), which is positive in the fluid. With analytic functions G and Q without symmetry::

    no slip    psi = F^2 G                      u = (psi_y, -psi_x) = 0 on the wall, and u_nn is not 0
    slip       psi = F A + F^3 G                tangential on the wall, at straight and circular ones without stress
    pressure   p = p_0 + b.x + Q - F grad Q.grad F/|grad F|^2 + F^2 G,    dp/dn = b.n on the wall

Derivatives are those along a complex step, exact to round-off.

Source of the idea of such fields: P. Negi, P. Ramachandran (2022), arXiv:2208.10848.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from sphframe.arrays import Array, BoolArray

DENSITY, GRAVITY = 1000.0, (0.3, -1.0)
"""rho0, kg/m^3, and f, m/s^2: b = rho0 f"""
RADIUS, AMPLITUDE = 0.5, 0.05
"""of the circular and the wavy wall, m"""
_STEP = 1e-30

Function = Callable[[Any, Any], Any]


def gradient(function: Function, points: Array) -> Array:
    """Return the gradient (n, 2) of an analytic ``function`` at ``points`` (n, 2)."""
    x, y = points.T
    found = np.stack([function(x + 1j * _STEP, y), function(x, y + 1j * _STEP)], axis=1)
    return np.asarray(found.imag / _STEP)


def _curl(psi: Function) -> Callable[[Array], Array]:
    def velocity(points: Array) -> Array:
        slope = gradient(psi, points)
        return np.stack([slope[:, 1], -slope[:, 0]], axis=1)

    return velocity


def _general(x: Any, y: Any) -> Any:
    return 1.0 + 0.4 * np.sin(2.0 * x + y + 1.0) + 0.5 * y


def _wave(x: Any, y: Any) -> Any:
    return np.sin(2.0 * x - 1.5 * y + 0.5)


@dataclass(frozen=True)
class TestWall:
    """A wall F = 0, ``level`` F, beside which flows are tested; ``name``: straight, circle or wavy."""

    __test__ = False  # for pytest

    name: str
    level: Function
    along: Function
    """A(x, y) of the flow that slips"""
    length: float
    """of the part of the wall beside which errors are measured, m"""

    def normal(self, points: Array) -> Array:
        """Return the unit vectors (n, 2) away from the wall, into the fluid, at ``points`` (n, 2)."""
        slope = gradient(self.level, points)
        return np.asarray(slope / np.hypot(*slope.T)[:, None])

    def distance(self, points: Array) -> Array:
        """Return the distances (n,) from the wall, m; near the wavy one to first order."""
        if self.name == "circle":
            return np.asarray(RADIUS - np.hypot(*points.T))
        return np.asarray(self.level(*points.T) / np.hypot(*gradient(self.level, points).T))

    def measured(self, points: Array, support: float) -> BoolArray:
        """Return which points (n,) are within the ``support`` (m) of that part of the wall which is measured."""
        near: BoolArray = self.distance(points) < support
        return near if self.name == "circle" else near & (np.abs(points[:, 0] - 0.5) < 0.5)

    def no_slip(self, points: Array) -> Array:
        """Return the velocity (n, 2) of a flow with no slip, m/s."""
        return _curl(lambda x, y: self.level(x, y) ** 2 * _general(x, y))(points)

    def slip(self, points: Array) -> Array:
        """Return the velocity (n, 2) of a flow that slips, m/s."""
        level, along = self.level, self.along
        return _curl(lambda x, y: level(x, y) * along(x, y) + level(x, y) ** 3 * _general(x, y))(points)

    def profile(self, points: Array) -> Array:
        """Return G (n,), 1/(m s): the flow with no slip is 2 d G at the small distance d."""
        return np.asarray(_general(*points.T))

    def pressure(self, points: Array) -> Array:
        """Return the pressure (n,), Pa."""
        x, y = points.T
        level, slope, slope_q = self.level(x, y), gradient(self.level, points), gradient(_wave, points)
        across = (slope * slope_q).sum(axis=1) / (slope**2).sum(axis=1)
        rest = _wave(x, y) - level * across + level**2 * _general(x, y)
        return np.asarray(DENSITY * (2.0 + points @ np.array(GRAVITY) + rest))


WALLS = {
    wall.name: wall
    for wall in (
        TestWall("straight", lambda x, y: y + 0.0 * x, lambda x, y: 1.0 + 0.4 * np.sin(2.0 * x + 1.0) + 0.0 * y, 1.0),
        TestWall(
            "circle",
            lambda x, y: (RADIUS**2 - x * x - y * y) / (2.0 * RADIUS),
            lambda x, y: 1.0 + 0.3 * x / RADIUS * (3.0 - (x * x + y * y) / RADIUS**2),
            2.0 * math.pi * RADIUS,
        ),
        TestWall("wavy", lambda x, y: y - AMPLITUDE * np.cos(2.0 * np.pi * x), _general, 1.0),
    )
}


def drawn(wall: TestWall, spacing: float, support: float) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return a wall and fluid beside it as data for a case, as deep as the errors near the wall need."""
    side, depth = (math.ceil(factor * support / spacing) * spacing for factor in (2.2, 2.5))
    if wall.name == "circle":
        circle = {"shape": "circle", "centre": (0.0, 0.0), "radius": RADIUS}
        return circle, circle
    if wall.name == "straight":
        box = {"shape": "box", "lower": (-side, 0.0), "upper": (1.0 + side, depth)}
        return {**box, "open_faces": ["+y"]}, box
    x = np.linspace(-side, 1.0 + side, 4 * round((1.0 + 2.0 * side) / spacing) + 1)
    bed = np.stack([x, AMPLITUDE * np.cos(2.0 * np.pi * x)], axis=1)
    points = [(-side, AMPLITUDE + depth), *map(tuple, bed.tolist()), (1.0 + side, AMPLITUDE + depth)]
    return ({"shape": "polygon", "points": points},) * 2
