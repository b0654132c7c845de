"""Integrators: the classical fourth-order Runge-Kutta scheme."""

from typing import ClassVar, final

from sphframe.interfaces import Integrator, System


@final
class RungeKutta4(Integrator):
    """k1 = f(t, y0), k2 = f(t + dt/2, y0 + dt/2 k1), k3 = f(t + dt/2, y0 + dt/2 k2), k4 = f(t + dt, y0 + dt k3),
    y1 = y0 + dt/6 (k1 + 2 k2 + 2 k3 + k4); four evaluations per step.

    Source: E. Hairer, S. P. Norsett, G. Wanner (1993), doi:10.1007/978-3-540-78862-1.
    """

    order: ClassVar[int] = 4
    evaluations: ClassVar[int] = 4
    stability_limit: ClassVar[float] = 3.29
    courant_number: ClassVar[float] = 1.5

    def step(self, system: System, time: float, time_step: float) -> None:
        """Advance one step."""
        system.hold()
        system.evaluate(time)
        for weight, part in ((1.0 / 6.0, 0.5), (1.0 / 3.0, 0.5), (1.0 / 3.0, 1.0)):
            system.accumulate(weight)
            system.advance(part * time_step)
            system.evaluate(time + part * time_step)
        system.accumulate(1.0 / 6.0)
        system.advance_total(time_step)
