"""The wall boundary condition of Adami et al. (2012) for sphframe."""

from dataclasses import dataclass
from typing import Any

from sphframe import (
    OK,
    TOO_FEW,
    BoundaryInterpolator,
    CompiledKernel,
    EvaluationPoint,
    Interpolated,
    Order,
    Orders,
    Traits,
    WallContext,
    WallParts,
    WallPoint,
    WallTraits,
    WallTreatment,
    WeightsFunction,
)

__all__ = ["Adami", "AdamiWalls"]


_AT_GHOST = Orders(
    pressure=Order(1, 1), divergence=Order(1, 0), viscosity=Order(-1, -2), shear=Order(1, None),
    slip_divergence=Order(0, 0), slip_viscosity=Order(-1, -1),
)  # fmt: skip
_WALLS = Orders(
    pressure=Order(1, 1), divergence=Order(1, 1), viscosity=Order(-1, -2), shear=Order(1, None),
    slip_divergence=Order(0, 0), slip_viscosity=Order(-1, -1),
)  # fmt: skip


@dataclass(frozen=True)
class Adami(BoundaryInterpolator):
    """Normalised kernel weights, evaluated at the ghost particle (Eqs. 22, 23 and 27 of Adami et al. 2012).

    With W_j the kernel at the distance of particle j from the ghost::

        Phi_j = W_j / sum_k W_k V_k * V_j

    The ``balanced`` lift of sphframe is the hydrostatic term of their Eq. 27.

    Departs from the paper: W_j is multiplied by the volume V_j. Their Eq. 27 omits it, as all of their particles have
    the same size. The status is TOO_FEW where all W_j V_j are zero in floating point; the fallback is the value of the
    nearest particle.

    Source: Adami, Hu & Adams (2012), doi:10.1016/j.jcp.2012.05.005.
    """

    traits = Traits(non_negative=True, range_restricted=True, evaluation_point=EvaluationPoint.GHOST, order=_AT_GHOST)

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the weights function; it uses only the kernel values and the volumes."""

        def weights(offsets, distances, kernel_values, volumes, support, lift, out):  # type: ignore[no-untyped-def]
            n = distances.shape[0]
            total = 0.0
            for j in range(n):
                out[j] = kernel_values[j] * volumes[j]
                total += out[j]
            if total <= 0.0:
                return TOO_FEW
            for j in range(n):
                out[j] /= total
            return OK

        return weights


@dataclass(frozen=True)
class AdamiWalls(WallTreatment):
    """Wall particles of Adami et al. (2012), with their own two velocities.

    With the weights of :class:`Adami` at the wall particle G::

        p_G   = sum_j Phi_j [p_j + b.(x_G - x_j)]
        u_G^c = u_w                          in the continuity
        u_G^v = 2 u_w - sum_j Phi_j u_j      in the viscosity; with free slip the viscosity sees no wall

    Departs from the paper as :class:`Adami` does.

    Known failures: u_G^c = u_w lets the first layer drift towards the wall, since the divergence of a flow towards the
    wall is only 0.7 of the right one there; shear is nearly, not exactly, continued.

    Source: Adami, Hu & Adams (2012), doi:10.1016/j.jcp.2012.05.005, Eqs. 22 to 27.
    """

    traits = WallTraits(exact_constant=True, exact_hydrostatic=True, order=_WALLS)

    def interpolator(self, chosen: BoundaryInterpolator) -> BoundaryInterpolator:
        """Return the kernel average at the ghost."""
        return Adami()

    def parts(self, context: WallContext) -> WallParts:
        """Return the assignment."""
        dim = context.dim

        def assign(
            fluid: Interpolated, wall: WallPoint, constants: Any, velocity: Any, viscous_velocity: Any
        ) -> tuple[float, float]:
            pressure = fluid.pressure
            for d in range(dim):
                pressure -= wall.force[d] * fluid.offset[d]
                velocity[d] = wall.velocity[d]
                viscous_velocity[d] = wall.velocity[d]
                if fluid.neighbours > 0:
                    viscous_velocity[d] += wall.velocity[d] - fluid.velocity[d]
            return pressure, 1.0

        return WallParts(assign=assign, own_viscous_velocity=True, friction=context.no_slip)
