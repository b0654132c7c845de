"""The walls of the modified dynamic boundary condition with the velocities of its authors, 2022 and 2025."""

from dataclasses import dataclass, replace
from typing import Any, Literal

from sphframe import (
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
from sphframe_mdbc import MDBC

_WALLS = Orders(
    pressure=Order(1, 1), divergence=Order(1, 1), viscosity=Order(-1, -1), shear=Order(1, 1),
    slip_divergence=Order(0, 0), slip_viscosity=Order(-1, -1),
)  # fmt: skip
_PUBLISHED = Orders(
    pressure=Order(1, 1), divergence=Order(1, 1), viscosity=Order(-1, -2), shear=Order(1, None),
    slip_divergence=Order(0, 0), slip_viscosity=Order(-1, -1),
)  # fmt: skip
_CORRECTED = Orders(
    pressure=Order(1, 1), divergence=Order(1, 1), viscosity=Order(0, 0, 0.4741), shear=Order(2, 2),
    slip_divergence=Order(0, 0), slip_viscosity=Order(-1, -1, 3.381),
)  # fmt: skip


class AtMirror(MDBC):
    """The first-order consistent value at the mirror point, without extrapolation."""

    traits = replace(MDBC.traits, evaluation_point=EvaluationPoint.MIRROR, order=Orders())


@dataclass(frozen=True)
class KernelAverage(BoundaryInterpolator):
    """Phi_j = W_j V_j / sum_k W_k V_k at the mirror point."""

    traits = Traits(non_negative=True, range_restricted=True)

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the weights function, which every method has as its fallback."""
        return self.fallback_weights(kernel, dim)


@dataclass(frozen=True)
class MDBC2022(WallTreatment):
    """Pressure extrapolated from the mirror point m by its first-order gradient; velocity of the wall.

    ::

        p_G = f_m + grad f_m.(x_G - m),    u_G = u_w

    with [f_m, grad f_m] of :class:`MDBC`. Where these do not exist, the kernel average is lifted by b.

    Departs from the paper as :class:`MDBC` does. The interpolator ``mdbc`` with fixed ghosts has the same pressure, but
    reflected velocities.

    Known failures: the gradient amplifies noise at impact; u_G = u_w gives no second-order shear.

    Source: English et al. (2022), doi:10.1007/s40571-021-00403-3.

    Attributes
    ----------
    amplification
        largest sum of absolute weights; above it the kernel average is used.
    """

    amplification: float = 10.0
    """largest accepted sum |Phi_j|, the factor by which noise may be amplified"""

    def __post_init__(self) -> None:
        MDBC(self.amplification)  # refuses what is not possible

    traits = WallTraits(exact_constant=True, exact_hydrostatic=True, order=_WALLS)

    def interpolator(self, chosen: BoundaryInterpolator) -> BoundaryInterpolator:
        """Return the extrapolating weights."""
        return MDBC(self.amplification)

    def parts(self, context: WallContext) -> WallParts:
        """Return the assignment."""
        dim = context.dim

        def assign(
            fluid: Interpolated, wall: WallPoint, constants: Any, velocity: Any, viscous_velocity: Any
        ) -> tuple[float, float]:
            pressure = fluid.pressure
            for d in range(dim):
                velocity[d] = wall.velocity[d]
                if not fluid.extrapolated:
                    pressure += wall.force[d] * (fluid.total * wall.lift[d] - fluid.offset[d])
            return pressure, 1.0

        return WallParts(assign=assign, uses_velocity=False, friction=context.no_slip)


@dataclass(frozen=True)
class MDBC2025(WallTreatment):
    """Pressure of the mirror point m plus the lift along the normal n; with no slip, a reversed tangential velocity.

    ::

        p_G   = p_m + (b.n) (x_G - m).n              p_m with the first-order weights of :class:`MDBC`
        u_G^c = u_w
        u_G^v = (u_w.n) n + [2 u_w - u_m]_t          no slip
        u_G^v = (u_w.n) n + [u_m]_t                  free slip

    u_m is the kernel average at m; with ``velocity = "corrected"`` it has the weights of p_m, which makes the rule
    exact for a linear shear flow. A wall particle without fluid at m does not count.

    Departs from the code of its authors (DualSPHysics 5.4). There u_G^v leaves out the normal velocity of the wall, so
    that a paddle drags the fluid that moves with it; thresholds of the determinant have a unit; and velocities of
    particles near the wall are corrected (sphframe puts particles behind a wall back on it).

    Known failure: the average u_m is that of a point further from the wall, so that the published rule reverses too
    much and is first order in the spacing.

    Source: English et al. (2025), doi:10.1016/j.compfluid.2025.106870, as read from the code.

    Attributes
    ----------
    velocity
        weights of u_m: the kernel average, or those of p_m.
    """

    velocity: Literal["published", "corrected"] = "published"
    """"published" (kernel average) or "corrected" (first-order weights)"""

    def __post_init__(self) -> None:
        if self.velocity not in ("published", "corrected"):
            raise ValueError(f'velocity must be "published" or "corrected", got {self.velocity!r}')

    @property
    def traits(self) -> WallTraits:
        """Shear is exact with the corrected velocity."""
        exact = self.velocity == "corrected"
        order = _CORRECTED if exact else _PUBLISHED
        return WallTraits(exact_constant=True, exact_hydrostatic=True, exact_shear=exact, order=order)

    def interpolator(self, chosen: BoundaryInterpolator) -> BoundaryInterpolator:
        """Return the first-order weights at the mirror point."""
        return AtMirror()

    def velocity_interpolator(self, chosen: BoundaryInterpolator) -> BoundaryInterpolator | None:
        """Return the kernel average of the published rule."""
        return None if self.velocity == "corrected" else KernelAverage()

    def parts(self, context: WallContext) -> WallParts:
        """Return the assignment."""
        dim, sign, walls = context.dim, -1.0 if context.no_slip else 1.0, 2.0 if context.no_slip else 0.0

        def assign(
            fluid: Interpolated, wall: WallPoint, constants: Any, velocity: Any, viscous_velocity: Any
        ) -> tuple[float, float]:
            force = 0.0
            along = 0.0
            normal = 0.0
            for d in range(dim):
                velocity[d] = wall.velocity[d]
                force += wall.force[d] * wall.normal[d]
                along += wall.lift[d] * wall.normal[d]
                viscous_velocity[d] = walls * wall.velocity[d] + sign * fluid.velocity[d]
                normal += (wall.velocity[d] - viscous_velocity[d]) * wall.normal[d]
            for d in range(dim):
                viscous_velocity[d] += normal * wall.normal[d]
            if fluid.neighbours == 0:
                return 0.0, 0.0
            return fluid.pressure + force * along, 1.0

        return WallParts(assign=assign, own_viscous_velocity=True)
