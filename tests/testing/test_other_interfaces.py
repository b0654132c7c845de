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


class Background(State):
    """A linear equation of state with a background pressure, as confined flows have it."""

    def pressure_function(self):
        return lambda rho, rho0, c: c * c * (rho - 0.9 * rho0)

    def density_function(self):
        return lambda p, rho0, c: 0.9 * rho0 + p / (c * c)


class Water(State):
    """An equation of state with the reference density of water in its sound speed."""

    def sound_speed_function(self):
        return lambda rho, rho0, c: c * rho0 / 1000.0


class Banded(State):
    """An inverse that is one within 5 % only."""

    def density_function(self):
        return lambda p, rho0, c: rho0 + p / (c * c) if abs(p) < 0.05 * rho0 * c * c else rho0


class RungeKutta3(Integrator):
    """The scheme of Heun of third order, which damps sound slightly."""

    order = 3
    evaluations = 3
    stability_limit = 1.9
    courant_number = 0.9

    def step(self, system, time, time_step):
        system.hold()
        system.evaluate(time)
        system.accumulate(0.25)
        system.advance(time_step / 3.0)
        system.evaluate(time + time_step / 3.0)
        system.advance(2.0 * time_step / 3.0)
        system.evaluate(time + 2.0 * time_step / 3.0)
        system.accumulate(0.75)
        system.advance_total(time_step)


class LateWalls(Integrator):
    """The symplectic scheme with accelerations of the time before."""

    order = 2
    evaluations = 1
    stability_limit = 2.33
    courant_number = 0.7

    def __init__(self, **changed):
        self.__dict__.update(changed)

    def step(self, system, time, time_step):
        system.kick(0.5 * time_step)
        system.drift(0.5 * time_step)
        system.evaluate_density(time + 0.5 * time_step)
        system.update_density(time_step)
        system.drift(0.5 * time_step)
        system.evaluate_acceleration(time)
        system.kick(0.5 * time_step)


class Wanderer(Paddle):
    """A paddle that is wrong after three seconds, displaced at the start, or that writes to its arguments."""

    def __init__(self, mistake):
        super().__init__()
        self.mistake = mistake

    def motion(self, time, position, velocity, load):
        right = super().motion(time, position, velocity, load)
        if self.mistake == "writes":
            velocity += 1.0
        factor = 2.0 if self.mistake == "late" and time > 3.0 else 1.0
        moved = 0.1 if self.mistake == "moved" else 0.0
        return right._replace(velocity=factor * right.velocity, position=right.position + moved)


class Pusher(Spring):
    """A spring whose damper pushes."""

    def motion(self, time, position, velocity, load):
        motion = super().motion(time, position, velocity, load)
        return motion._replace(acceleration=motion.acceleration + 0.3 * velocity)


def in_a_band(low, high):
    return lambda q: -5.0 * (1.0 - 0.5 * q) ** 3 * (0.9 if low < q < high else 1.0)


def test_right_components_pass():
    for component in (Tent(), State(), Background(), Euler(), RungeKutta3(), Paddle(), Spring()):
        for check in checks_of(component):
            # Euler's scheme gains energy
            if not (isinstance(component, Euler) and check.name in ("energy", "stability")):
                check(component)


@pytest.mark.parametrize(
    ("component", "name"),
    [
        (Tent(factor=1.01), "unit_integral"),
        (Tent(value=lambda q: 1e9 * q - 1e9), "moments"),
        (Tent(gradient=lambda q: 5.0 * (1.0 - 0.5 * q) ** 3), "gradient"),
        (Tent(gradient=lambda q: -5.0 * q * (1.0 - 0.5 * q) ** 3), "gradient"),
        (Forgetful(), "gradient"),
        (Tent(gradient=in_a_band(0.5003, 0.5011)), "gradient"),
        (Tent(gradient=in_a_band(1.985, 2.0)), "gradient"),
        (Water(), "sound_speed"),
        (Banded(), "inverse"),
        (LateWalls(), "order"),
        (LateWalls(courant_number=2.1, stability_limit=7.0), "stability"),
        (Euler(courant_number=0.9), "stability"),
        (Wanderer("writes"), "motion"),
        (Wanderer("moved"), "start"),
        (Wanderer("late"), "derivatives"),
        (Pusher(), "damping"),
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
