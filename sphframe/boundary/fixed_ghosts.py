"""Boundary: fixed ghost particles, the treatment of walls by which interpolation methods are compared.

With the means over the fluid that the method gives for its evaluation point r, the mirror point x_M or the ghost
itself, and the driving force b = rho0 (f - a_wall) of the pressure condition dp/dn = b.n the ghost is assigned::

    balanced lift   p_G = sum_j Phi_j [p_j + b.(x_G - x_j)]
    mirror lift     p_G = sum_j Phi_j p_j + b.(x_G - x_M)
    velocity        u_G = u_wall + [(1 - s)/2 + (1 + s)/2 S] (sum_j Phi_j u_j - u_wall)

S is the reflection of the wall for free slip and -1 for no slip: it keeps some components of the relative velocity
and reverses the others, which vanish at the wall. With the balanced lift and ``ghost_velocity = "corrected"`` the
reversed components are scaled by s = d / sum_j Phi_j d_j, where d is the distance from the wall along its normal at the
foot of the ghost. This is exact for a velocity that grows linearly from the wall, for any weights that sum to one. In
all other cases, and where the method evaluates at the ghost, s = 1; for the correction with the mirror lift see
:mod:`sphframe.boundary.conjugate`. For a dry point p_G = 0, u_G = u_wall.

Weights at the ghost that reproduce linear fields continue the velocity through the wall. This value must not be
reversed once more, and it says nothing about the wall. Velocities are then means with the kernel average.

With no slip and ``continuity = "free-slip"`` S is that of free slip, and the velocity for the viscosity is apart::

    u_G = u_wall - s (sum_j Phi_j u_j - u_wall)

Both continuations are smooth where the boundary layer is resolved. Where it is not, beside a body that starts or at a
sharp edge, the particles next to the wall slip along it; the continuity then takes the reversed velocity of the ghosts
for an outflow or inflow along the wall, and the pressure near the wall is wrong.

Reason for s: weights of zeroth order sample the fluid at a larger distance from the wall than that of the mirror point.
Without s the normal velocity of the ghosts is too large, the divergence at the wall is wrong, and the pressure of the
first layer drifts (in the tank at rest with the normalised method by 1.5 % of rho g H).

Departs from the paper: its pressure condition lacks the acceleration of the wall. The balanced lift, which is exact on
a hydrostatic field for any weights that sum to one, and s are additions. With the default ``tension = "bounded"``
negative pressures are clipped, because they draw particles of thin jets through the wall (dam break at H/30: three
particles; with the clipping none). A method that evaluates at the ghost always uses the balanced lift, since the mirror
lift over a distance of zero is zero; a method that extrapolates uses none.

Source: X. Huang et al. (2019), doi:10.3390/w11051110, section 2.2 and Eqs. 8, 13, 16, 21; two velocities with no slip
after M. De Leffe, D. Le Touze, B. Alessandrini (2011), 6th international SPHERIC workshop.
"""

from dataclasses import dataclass, replace
from typing import Any, Literal, final

from sphframe.arrays import Array
from sphframe.interfaces import (
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
from sphframe.interfaces.boundary_interpolator import kernel_average

_ORDERS = Orders(
    pressure=Order(2, 0), viscosity=Order(0, 0), shear=Order(2, 2), slip_divergence=Order(2, 0),
    slip_viscosity=Order(0, -1),
)  # fmt: skip


@final
@dataclass(frozen=True)
class FixedGhosts(WallTreatment):
    """Ghosts behind the wall, to which the case's interpolator interpolates the fluid.

    Attributes
    ----------
    continuity
        with no slip, the velocity of ghosts in the continuity: all components are reversed (``"no-slip"``), or only the
        normal one (``"free-slip"``). The viscosity always takes the former.
    """

    continuity: Literal["no-slip", "free-slip"] = "no-slip"

    @property
    def traits(self) -> WallTraits:
        """Those of the chosen continuity: free slip promises no order of the divergence but on a lattice."""
        divergence = Order(1, 1 if self.continuity == "no-slip" else None)
        return WallTraits(exact_constant=True, exact_hydrostatic=True, order=replace(_ORDERS, divergence=divergence))

    def interpolator(self, chosen: BoundaryInterpolator) -> BoundaryInterpolator:
        """Return the method that the case chose."""
        return chosen

    def velocity_interpolator(self, chosen: BoundaryInterpolator) -> BoundaryInterpolator | None:
        """Return the kernel average for a method that extrapolates linear fields to the ghost."""
        linear = chosen.traits.evaluation_point.at_ghost and chosen.traits.reproduces_degree > 0
        return _KernelAverage() if linear else None

    def parts(self, context: WallContext) -> WallParts:
        """Return the assignment above."""
        assert context.interpolator is not None
        dim, point = context.dim, context.interpolator.traits.evaluation_point
        balanced = context.balanced_lift or point.at_ghost
        apart = context.no_slip and self.continuity == "free-slip"
        scaled = context.balanced_lift and context.corrected_velocity and not point.at_ghost

        def assign(
            fluid: Interpolated, wall: WallPoint, constants: Any, velocity: Array, viscous_velocity: Array
        ) -> tuple[float, float]:
            pressure = fluid.pressure
            if not fluid.extrapolated:
                if balanced:
                    for d in range(dim):
                        pressure += wall.force[d] * (fluid.total * wall.lift[d] - fluid.offset[d])
                elif fluid.neighbours > 0:
                    for d in range(dim):
                        pressure += wall.force[d] * wall.lift[d]

            slope = 1.0  # s of the module's docstring; d_j is the height of r less (x_j - r).n
            if scaled and fluid.neighbours > 0:
                distance = fluid.total * wall.height
                for d in range(dim):
                    distance -= fluid.offset[d] * wall.normal[d]
                slope = wall.distance / max(distance, 0.5 * wall.height)
            for d in range(dim):
                velocity[d] = wall.velocity[d]
                if apart:
                    opposed = slope if fluid.neighbours > 0 else 0.0
                    viscous_velocity[d] = wall.velocity[d] - opposed * (fluid.velocity[d] - wall.velocity[d])
            for e in range(dim if fluid.neighbours > 0 else 0):
                relative = fluid.velocity[e] - wall.velocity[e]
                velocity[e] += 0.5 * (1.0 - slope) * relative
                for d in range(dim):
                    velocity[d] += 0.5 * (1.0 + slope) * wall.reflection[d, e] * relative
            return pressure, 1.0

        conjugate = context.corrected_velocity and not context.balanced_lift and point is EvaluationPoint.MIRROR
        return WallParts(assign=assign, conjugate=conjugate, own_viscous_velocity=apart)


@final
class _KernelAverage(BoundaryInterpolator):
    """The average at the ghost itself, for velocities."""

    traits = Traits(non_negative=True, range_restricted=True, evaluation_point=EvaluationPoint.GHOST)

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the kernel average."""
        return kernel_average
