"""Walls that mirror the pressure of each fluid particle, Akinci et al. (2012), for sphframe."""

import math
from dataclasses import dataclass
from typing import Any

from sphframe import (
    Array,
    FluidSide,
    Interpolated,
    Order,
    Orders,
    Seen,
    Separation,
    WallContext,
    WallGeometry,
    WallParts,
    WallPoint,
    WallSide,
    WallTraits,
    WallTreatment,
)

__all__ = ["Akinci"]


_LAYERS = Orders(
    pressure=Order(0, 0, 0.3126), divergence=Order(1, 1), viscosity=Order(-1, -1), shear=Order(1, 1),
    slip_divergence=Order(0, 0), slip_viscosity=Order(-1, -1),
)  # fmt: skip


@dataclass(frozen=True)
class Akinci(WallTreatment):
    """Each wall particle G has the pressure of the fluid particle i that sees it, and its own velocity.

    ::

        p_G = p_i,    u_G = u_w,    V_G = 1/sum_K W_GK,    K: wall particles

    The momentum equation thus has -2 p_i grad W V_G. With free slip the wall has no viscosity. By default the wall
    particles fill the support behind the wall, and V_G are the volumes that they fill. With ``row = true`` there is
    one row on the wall, in 2-D only, with the volume of a straight infinite row.

    Departs from the paper: there the pressure is p_i once in print, and twice in code; twice is right, since only then
    a uniform pressure exerts no force. V_G of the row is that of a straight one also at bends and corners, where the
    sum over K gives 12 to 13 % less at right angles; the force that is left there is the method's with both (below).

    Known failures: the pressure lacks the weight of the water between i and G, so that a bed bears its first layer at
    half its weight; still water moves away from the wall. Under a uniform pressure p a row leaves an acceleration of
    0.12 times 2 p/(rho dx) from the wall in the first layer (Gaussian, h = 1.3 dx; 0.05 for Wendland C2, h = 2 dx), of
    0.35 to 0.37 into a corner of 90 degrees, with V_G from the sum 0.38, and of 0.44 to 0.52 away from one of
    270 degrees, with V_G from the sum 0.38 to 0.44.

    Source: N. Akinci, M. Ihmsen, G. Akinci, B. Solenthaler, M. Teschner (2012), doi:10.1145/2185520.2185558.

    Attributes
    ----------
    row
        one row of wall particles on the wall, in 2-D, instead of layers that fill the support.
    """

    row: bool = False
    """whether there is one row of particles on the wall, in place of layers behind it"""

    @property
    def geometry(self) -> WallGeometry:
        """One row, or layers."""
        return WallGeometry.ROW if self.row else WallGeometry.LAYERS

    @property
    def traits(self) -> WallTraits:
        """A row is not exact for uniform pressure."""
        if self.row:
            return WallTraits(dimensions=(2,))
        return WallTraits(exact_constant=True, order=_LAYERS)

    def parts(self, context: WallContext) -> WallParts:
        """Return the function of a pair, and the volumes of a row."""
        value, support, normalisation = context.kernel.value, context.kernel.support, context.kernel.normalisation
        dim, row = context.dim, self.row

        def assign(
            fluid: Interpolated, wall: WallPoint, constants: Any, velocity: Array, viscous_velocity: Array
        ) -> tuple[float, float]:
            for d in range(dim):
                velocity[d] = wall.velocity[d]
            if not row:
                return 0.0, 1.0
            total = value(0.0)
            per_h = constants.spacing / constants.smoothing_length
            for k in range(1, math.ceil(support / per_h)):
                total += 2.0 * value(k * per_h)
            return 0.0, 1.0 / (normalisation * total * per_h * per_h)  # over dx^2, the volume of a particle of the row

        def seen(fluid: FluidSide, wall: WallSide, separation: Separation, constants: Any) -> Seen:
            u, v, w = wall.wall_u, wall.wall_v, wall.wall_w
            return Seen(2.0 * fluid.pressure, u, v, w, u, v, w)

        return WallParts(assign=assign, seen=seen, friction=context.no_slip)
