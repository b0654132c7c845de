"""Integrators: symplectic predictor-corrector."""

from typing import ClassVar, final

from sphframe.interfaces import Integrator, System

__all__ = ["SymplecticPredictorCorrector"]


@final
class SymplecticPredictorCorrector(Integrator):
    """Position-Verlet form with a half-step predictor, second order; two evaluations a step.

    ::

        y*    = y0 + dt/2 f(t, y0)
        u1    = u0 + dt a(t + dt/2, y*),    rho1 = rho0 + dt R(t + dt/2, y*)
        x1    = x0 + dt (u0 + u1)/2

    Source: J. J. Monaghan (2005), doi:10.1088/0034-4885/68/8/R01; B. Leimkuhler and C. Matthews (2015),
    doi:10.1007/978-3-319-16375-8.
    """

    order: ClassVar[int] = 2
    evaluations: ClassVar[int] = 2
    stability_limit: ClassVar[float] = 2.33
    courant_number: ClassVar[float] = 1.0

    def step(self, system: System, time: float, time_step: float) -> None:
        """Advance one step."""
        system.hold()
        system.evaluate(time)
        system.advance(0.5 * time_step)
        system.evaluate(time + 0.5 * time_step)
        system.advance(time_step)
        system.centre_positions(time_step)
