"""Interfaces: how the state is advanced in time."""

from abc import ABC, abstractmethod
from typing import ClassVar, Protocol


class System(Protocol):
    """The ordinary differential equation dy/dt = f(t, y) that an integrator solves.

    The state y holds positions x, velocities u and (for a fluid) densities; its rates f are velocities, accelerations
    and density rates. The system owns all arrays; an integrator only calls the methods below.

    A one-step scheme of Runge-Kutta type calls hold, evaluate, accumulate, advance and advance_total; a splitting
    scheme calls evaluate_density and evaluate_acceleration, and advances position (drift), velocity (kick) and density
    one after the other. A multi-step scheme stores totals, which stay from step to step, are put in order with the
    particles, and are part of checkpoints.
    """

    def evaluate(self, time: float) -> None:
        """Compute all rates f(time, y) of the present state."""

    def hold(self) -> None:
        """Store the present state as the start y0 of the step and set the total to zero."""

    def advance(self, interval: float) -> None:
        """y = y0 + interval * f."""

    def accumulate(self, weight: float) -> None:
        """total = total + weight * f."""

    def advance_total(self, interval: float) -> None:
        """y = y0 + interval * total."""

    def store(self, place: int, time: float) -> None:
        """Store the total at ``place``, 0 to ``memory - 1`` of the integrator, as that of ``time``, s."""

    def stored_time(self, place: int) -> float | None:
        """Return the time of the total stored at ``place``, s; None before the first."""

    def accumulate_stored(self, place: int, weight: float) -> None:
        """total = total + weight * (the total stored at ``place``)."""

    def evaluate_density(self, time: float) -> None:
        """Compute the density rates of the present state, with the density gradient of the last acceleration."""

    def evaluate_acceleration(self, time: float) -> None:
        """Compute the accelerations of the present state."""

    def drift(self, interval: float) -> None:
        """x = x + interval * u."""

    def kick(self, interval: float) -> None:
        """u = u + interval * acceleration, with the accelerations last computed."""

    def update_density(self, interval: float) -> None:
        """rho = rho + interval * density rate, with the density rates last computed."""


class Integrator(ABC):
    """Advances a :class:`System` by one time step."""

    order: ClassVar[int]
    """order of convergence in the time step"""
    evaluations: ClassVar[int]
    """evaluations of the rates per step"""
    stability_limit: ClassVar[float]
    """largest stable c0 dt / h of the linearised scheme on a lattice"""
    courant_number: ClassVar[float]
    """recommended ``(c0 + |u|max) dt / h``"""
    memory: ClassVar[int] = 0
    """number of totals that are stored from step to step; an integrator keeps no state of its own"""

    @abstractmethod
    def step(self, system: System, time: float, time_step: float) -> None:
        """Advance ``system`` from ``time`` to ``time + time_step`` (seconds).

        The system still has the accelerations computed last in the previous step (in the first step, those of the
        initial state).
        """
