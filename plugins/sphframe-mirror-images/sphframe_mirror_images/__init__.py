"""Mirror images of the fluid in walls, Colagrossi & Landrini (2003), for sphframe."""

from dataclasses import dataclass
from typing import Any

from sphframe import (
    Array,
    Interpolated,
    Order,
    Orders,
    WallContext,
    WallGeometry,
    WallParts,
    WallPoint,
    WallTraits,
    WallTreatment,
)

__all__ = ["MirrorImages"]


_ORDERS = Orders(
    pressure=Order(2, -1), divergence=Order(1, 0), viscosity=Order(0, -1), shear=Order(2, None),
    slip_divergence=Order(2, 0), slip_viscosity=Order(0, -1),
)  # fmt: skip


@dataclass(frozen=True)
class MirrorImages(WallTreatment):
    """Every fluid particle j near a wall has an image behind it, as far from the wall as the particle is.

    With the nearest point m of the wall, its normal n out of the fluid and d = (m - x_j).n::

        x_G = x_j + 2 d n,    V_G = V_j,    p_G = p_j + b.(x_G - x_j)
        u_G = u_w + S (u_j - u_w)     free slip, S = 1 - 2 n n^T
        u_G = 2 u_w - u_j             no slip

    In corners at right angles there are images of images, with the product of the reflections for S. Nothing is
    interpolated, and there are no ghosts: the fluid continues through the wall as in a mirror. Beside straight walls
    sums near the wall are those of the doubled cloud of particles; with free slip and without gravity, walls at rest
    do no work.

    Departs from the paper: the pressure is lifted by the balance of forces at the wall, which may be accelerated.

    Known failures: behind curved walls images crowd or thin out, since they keep their volumes; in corners that are
    not right angles they overlap or leave gaps, and edges that the fluid flows around have no images beyond them.
    u_w and b are those at the foot of the ghost next to m, up to 0.8 spacings away, which differ where a wall turns.

    Source: A. Colagrossi, M. Landrini (2003), doi:10.1016/S0021-9991(03)00324-3.
    """

    traits = WallTraits(
        exact_constant=True, exact_hydrostatic=True, exact_shear=True, exact_normal=True, conjugate=True, order=_ORDERS
    )
    geometry = WallGeometry.IMAGES

    def parts(self, context: WallContext) -> WallParts:
        """Return what an image is assigned."""
        dim, no_slip = context.dim, context.no_slip

        def assign(
            fluid: Interpolated, wall: WallPoint, constants: Any, velocity: Array, viscous_velocity: Array
        ) -> tuple[float, float]:
            pressure = fluid.pressure
            for d in range(dim):
                pressure += wall.force[d] * wall.lift[d]
                velocity[d] = wall.velocity[d]
                for e in range(dim):
                    reflected = (-1.0 if d == e else 0.0) if no_slip else wall.reflection[d, e]
                    velocity[d] += reflected * (fluid.velocity[e] - wall.velocity[e])
            return pressure, 1.0

        return WallParts(assign=assign)
