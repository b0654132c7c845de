"""Walls that mirror each fluid particle, pair by pair, and conserve energy, for sphframe."""

from dataclasses import dataclass, replace
from typing import Any

from sphframe import (
    FluidSide,
    Order,
    Orders,
    Seen,
    Separation,
    WallContext,
    WallParts,
    WallSide,
    WallTraits,
    WallTreatment,
)

__all__ = ["PairMirror"]


_LIFTED = Orders(
    pressure=Order(0, 0, 0.1502), divergence=Order(1, 1), viscosity=Order(-1, -1), shear=Order(1, None),
    slip_divergence=Order(0, 0, 0.05261), slip_viscosity=Order(-1, -1),
)  # fmt: skip
_NOT_LIFTED = replace(_LIFTED, pressure=Order(0, 0))


@dataclass(frozen=True)
class PairMirror(WallTreatment):
    """Each wall particle G has the pressure of the fluid particle i that sees it, and the reversed velocity.

    ::

        p_G = p_i + b.(x_G - x_i),    u_G = 2 u_w - u_i

    Without the lift b the work of the pressure on the pair, p_i w_G + p_G w_i with w = u - u_w, is zero, so that a wall
    at rest neither takes nor gives mechanical energy. With it, this holds for b = 0 only: the force of the lift on a
    pair has a curl, and no potential. Nothing is interpolated.

    Departs from its source, code that adds an elastic bounce: particles behind a wall are put back by sphframe. The
    lift is an addition; without it a bed of still water carries half of the weight of its first layer.
    With free slip the wall has no viscosity.

    Known failure: particles drift towards walls, since only the normal velocity of the pair resists.

    Source: the conservative boundary of AQUAgpusph, https://gitlab.com/sanguinariojoe/aquagpusph; J. L. Cercos-Pita
    (2015), doi:10.1016/j.cpc.2015.01.026.

    Attributes
    ----------
    lift
        whether p_G has the lift b.(x_G - x_i).
    """

    lift: bool = True
    """whether the pressure is lifted from the fluid particle to the wall particle"""

    @property
    def traits(self) -> WallTraits:
        """What is promised depends on the lift."""
        order = _LIFTED if self.lift else _NOT_LIFTED
        return WallTraits(exact_constant=True, exact_hydrostatic=self.lift, conjugate=True, order=order)

    def parts(self, context: WallContext) -> WallParts:
        """Return the function of a pair."""
        lift = float(self.lift)

        def seen(fluid: FluidSide, wall: WallSide, separation: Separation, constants: Any) -> Seen:
            higher = wall.bx * separation.x + wall.by * separation.y + wall.bz * separation.z
            u, v, w = 2.0 * wall.wall_u - fluid.u, 2.0 * wall.wall_v - fluid.v, 2.0 * wall.wall_w - fluid.w
            pressure_sum = 2.0 * fluid.pressure + lift * higher
            return Seen(pressure_sum, u, v, w, u, v, w)

        return WallParts(seen=seen, friction=context.no_slip)
