"""Integrators on ordinary differential equations with known solutions."""

import math

import numpy as np
import pytest

from sphframe.integrators import RungeKutta4, Symplectic


class Oscillator:
    """x' = u, u' = -x, and an acoustic pair rho' = -v, v' = rho in the second component."""

    def __init__(self):
        self.x, self.u, self.rho = np.array([1.0, 0.0]), np.array([0.0, 0.0]), np.array([1.0])
        self.a, self.r, self.v = np.zeros(2), np.zeros(1), np.zeros(2)
        self.calls = 0

    def state(self):
        return np.concatenate([self.x, self.u, self.rho])

    def evaluate_density(self, time):
        self.r = np.array([-self.u[1]])

    def evaluate_acceleration(self, time):
        self.calls += 1
        self.a = np.array([-self.x[0], self.rho[0]])

    def evaluate(self, time):
        self.v = self.u.copy()
        self.evaluate_density(time)
        self.evaluate_acceleration(time)

    def hold(self):
        self.start = (self.x.copy(), self.u.copy(), self.rho.copy())
        self.total = [0.0, 0.0, 0.0]

    def accumulate(self, weight):
        self.total = [t + weight * f for t, f in zip(self.total, (self.v, self.a, self.r), strict=True)]

    def advance(self, interval):
        self.x, self.u, self.rho = (y + interval * f for y, f in zip(self.start, (self.v, self.a, self.r), strict=True))

    def advance_total(self, interval):
        self.x, self.u, self.rho = (y + interval * f for y, f in zip(self.start, self.total, strict=True))

    def drift(self, interval):
        self.x = self.x + interval * self.u

    def kick(self, interval):
        self.u = self.u + interval * self.a

    def update_density(self, interval):
        self.rho = self.rho + interval * self.r


def solve(integrator, steps, until=2.0):
    system = Oscillator()
    system.evaluate(0.0)
    system.calls = 0
    for k in range(steps):
        integrator.step(system, until * k / steps, until / steps)
    return system


@pytest.mark.parametrize("integrator", [Symplectic(), RungeKutta4()])
def test_order(integrator):
    errors = []
    for steps in (40, 80):
        system = solve(integrator, steps)
        exact = [math.cos(2.0), -math.sin(2.0), math.sin(2.0), math.cos(2.0)]
        errors.append(np.abs(np.array([system.x[0], system.u[0], system.u[1], system.rho[0]]) - exact).max())
    assert math.log2(errors[0] / errors[1]) == pytest.approx(integrator.order, abs=0.1)


@pytest.mark.parametrize("integrator", [Symplectic(), RungeKutta4()])
def test_evaluations_are_as_declared(integrator):
    assert solve(integrator, 10).calls == 10 * integrator.evaluations


def test_symplectic_keeps_the_amplitude_up_to_its_limit():
    for frequency_step in (0.5, 1.0, 1.9):
        system = Oscillator()
        system.evaluate(0.0)
        largest = 0.0
        for k in range(20_000):
            Symplectic().step(system, k * frequency_step, frequency_step)
            largest = max(largest, abs(system.x[0]), abs(system.rho[0]))
        assert largest < 4.0, f"an undamped oscillation must not grow at omega dt = {frequency_step}"


def test_symplectic_is_time_reversible():
    system = solve(Symplectic(), 50)
    system.u = -system.u
    system.evaluate(0.0)
    for k in range(50):
        Symplectic().step(system, 0.04 * k, 0.04)
    np.testing.assert_allclose([system.x[0], system.rho[0]], [1.0, 1.0], atol=1e-12)
