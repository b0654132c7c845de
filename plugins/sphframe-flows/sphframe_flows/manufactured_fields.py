"""Velocities and pressures without divergence that meet the conditions of walls, and what drives such a flow.

::

    u = T(t) (psi_y, -psi_x),    p = rho0 T(t) P,    rho = rho0 + p/c0^2,    T = exp(-a t)

With these, the equations of motion need the sources ::

    f = du/dt + (u.grad) u + grad p/rho - nu lap u        force per mass
    S = (dp/dt + u.grad p)/c0^2                            rate of density

Source of the idea: P. Negi, P. Ramachandran (2022), arXiv:2208.10848.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

import numpy as np

from sphframe import Array
from sphframe_flows.jets import Jet, cosine, sine

RADIUS, AMPLITUDE = 0.5, 0.1
"""of the disc and of the wavy bed, m"""
PI = math.pi

Function = Callable[[Jet, Jet], Jet]


def _box(x: Jet, y: Jet) -> Jet:
    return x * (1.0 - x) * y * (1.0 - y)


def _disc(x: Jet, y: Jet) -> Jet:
    return RADIUS**2 - x * x - y * y


def _bed(x: Jet, y: Jet) -> Jet:
    return y - AMPLITUDE * cosine(2.0 * PI * x)


def _stressfree_disc(x: Jet, y: Jet) -> Jet:
    shape = 1.0 + 0.3 / RADIUS * x * (3.0 - (x * x + y * y) * (1.0 / RADIUS**2))
    return 0.5 * 0.63 / RADIUS * _disc(x, y) * shape


@dataclass(frozen=True)
class ManufacturedField:
    """A flow in a domain: ``psi`` with a speed of about 1 m/s, and whether it slips and has a viscosity.

    ``zero``: a pressure without normal gradient at the walls; None where there is none.
    """

    domain: Literal["box", "disc", "wave", "square"]
    psi: Function
    zero: Function | None
    slips: bool
    viscous: bool


def _zero_in_box(x: Jet, y: Jet) -> Jet:
    return 0.5 * (2.0 + cosine(PI * x) * cosine(PI * y))


def _zero_in_disc(x: Jet, y: Jet) -> Jet:
    return (0.25 / RADIUS**3) * (4.0 * RADIUS**3 + 3.0 * RADIUS**2 * x - x**3 - x * y * y)


def gradient_pressure(x: Jet, y: Jet) -> Jet:
    """Return P = 1 + x^2/2 + x y/2, which has a gradient at the walls."""
    return 1.0 + 0.5 * (x * x + x * y)


FIELDS = {
    "noslip-box": ManufacturedField("box", lambda x, y: 84.0 * _box(x, y) ** 2, _zero_in_box, False, True),
    "freeslip-box": ManufacturedField(
        "box", lambda x, y: (1.0 / PI) * sine(PI * x) * sine(PI * y), _zero_in_box, True, True
    ),
    "shearslip-box": ManufacturedField("box", lambda x, y: 4.0 * _box(x, y), _zero_in_box, True, False),
    "noslip-disc": ManufacturedField(
        "disc", lambda x, y: 0.55 / RADIUS**3 * _disc(x, y) ** 2 * (1.0 + 0.5 / RADIUS * x), _zero_in_disc, False, True
    ),
    "stressfree-disc": ManufacturedField("disc", _stressfree_disc, _zero_in_disc, True, True),
    "noslip-wave": ManufacturedField(
        "wave", lambda x, y: 3.0 * _bed(x, y) ** 2 * (1.0 - y) ** 2 * sine(PI * x) ** 2, None, False, True
    ),
    "tangent-wave": ManufacturedField("wave", lambda x, y: _bed(x, y) * (1.0 - y) * sine(PI * x), None, True, False),
}
"""by name"""
FIELDS["periodic"] = replace(FIELDS["freeslip-box"], domain="square")
"""the same flow without walls, which repeats itself in a square of side 2"""


class State(NamedTuple):
    """The flow at points: ``velocity`` (n, 2), m/s, ``pressure`` (n,), Pa, and ``pressure_gradient`` (n, 2), Pa/m."""

    velocity: Array
    pressure: Array
    pressure_gradient: Array


@dataclass(frozen=True)
class Manufactured:
    """A field with constants: rho0 ``density``, c0 ``sound_speed``, nu ``viscosity`` and ``decay`` a, SI units."""

    field: ManufacturedField
    gradient: bool
    density: float
    sound_speed: float
    viscosity: float
    decay: float = 0.0

    def _pressure(self, x: Jet, y: Jet) -> Jet:
        found = self.field.zero
        return gradient_pressure(x, y) if self.gradient or found is None else found(x, y)

    def state(self, points: Array, time: float) -> State:
        """Return the flow at ``points`` (n, 2) and ``time``, s."""
        x, y = Jet.variables(points, degree=1)
        psi, p = self.field.psi(x, y), self._pressure(x, y)
        t = math.exp(-self.decay * time)
        velocity = np.stack([psi.derivative(0, 1), -psi.derivative(1, 0)], axis=1)
        slope = np.stack([p.derivative(1, 0), p.derivative(0, 1)], axis=1)
        return State(t * velocity, self.density * t * p.value, self.density * t * slope)

    def force(self, points: Array, time: float) -> Array:
        """Return f (n, 2), m/s^2."""
        x, y = Jet.variables(points)
        psi, state = self.field.psi(x, y), self.state(points, time)
        t = math.exp(-self.decay * time)
        u, v = state.velocity.T
        u_x, u_y, v_x = t * psi.derivative(1, 1), t * psi.derivative(0, 2), -t * psi.derivative(2, 0)
        laplacian = np.stack(
            [psi.derivative(2, 1) + psi.derivative(0, 3), -psi.derivative(3, 0) - psi.derivative(1, 2)], axis=1
        )
        convection = np.stack([u * u_x + v * u_y, u * v_x - v * u_x], axis=1)
        density = self.density + state.pressure / self.sound_speed**2
        inertia = convection - self.decay * state.velocity
        return inertia + state.pressure_gradient / density[:, None] - self.viscosity * t * laplacian

    def density_rate(self, points: Array, time: float) -> Array:
        """Return S (n,), kg/(m^3 s)."""
        state = self.state(points, time)
        rate = (state.velocity * state.pressure_gradient).sum(axis=1) - self.decay * state.pressure
        return np.asarray(rate / self.sound_speed**2)

    def wall_force(self, points: Array, time: float) -> Array:
        """Return what balances the pressure at the walls, grad p (n, 2), Pa/m."""
        return self.state(points, time).pressure_gradient
