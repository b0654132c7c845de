"""Checks of kernels, equations of state, integrators and bodies: built-in ones pass, wrong ones fail."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

from sphframe import (
    EquationOfState,
    Integrator,
    Kernel,
    Motion,
    RigidBody,
    available,
    create,
    polynomial_edge_integrals,
)
from sphframe.testing import BrokenPromiseError, checks_of, parametrize_with_checks

SHIPPED = [
    create(kind, entry.name)
    for kind in ("kernels", "equations_of_state", "integrators")
    for entry in available(kind)
    if entry.distribution == "sphframe"
]


@parametrize_with_checks(SHIPPED)
def test_built_in_components_pass(component, check):
    check(component)


class Tent(Kernel):
    """w = 1 - q/2, whose derivative over q is infinite at the centre, or a similar kernel with a mistake."""

    support: ClassVar[float] = 2.0

    def __init__(self, value=None, gradient=None, factor=1.0):
        self.value = value or (lambda q: (1.0 - 0.5 * q) ** 4 * (2.0 * q + 1.0))
        self.gradient = gradient or (lambda q: -5.0 * (1.0 - 0.5 * q) ** 3)
        self.factor = factor

    def value_function(self):
        return self.value

    def gradient_function(self):
        return self.gradient

    def normalisation(self, dim):
        return (0.75, 7.0 / (4.0 * math.pi), 21.0 / (16.0 * math.pi))[dim - 1] * (self.factor if dim == 3 else 1.0)


class Forgetful(Tent):
    """A kernel that returns the gradient as a function of q in place of q^2."""

    def gradient_of_square_function(self):
        return self.gradient


class Misprinted(Tent):
    """A kernel whose coefficient of q^3 for the edges of walls has the wrong sign."""

    def edge_integrals_function(self):
        return polynomial_edge_integrals((2.0, (1.0, 0.0, -5 / 2, -5 / 2, -15 / 16, 1 / 8)))


@dataclass
class State(EquationOfState):
    inverse_sign: float = 1.0
    stiffness: float = 1.0
    offset: float = 0.0

    def pressure_function(self):
        sign, offset = self.stiffness, self.offset
        return lambda rho, rho0, c: sign * c * c * (rho - rho0) + offset * c * c

    def density_function(self):
        sign = self.inverse_sign
        return lambda p, rho0, c: rho0 + sign * p / (c * c)

    def sound_speed_function(self):
        return lambda rho, rho0, c: c


class Euler(Integrator):
    order = 1
    evaluations = 1
    stability_limit = 1.0
    courant_number = 0.5

    def __init__(self, **changed):
        self.__dict__.update(changed)

    def step(self, system, time, time_step):
        system.hold()
        system.evaluate(time)
        system.advance(time_step)


class LateEuler(Euler):
    """A midpoint scheme that evaluates the rates at the wrong time."""

    order = 2
    evaluations = 2

    def step(self, system, time, time_step):
        system.hold()
        system.evaluate(time)
        system.advance(0.5 * time_step)
        system.evaluate(time)
        system.advance(time_step)


class Paddle(RigidBody):
    def __init__(self, velocity=1.0, acceleration=1.0, size=3):
        self.changed = velocity, acceleration, size

    def motion(self, time, position, velocity, load):
        u, a, size = self.changed
        axis = np.eye(size)[0]
        return Motion(math.sin(time) * axis, u * math.cos(time) * axis, -a * math.sin(time) * axis)


class Spring(RigidBody):
    needs_load = True
    mass = 250.0
    stiffness = 10.0

    def __init__(self, quadratic=0.0, stiffness=10.0, stopped=True):
        self.changed = quadratic, stiffness, stopped

    def motion(self, time, position, velocity, load):
        quadratic, stiffness, stopped = self.changed
        force = load[0] + quadratic * load[0] ** 2
        acceleration = np.array([(force - stiffness * position[0]) / self.mass, 0.0, 0.0])
        if position[0] < 0.0:
            return Motion(np.zeros(3), np.zeros(3) if stopped else velocity, np.maximum(acceleration, 0.0))
        return Motion(position, velocity, acceleration)


def test_right_components_pass():
    for component in (Tent(), State(), Euler(energy=None), Paddle(), Spring()):
        for check in checks_of(component):
            if not (isinstance(component, Euler) and check.name == "energy"):  # the energy of Euler's scheme increases
                check(component)


@pytest.mark.parametrize(
    ("component", "name"),
    [
        (Tent(factor=1.01), "unit_integral"),
        (Tent(value=lambda q: 1e9 * q - 1e9), "moments"),
        (Tent(gradient=lambda q: 5.0 * (1.0 - 0.5 * q) ** 3), "gradient"),
        (Tent(gradient=lambda q: -5.0 * q * (1.0 - 0.5 * q) ** 3), "gradient"),
        (Forgetful(), "gradient"),
        (Tent(value=lambda q: 1.0 / (1.0 + q)), "compact_support"),
        (Tent(value=lambda q: q * (2.0 - q)), "monotone"),
        (Tent(value=lambda q: 1.0 - q), "monotone"),
        (Tent(value=lambda q: 1.0 if (int(q) + 4) * 4611686018427387904 > 0 else 0.0), "compiles"),
        (Misprinted(), "edge_integrals"),
        (State(inverse_sign=-1.0), "inverse"),
        (State(offset=1.0), "inverse"),
        (State(stiffness=-1.0), "pressure_rises"),
        (State(stiffness=2.0), "sound_speed"),
        (Euler(order=2), "order"),
        (LateEuler(), "order"),
        (Euler(evaluations=2), "evaluations"),
        (Euler(), "energy"),
        (Euler(time_reversible=True), "time_reversal"),
        (Euler(courant_number=2.0), "stability"),
        (Paddle(size=2), "motion"),
        (Paddle(velocity=2.0), "derivatives"),
        (Paddle(acceleration=-1.0), "derivatives"),
        (Spring(quadratic=1e-7), "momentum"),
        (Spring(stiffness=20.0), "spring_period"),
        (Spring(stopped=False), "stop"),
    ],
)
def test_a_wrong_component_fails_its_check(component, name):
    check = next(check for check in checks_of(component) if check.name == name)
    with pytest.raises(BrokenPromiseError):
        check(component)


def test_other_objects_have_no_checks():
    with pytest.raises(TypeError, match="BoundaryInterpolator, WallTreatment, Kernel, EquationOfState"):
        checks_of("gaussian")
