"""Testing: integrators, one check function per property."""

import math
from collections.abc import Callable

import numpy as np

from sphframe.arrays import Array
from sphframe.compiled.parts import checked_function
from sphframe.interfaces import Integrator
from sphframe.testing.evaluation import title
from sphframe.testing.proof import require


class Oscillator:
    """An acoustic mode, dx/dt = u, du/dt = -frequency^2 (x + rho)/2 + push cos(3t), drho/dt = u + forcing cos(2t).

    It starts from x = rho = 1, u = 0. All rates depend on the state or on the time, so that one at the wrong time or
    state lowers the order.
    """

    def __init__(self, forcing: float = 0.0, push: float = 0.0, frequency: float = 1.0) -> None:
        self.x, self.u, self.rho = 1.0, 0.0, 1.0
        self.forcing, self.push, self.square = forcing, push, frequency**2
        self.evaluations = 0.0
        self._rates = np.array([0.0, push - self.square, forcing])
        self._total = np.zeros(3)
        self._start = np.zeros(3)
        self._stored: dict[int, tuple[float, Array]] = {}

    def exact(self, time: float) -> tuple[float, float, float]:
        """Return x, u and rho at ``time`` for the frequency 1."""
        f, g = self.forcing, self.push / 8.0
        c, s = math.cos(time), math.sin(time)
        c2, s2, c3, s3 = math.cos(2.0 * time), math.sin(2.0 * time), math.cos(3.0 * time), math.sin(3.0 * time)
        x = (1.0 + g) * c - f / 6.0 * s + f / 12.0 * s2 - g * c3
        u = -(1.0 + g) * s - f / 6.0 * c + f / 6.0 * c2 + 3.0 * g * s3
        return x, u, x + 0.5 * f * s2

    def evaluate(self, time: float) -> None:
        """Compute all rates."""
        self.evaluate_density(time)
        self._rates[0] = self.u
        self.evaluate_acceleration(time)

    def evaluate_density(self, time: float) -> None:
        """Compute the density rate."""
        self.evaluations += 0.5
        self._rates[2] = self.u + self.forcing * math.cos(2.0 * time)

    def evaluate_acceleration(self, time: float) -> None:
        """Compute the acceleration."""
        self.evaluations += 0.5
        self._rates[1] = -0.5 * self.square * (self.x + self.rho) + self.push * math.cos(3.0 * time)

    def hold(self) -> None:
        """Store the present state as y0."""
        self._start = np.array([self.x, self.u, self.rho])
        self._total = np.zeros(3)

    def advance(self, interval: float) -> None:
        """y = y0 + interval f."""
        self.x, self.u, self.rho = (self._start + interval * self._rates).tolist()

    def accumulate(self, weight: float) -> None:
        """Total = total + weight f."""
        self._total += weight * self._rates

    def advance_total(self, interval: float) -> None:
        """y = y0 + interval total."""
        self.x, self.u, self.rho = (self._start + interval * self._total).tolist()

    def store(self, place: int, time: float) -> None:
        """Store the total."""
        self._stored[place] = time, self._total.copy()

    def stored_time(self, place: int) -> float | None:
        """Return the time of a stored total; None before the first."""
        return self._stored[place][0] if place in self._stored else None

    def accumulate_stored(self, place: int, weight: float) -> None:
        """Total = total + weight * stored total."""
        self._total += weight * self._stored[place][1]

    def drift(self, interval: float) -> None:
        """x = x + interval u."""
        self.x += interval * self.u

    def kick(self, interval: float) -> None:
        """u = u + interval a."""
        self.u += interval * float(self._rates[1])

    def update_density(self, interval: float) -> None:
        """Rho = rho + interval drho/dt."""
        self.rho += interval * float(self._rates[2])


def _integrate(
    integrator: Integrator, steps: int, time: float, forcing: float = 0.0, push: float = 0.0, frequency: float = 1.0
) -> Oscillator:
    system = Oscillator(forcing, push, frequency)
    interval = time / steps
    for k in range(steps):
        integrator.step(system, k * interval, interval)
    return system


