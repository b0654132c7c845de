"""No slip by the ratio of the distances from the wall, Takeda et al. (1994) and Morris et al. (1997), for sphframe."""

from dataclasses import dataclass, replace
from typing import Any

from sphframe import (
    BoundaryInterpolator,
    FixedGhosts,
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

__all__ = ["DistanceRatio"]

_NEAREST = 0.25
"""least distance of a fluid particle from the wall, in particle spacings"""


_RATIO = Orders(
    pressure=Order(2, 0), divergence=Order(1, 1), viscosity=Order(0, -1), shear=Order(2, None),
    slip_divergence=Order(2, 0), slip_viscosity=Order(-1, -1),
)  # fmt: skip
_CAPPED = replace(_RATIO, viscosity=Order(-1, -1), shear=Order(1, None))


@dataclass(frozen=True)
class DistanceRatio(WallTreatment):
    """Fixed ghosts whose velocity for the viscosity is that of each fluid particle, continued through the wall.

    With the distances d_i of the fluid particle and d_G of the ghost from the wall, each pair sees::

        u_G = u_w - min(d_G / d_i, cap) (u_i - u_w),    d_i = (x_G - x_i).n - d_G

    in the viscosity, which is exact for a linear shear flow; ``continuity = "ratio"`` uses it in the continuity, too.
    The pressure is that of fixed ghosts, with the interpolator of the case. With free slip the viscosity sees no wall.

    Departs from the papers: there the wall particles lie on the wall, and Morris et al. cap the ratio at 1.5. For
    ghosts half a spacing behind it the cap makes the rule first order; without it, d_i is at least a quarter of a
    spacing.

    Known failures: a small d_i limits the viscous time step. Near a corner the ratio is that of the nearest face.

    Source: H. Takeda, S. M. Miyama, M. Sekiya (1994), doi:10.1143/ptp/92.5.939; J. P. Morris, P. J. Fox, Y. Zhu (1997),
    doi:10.1006/jcph.1997.5776.

    Attributes
    ----------
    cap
        largest ratio d_G / d_i; by default there is no limit but that of d_i.
    continuity
        velocity in the continuity: "assigned", that of fixed ghosts, or "ratio", as in the viscosity.
    """

    cap: float | None = None
    """largest ratio of the distances; 1.5 in the paper of Morris et al."""
    continuity: str = "assigned"
    """velocity of ghosts in the continuity: "assigned" as to fixed ghosts, or "ratio" """

    def __post_init__(self) -> None:
        if self.cap is not None and not self.cap > 0.0:
            raise ValueError(f"cap must be a positive number, got {self.cap!r}")
        if self.continuity not in ("assigned", "ratio"):
            raise ValueError(f'continuity must be "assigned" or "ratio", got {self.continuity!r}')

    @property
    def traits(self) -> WallTraits:
        """Shear is exact without a cap."""
        exact = self.cap is None
        order = _RATIO if exact else _CAPPED
        return WallTraits(exact_constant=True, exact_hydrostatic=True, exact_shear=exact, order=order)

    def interpolator(self, chosen: BoundaryInterpolator) -> BoundaryInterpolator:
        """Return the method that the case chose."""
        return chosen

    def parts(self, context: WallContext) -> WallParts:
        """Return the assignment of fixed ghosts and the function of a pair."""
        cap, in_continuity = self.cap or 1e300, self.continuity == "ratio"
        nearest = _NEAREST

        def seen(fluid: FluidSide, wall: WallSide, separation: Separation, constants: Any) -> Seen:
            across = wall.nx * separation.x + wall.ny * separation.y + wall.nz * separation.z
            ratio = min(wall.distance / max(across - wall.distance, nearest * constants.spacing), cap)
            u = wall.wall_u - ratio * (fluid.u - wall.wall_u)
            v = wall.wall_v - ratio * (fluid.v - wall.wall_v)
            w = wall.wall_w - ratio * (fluid.w - wall.wall_w)
            pressure_sum = fluid.pressure + wall.pressure
            if in_continuity:
                return Seen(pressure_sum, u, v, w, u, v, w)
            return Seen(pressure_sum, wall.u, wall.v, wall.w, u, v, w)

        return replace(FixedGhosts().parts(context), seen=seen, friction=context.no_slip)
