"""Exact integrals over the edges of walls, behind which a continuum has the state of each particle, for sphframe."""

from dataclasses import dataclass
from typing import Any

from sphframe import (
    Edge,
    FluidSide,
    Order,
    Orders,
    WallContext,
    WallGeometry,
    WallParts,
    WallSide,
    WallTraits,
    WallTreatment,
)

__all__ = ["EdgeIntegrals"]

_NEAREST = 0.1
"""least distance of a fluid particle from the wall in the viscous force, in particle spacings"""
_ORDERS = Orders(
    pressure=Order(-1, -1, 1.715), divergence=Order(1, 1), viscosity=Order(-1, -1, 1.315), shear=Order(1, 1),
    slip_divergence=Order(0, 0, 0.05583), slip_viscosity=Order(-1, -1),
)  # fmt: skip


@dataclass(frozen=True)
class EdgeIntegrals(WallTreatment):
    """The solid is a continuum with the pressure of each fluid particle i, and its reversed normal velocity.

    With b = rho0 (f - a_w), the solid has the pressure p_i + b.(x - x_i) and the density rho0. The integrals over it
    are sums over the straight pieces e of the walls, with the distance z_e of i before the piece, unit vectors t along
    it and n out of the fluid, and c, w0 and w1 of :class:`sphframe.Edge` (solid, weight and moment)::

        grad gamma_e = -n w0_e,    A_e = c_e 1 + (z_e w0_e n + w1_e t) (x) n
        rho_i Du_i/Dt  += sum_e [2 p_i grad gamma_e - A_e b]
        drho_i/dt      += 2 rho_i sum_e (u_w - u_i).grad gamma_e
        no slip:  rho_i Du_i/Dt += -2 mu sum_e |grad gamma_e| (u_i - u_w)_t/z_e

    mu is the viscosity of shear flow: 1/8 of the factor of the artificial viscosity, and the laminar one. In 2-D only,
    with straight and bent walls; curved ones are polygons. There are no wall particles.

    Departs from the papers: nothing is divided by gamma, and no pressure is clipped but by the tension policy of the
    case. z_e is at least a tenth of a spacing in the viscous force.

    Known failures: the sums over the fluid are not integrals. Under a uniform pressure p the first layer is pushed by
    0.014 times 2 p/(rho dx) to the wall (Gaussian; 0.009 for Wendland C2), which in deep water is as much as the
    weight, until the particles have left the lattice; the shear force is of first order.

    Source: R. Winchenbach, R. Akhunov, A. Kolb (2020), doi:10.1145/3414685.3417829, whose wall is a straight line; the
    integrals over edges as in M. Ferrand et al. (2013), doi:10.1002/fld.3666.
    """

    traits = WallTraits(conjugate=True, dimensions=(2,), order=_ORDERS)
    geometry = WallGeometry.ROW

    def parts(self, context: WallContext) -> WallParts:
        """Return the integrals over a piece of the wall."""
        friction, nearest = float(context.no_slip), _NEAREST

        def surface(fluid: FluidSide, wall: WallSide, edge: Edge, constants: Any) -> tuple[float, float, float]:
            nx, ny = wall.nx, wall.ny
            u, v = fluid.u - wall.wall_u, fluid.v - wall.wall_v
            across = u * nx + v * ny
            behind = wall.bx * nx + wall.by * ny
            push = (2.0 * fluid.pressure + edge.z * behind) * edge.weight
            twice_mu = 0.25 * constants.viscosity + constants.friction
            rub = friction * twice_mu * edge.weight / max(edge.z, nearest * constants.spacing)
            fx = -push * nx - edge.solid * wall.bx + edge.moment * behind * ny - rub * (u - across * nx)
            fy = -push * ny - edge.solid * wall.by - edge.moment * behind * nx - rub * (v - across * ny)
            return fx, fy, -2.0 * across * edge.weight

        return WallParts(surface=surface)
