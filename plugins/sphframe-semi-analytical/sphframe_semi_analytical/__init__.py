"""Unified semi-analytical walls, Ferrand et al. (2013), for sphframe."""

from dataclasses import dataclass
from typing import Any

from sphframe import (
    OK,
    TOO_FEW,
    Array,
    BoundaryInterpolator,
    CompiledKernel,
    Edge,
    EvaluationPoint,
    FluidSide,
    Interpolated,
    Order,
    Orders,
    Traits,
    WallContext,
    WallGeometry,
    WallParts,
    WallPoint,
    WallSide,
    WallTraits,
    WallTreatment,
    WeightsFunction,
)

__all__ = ["AverageOnWall", "SemiAnalytical"]

_NEAREST = 0.1
"""least distance of a fluid particle from the wall in the viscous force, in particle spacings"""
_ORDERS = Orders(
    pressure=Order(-1, -1, 2.212), divergence=Order(1, 0), viscosity=Order(-1, -1, 1.899), shear=Order(1, None),
    slip_divergence=Order(0, 0, 0.01005), slip_viscosity=Order(-1, -1),
)  # fmt: skip


@dataclass(frozen=True)
class AverageOnWall(BoundaryInterpolator):
    """The normalised kernel average at the middle of a segment of the wall: Phi_j = W_j V_j / sum_k W_k V_k."""

    traits = Traits(non_negative=True, range_restricted=True, evaluation_point=EvaluationPoint.GHOST)

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the weights function."""

        def weights(offsets, distances, kernel_values, volumes, support, lift, out):  # type: ignore[no-untyped-def]
            total = 0.0
            for j in range(distances.shape[0]):
                out[j] = kernel_values[j] * volumes[j]
                total += out[j]
            if total <= 0.0:
                return TOO_FEW
            for j in range(distances.shape[0]):
                out[j] /= total
            return OK

        return weights


@dataclass(frozen=True)
class SemiAnalytical(WallTreatment):
    """Segments s of the wall have pressure and velocity; all sums are divided by gamma, the fluid's part of the kernel.

    With the integrals of :class:`sphframe.Edge`, grad gamma_s = -n_s weight_s and gamma_i = 1 - sum_s solid_s, the
    normalised kernel Phi at the middle of the segment and b = rho0 (f - a_w)::

        drho_i/dt    = -(rho_i/gamma_i) [sum_j (u_j - u_i).grad W V_j - sum_s (u_w - u_i).grad gamma_s]
        rho_i Du/Dt  = -(1/gamma_i) [sum_j (p_i + p_j) grad W V_j - sum_s (p_i + p_s) grad gamma_s] + rho_i f
        p_s          = sum_j Phi_j [p_j + b.(x_s - x_j)]
        no slip:       -(1/gamma_i) sum_s 2 mu |grad gamma_s| (u_i - u_w)_t/z_s

    mu is the viscosity of shear flow: 1/8 of the factor of the artificial one, and the laminar one. Density diffusion
    and viscosity of the fluid are divided by gamma, too. In two dimensions; curved walls are polygons.

    Departs from the paper: there are no vertex particles on the wall, and the first particles of the fluid are half a
    spacing away from it. gamma is a closed integral for each position; the paper advances it in time. GPUSPH has at
    least one spacing for z_s, which halves the shear here: z_s is at least a tenth of a spacing. gamma is at least
    0.05 where it divides.

    Known failures: fluid particles do not conserve momentum among themselves where their gammas differ. Under a uniform
    pressure p the first layer is pushed by 0.020 times 2 p/(rho dx) to the wall (Gaussian; 0.013 for Wendland C2) until
    the particles have left the lattice. In a tank at rest with 15 particles over the depth the first layer settles by
    0.06 spacings; its divergence is not exact (0.97 of the right one) and not conjugate to the pressure, so that a
    vertical sound wave of 12 % of rho g H at the bed starts, with the period 4 H/c0, which is hardly damped within 1 s.
    Means over time are within 3 % of rho g H. gamma vanishes in narrow wedges.

    Source: M. Ferrand, D. R. Laurence, B. D. Rogers, D. Violeau, C. Kassiotis (2013), doi:10.1002/fld.3666.
    """

    traits = WallTraits(momentum=False, dimensions=(2,), order=_ORDERS)
    geometry = WallGeometry.ROW

    def interpolator(self, chosen: BoundaryInterpolator) -> BoundaryInterpolator:
        """Return the kernel average on the wall."""
        return AverageOnWall()

    def parts(self, context: WallContext) -> WallParts:
        """Return the pressure of a segment, and the integrals over it."""
        dim, friction, nearest = context.dim, float(context.no_slip), _NEAREST

        def assign(
            fluid: Interpolated, wall: WallPoint, constants: Any, velocity: Array, viscous_velocity: Array
        ) -> tuple[float, float]:
            pressure = fluid.pressure
            for d in range(dim):
                pressure -= wall.force[d] * fluid.offset[d]
                velocity[d] = wall.velocity[d]
            return pressure, 1.0

        def surface(fluid: FluidSide, wall: WallSide, edge: Edge, constants: Any) -> tuple[float, float, float]:
            u, v = fluid.u - wall.wall_u, fluid.v - wall.wall_v
            across = u * wall.nx + v * wall.ny
            push = (fluid.pressure + wall.pressure) * edge.weight
            twice_mu = 0.25 * constants.viscosity + constants.friction
            rub = friction * twice_mu * edge.weight / max(edge.z, nearest * constants.spacing)
            fx = -push * wall.nx - rub * (u - across * wall.nx)
            fy = -push * wall.ny - rub * (v - across * wall.ny)
            return fx, fy, -across * edge.weight

        return WallParts(assign=assign, surface=surface, divides_by_gamma=True)
