"""Physics: a pair of a fluid and a wall particle as the treatment of the walls sees it."""

from typing import Any

import numba

from sphframe.interfaces import FluidSide, Seen, SeenFunction, Separation, WallParts, WallSide


@numba.njit(inline="always")
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
    """Return what a pair sees: by the treatment's ``seen``, or what is assigned; not below 0 unless it ``attracts``."""
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
        pressure_sum = found.pressure_sum if attracts else max(found.pressure_sum, 0.0)
        if friction:
            return Seen(
                pressure_sum, found.u, found.v, found.w, found.viscous_u, found.viscous_v, found.viscous_w
            )  # fmt: skip
        return Seen(pressure_sum, found.u, found.v, found.w, fluid.u, fluid.v, fluid.w)

    return limited
