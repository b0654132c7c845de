"""Interfaces: how the state is advanced in time."""

from abc import ABC, abstractmethod
from typing import ClassVar, Protocol

__all__ = ["Integrator", "System"]


class System(Protocol):
    """An ordinary differential equation dy/dt = f(t, y), as an integrator sees it.

    The state y holds positions, velocities and (for a fluid) densities; f holds velocities, accelerations and density
    rates. The system owns all arrays: an integrator says which combination comes next and never touches them.
    """

    def hold(self) -> None:
        """Remember the present state as the start y0 of the step."""

    def evaluate(self, time: float) -> None:
        """Compute the rates f(time, y) of the present state."""

    def advance(self, interval: float) -> None:
        """y = y0 + interval * f."""

    def accumulate(self, weight: float) -> None:
        """total = total + weight * f; :meth:`hold` clears the total."""

    def advance_total(self, interval: float) -> None:
        """y = y0 + interval * total."""

    def centre_positions(self, interval: float) -> None:
        """x = x0 + interval * (u0 + u) / 2, with the present velocity u."""


class Integrator(ABC):
    """Advances a :class:`System` by one time step through the stages it asks for."""

    order: ClassVar[int]
    """order of convergence in the time step"""
    evaluations: ClassVar[int]
    """evaluations of the rates per step"""
    stability_limit: ClassVar[float]
    """largest stable c0 dt / h of the linearised scheme on a lattice"""
    courant_number: ClassVar[float]
    """recommended (c0 + |u|max) dt / h"""

    @abstractmethod
    def step(self, system: System, time: float, time_step: float) -> None:
        """Advance ``system`` from ``time`` to ``time + time_step`` (seconds)."""
