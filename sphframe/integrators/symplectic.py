"""Integrators: a symplectic predictor-corrector scheme."""

from typing import ClassVar, final

from sphframe.interfaces import Integrator, System


@final
class Symplectic(Integrator):
    """Stormer-Verlet in kick-drift-kick form, second order; one evaluation of each rate per step.

    The velocity is predicted at the half step, positions and densities are advanced over the whole step with it, and
    the velocity is corrected by the new acceleration::

        u*   = u0 + dt/2 a0,    x* = x0 + dt/2 u*
        rho1 = rho0 + dt R(x*, u*, rho0),    x1 = x0 + dt u*
        u1   = u* + dt/2 a(x1, rho1, u*)

    Velocity and density are advanced alternately, so that an undamped acoustic oscillation of frequency omega keeps its
    amplitude up to omega dt = 2. (To advance both together at the half step, as many predictor-correctors do, amplifies
    it by (omega dt)^4/8 per step and needs dissipation.) Viscous terms use the velocity at the half step, and the
    density diffusion uses the renormalised density gradient at x0, which is computed together with the acceleration.

    Source: L. Verlet (1967), doi:10.1103/PhysRev.159.98; in SPH S. Adami, X. Y. Hu, N. A. Adams (2012),
    doi:10.1016/j.jcp.2012.05.005.
    """

    order: ClassVar[int] = 2
    evaluations: ClassVar[int] = 1
    stability_limit: ClassVar[float] = 2.33
    courant_number: ClassVar[float] = 0.7

    def step(self, system: System, time: float, time_step: float) -> None:
        """Advance one step."""
        system.kick(0.5 * time_step)
        system.drift(0.5 * time_step)
        system.evaluate_density(time + 0.5 * time_step)
        system.update_density(time_step)
        system.drift(0.5 * time_step)
        system.evaluate_acceleration(time + time_step)
        system.kick(0.5 * time_step)