def check_steps(integrator: Integrator) -> None:
    """A step takes the system, the time and the time step."""
    checked_function(integrator, "step", integrator.step, ("system", "time", "time_step"))
    integrator.step(Oscillator(), 0.0, 0.1)


def check_order(integrator: Integrator) -> None:
    """The errors of position, velocity and density of a forced acoustic mode decrease with the declared order."""
    for name, k in (("position", 0), ("velocity", 1), ("density", 2)):
        errors = []
        for steps in (40, 80):
            end = _integrate(integrator, steps, 3.0, forcing=0.5, push=0.5)
            errors.append(abs((end.x, end.u, end.rho)[k] - end.exact(3.0)[k]))
        measured = math.log2(errors[0] / errors[1]) if errors[1] > 0.0 else math.inf
        require(
            measured > integrator.order - 0.4,
            f"{title(integrator)}: the {name} converges with order {measured:.2f}, but order is {integrator.order}",
        )


def check_evaluations(integrator: Integrator) -> None:
    """The number of evaluations of the rates per step is the declared one, once the first ten steps are made."""
    counted = (_integrate(integrator, 20, 2.0).evaluations - _integrate(integrator, 10, 1.0).evaluations) / 10
    require(
        counted == integrator.evaluations,
        f"{title(integrator)}: {counted:g} evaluations per step, but evaluations is {integrator.evaluations}",
    )


def check_energy(integrator: Integrator) -> None:
    """An acoustic mode of 60 steps a period gains less than 1 % of energy, and loses less than 10 %, in 100 periods."""
    end = _integrate(integrator, 6000, 200.0 * math.pi)
    energy = (0.5 * (end.x + end.rho)) ** 2 + end.u**2
    require(
        0.9 < energy < 1.01,
        f"{title(integrator)}: after a hundred periods of 60 steps an acoustic mode has {energy:.4f} of its energy",
    )


def check_time_reversal(integrator: Integrator) -> None:
    """With ``time_reversible``, an acoustic mode integrated backwards in time returns to its start."""
    if not getattr(integrator, "time_reversible", False):
        return
    system = _integrate(integrator, 50, 5.0)
    for k in range(50):
        integrator.step(system, 5.0 - 0.1 * k, -0.1)
    back = (system.x, system.u, system.rho)
    require(
        bool(np.allclose(back, (1.0, 0.0, 1.0), atol=1e-10)),
        f"{title(integrator)}: it declares time_reversible, but returns to x, u, rho = {back}, not to 1, 0, 1",
    )


def check_stability(integrator: Integrator) -> None:
    """The recommended Courant number lies below the stability limit, and up to this limit no sound is amplified.

    The highest frequency on a lattice is 0.86 c0/h, found with the schemes of the project.
    """
    require(
        0.0 < integrator.courant_number < integrator.stability_limit,
        f"{title(integrator)}: courant_number {integrator.courant_number} must lie between 0 and stability_limit"
        f" {integrator.stability_limit}",
    )
    for name in ("courant_number", "stability_limit"):
        number = getattr(integrator, name)
        frequency = _HIGHEST * number * (1.0 if name == "courant_number" else 0.97)
        end = _integrate(integrator, 400, 400.0, frequency=frequency)
        size = max(abs(end.x), abs(end.rho), abs(end.u) / frequency)
        require(
            size < 100.0,
            f"{title(integrator)}: with c0 dt / h = {name} = {number:g} sound grows to {size:.3g} times its"
            " amplitude in 400 steps",
        )


_HIGHEST = 0.858
"""highest frequency of sound on a lattice over c0/h"""

CHECKS: dict[str, Callable[[Integrator], None]] = {
    "steps": check_steps,
    "order": check_order,
    "evaluations": check_evaluations,
    "energy": check_energy,
    "time_reversal": check_time_reversal,
    "stability": check_stability,
}
"""the checks of an integrator, by the name of the property"""
