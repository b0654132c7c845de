"""The wall pressure of Band et al. (2018), extrapolated by moving least squares, for sphframe."""

from dataclasses import dataclass, replace
from typing import Any

from sphframe_mls import LinearMLS

from sphframe import (
    BoundaryInterpolator,
    EvaluationPoint,
    Interpolated,
    Order,
    Orders,
    WallContext,
    WallParts,
    WallPoint,
    WallTraits,
    WallTreatment,
)

__all__ = ["Band", "LinearAtGhost"]


_WALLS = Orders(
    pressure=Order(1, 1), divergence=Order(1, 1), viscosity=Order(-1, -1), shear=Order(1, 1),
    slip_divergence=Order(0, 0), slip_viscosity=Order(-1, -1),
)  # fmt: skip


class LinearAtGhost(LinearMLS):
    """Linear moving least squares, evaluated at the ghost instead of the mirror point."""

    traits = replace(LinearMLS.traits, evaluation_point=EvaluationPoint.GHOST, order=Orders())


@dataclass(frozen=True)
class Band(WallTreatment):
    """Pressure of the wall particle by a linear least-squares fit to the fluid around it; velocity of the wall.

    ::

        xbar = sum V_j W_j x_j / sum V_j W_j,    pbar alike
        g    = [sum V W (x - xbar)(x - xbar)^T]^-1 sum V W (x - xbar) p
        p_G  = pbar + g.(x_G - xbar),            u_G = u_w

    No normal is needed. Where the fit is singular the kernel average is used, lifted by b. With the default tension
    "bounded" negative pressures are clipped, as by its authors.

    Departs from the paper: its two layers of wall particles fill the support there; here, outer layers see few
    particles, or such on a line, and fall back.

    Source: S. Band, C. Gissler, A. Peer, M. Teschner (2018), doi:10.1016/j.cag.2018.08.001.
    """

    traits = WallTraits(exact_constant=True, exact_hydrostatic=True, order=_WALLS)

    def interpolator(self, chosen: BoundaryInterpolator) -> BoundaryInterpolator:
        """Return moving least squares at the ghost."""
        return LinearAtGhost()

    def parts(self, context: WallContext) -> WallParts:
        """Return the assignment."""
        dim = context.dim

        def assign(
            fluid: Interpolated, wall: WallPoint, constants: Any, velocity: Any, viscous_velocity: Any
        ) -> tuple[float, float]:
            pressure = fluid.pressure
            for d in range(dim):
                velocity[d] = wall.velocity[d]
                pressure -= wall.force[d] * fluid.offset[d]  # zero but for the fallback
            return pressure, 1.0

        return WallParts(assign=assign, friction=context.no_slip)
