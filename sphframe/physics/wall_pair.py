"""Physics: a pair of a fluid and a wall particle as the treatment of the walls sees it."""

from typing import Any

import numba

from sphframe.interfaces import Edge, FluidSide, Seen, SeenFunction, Separation, SurfaceFunction, WallParts, WallSide


@numba.njit(error_model="numpy", forceinline=True)
def wall_side(rows, row, walls, g, columns):  # type: ignore[no-untyped-def]
    """Return the :class:`WallSide` of ghost ``g`` in ``row``; ``walls`` are the arrays of all ghosts."""
    deep = columns.dim == 3
    return WallSide(
        rows[row, columns.pressure],
        rows[row, columns.u],
        rows[row, columns.v],
        rows[row, columns.w] if deep else 0.0,
        walls.viscous_velocity[g, 0],
        walls.viscous_velocity[g, 1],
        walls.viscous_velocity[g, columns.z] if deep else 0.0,
        walls.normal[g, 0],
        walls.normal[g, 1],
        walls.normal[g, columns.z] if deep else 0.0,
        walls.distance[g],
        walls.velocity[g, 0],
        walls.velocity[g, 1],
        walls.velocity[g, columns.z] if deep else 0.0,
        walls.force[g, 0],
        walls.force[g, 1],
        walls.force[g, columns.z] if deep else 0.0,
    )


def make_seen(walls: WallParts, *, attracts: bool) -> SeenFunction:
    """Return what a pair sees: by the treatment's ``seen``, or what is assigned.

    A pair that does not ``attract`` acts only where p_i and p_i + p_G are positive. Else the fluid may leave the wall
    freely: an opening gap does not lower the density, and there is no viscosity. p_i counts, too, since the pressure
    that is extrapolated to the wall from a film in free fall is amplified noise.
    """
    own_viscous_velocity, friction = walls.own_viscous_velocity, walls.friction

    def as_assigned(fluid: FluidSide, wall: WallSide, separation: Separation, constants: Any) -> Seen:
        pressure_sum = fluid.pressure + wall.pressure
        u, v, w = wall.u, wall.v, wall.w
        if own_viscous_velocity:
            return Seen(pressure_sum, u, v, w, wall.viscous_u, wall.viscous_v, wall.viscous_w)
        return Seen(pressure_sum, u, v, w, u, v, w)

    chosen = walls.seen or as_assigned
    if attracts and friction:
        return chosen

    def limited(fluid: FluidSide, wall: WallSide, separation: Separation, constants: Any) -> Seen:
        found = chosen(fluid, wall, separation, constants)
        acts = attracts or min(fluid.pressure, found.pressure_sum) > 0.0
        opening = (found.u - fluid.u) * separation.x + (found.v - fluid.v) * separation.y
        free = not acts and opening + (found.w - fluid.w) * separation.z > 0.0
        rubs = acts and friction
        return Seen(
            found.pressure_sum if acts else 0.0,
            fluid.u if free else found.u,
            fluid.v if free else found.v,
            fluid.w if free else found.w,
            found.viscous_u if rubs else fluid.u,
            found.viscous_v if rubs else fluid.v,
            found.viscous_w if rubs else fluid.w,
        )

    return limited


def make_surface(surface: SurfaceFunction, *, attracts: bool) -> SurfaceFunction:
    """Return what an edge does to a fluid particle; unless it ``attracts``, the fluid may leave it freely, as above."""
    if attracts:
        return surface

    def limited(fluid: FluidSide, wall: WallSide, edge: Edge, constants: Any) -> tuple[float, float, float]:
        fx, fy, divergence = surface(fluid, wall, edge, constants)
        if fx * wall.nx + fy * wall.ny > 0.0 or fluid.pressure <= 0.0:
            return 0.0, 0.0, min(divergence, 0.0)
        return fx, fy, divergence

    return limited
