"""Dynamic boundaries, Crespo, Gomez-Gesteira & Dalrymple (2007), with and without diffusion, for sphframe."""

from dataclasses import dataclass
from typing import Any

from sphframe import (
    Array,
    Interpolated,
    Neighbours,
    Order,
    Orders,
    WallContext,
    WallParts,
    WallPoint,
    WallTraits,
    WallTreatment,
)

__all__ = ["Dynamic"]


_ORDERS = Orders(
    pressure=Order(-1, -1, 2.937e-5), divergence=Order(1, 1), viscosity=Order(-1, -1), shear=Order(1, 1),
    slip_divergence=Order(0, 0), slip_viscosity=Order(-2, -2),
)  # fmt: skip


@dataclass(frozen=True)
class Dynamic(WallTreatment):
    """Wall particles G have a density of their own, which follows from the continuity equation over the fluid.

    With the velocity of the wall, b = rho0 (f - a_w) and x = x_j - x_G::

        drho_G/dt = -rho_G sum_j (u_j - u_w).grad_G W V_j + delta h c0 sum_j psi_Gj.grad_G W V_j,    rho_G >= rho0
        psi_Gj = 2 (rho_j - rho_G - b.x/c0^2) x/|x|^2
        p_G = p(rho_G),    V_G = m/rho_G,    u_G = u_w, also with free slip

    With delta = 0, the published method, the density only remembers what has moved: it starts in hydrostatic
    equilibrium. With delta > 0 it relaxes to that of the fluid, lifted to the wall particle, and forgets its start.

    Departs from the paper: the layers of wall particles fill the support; two staggered rows in the paper. The limit
    rho_G >= rho0 is that of code: there the density does not fall any further. The fluid's own density diffusion sums
    over the fluid alone. The diffusive term is an addition, of the form of G. Fourtakas et al. (2019),
    doi:10.1016/j.compfluid.2019.06.009.

    Known failures: a gap of about h between fluid and wall, and an overpressure at impacts; particles stick to a wall
    that moves away, since its density remembers the pressure (GPUSPH, issue 27: "known issue with their formulation");
    leakage (DualSPHysics, issue 221).

    Source: A. J. C. Crespo, M. Gomez-Gesteira, R. A. Dalrymple (2007), doi:10.3970/cmc.2007.005.173.

    Attributes
    ----------
    diffusion
        delta, coefficient of the density diffusion between wall and fluid.
    """

    diffusion: float = 0.0
    """delta of the wall particles, 1; 0.1 is usual in the fluid"""

    traits = WallTraits(order=_ORDERS)

    def __post_init__(self) -> None:
        if not self.diffusion >= 0.0:
            raise ValueError(f"diffusion must be 0 or a positive number, got {self.diffusion!r}")

    def parts(self, context: WallContext) -> WallParts:
        """Return the rate of the density, and the assignment of the pressure."""
        dim, diffusion, equation_of_state = context.dim, self.diffusion, context.pressure

        def rate(near: Neighbours, wall: WallPoint, constants: Any) -> float:
            compression = 0.0
            diffused = 0.0
            c0 = constants.sound_speed
            for j in range(near.distances.shape[0]):
                weight = near.slopes[j] * near.volumes[j]  # grad_G W V_j = -weight x
                excess = near.densities[j] - wall.state
                for d in range(dim):
                    compression += weight * (near.velocities[j, d] - wall.velocity[d]) * near.offsets[j, d]
                    excess -= wall.force[d] * near.offsets[j, d] / (c0 * c0)
                diffused -= 2.0 * weight * excess
            found = wall.state * compression + diffusion * constants.smoothing_length * c0 * diffused
            return found if wall.state > constants.reference_density else max(found, 0.0)

        def assign(
            fluid: Interpolated, wall: WallPoint, constants: Any, velocity: Array, viscous_velocity: Array
        ) -> tuple[float, float]:
            for d in range(dim):
                velocity[d] = wall.velocity[d]
            rho0 = constants.reference_density
            density = max(wall.state, rho0)
            return equation_of_state(density, rho0, constants.sound_speed), rho0 / density

        return WallParts(rate=rate, assign=assign)
