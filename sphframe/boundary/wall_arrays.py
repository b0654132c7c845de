"""Boundary: what compiled loops read of wall particles."""

from typing import NamedTuple

import numba

from sphframe.arrays import Array, IntArray
from sphframe.interfaces import WallPoint


class WallArrays(NamedTuple):
    """What compiled loops read of the ghosts, one entry or row of each.

    ``normal`` (g, dim) of the wall, out of the fluid, and ``distance`` (g,) from it, m; ``height`` (g,) of the
    evaluation point above the wall, m; ``reflection`` (g, dim, dim); ``velocity`` (g, dim) of the wall, m/s; ``force``
    (g, dim): rho0 (f - a_wall), N/m^3; ``volume`` (g,), m^dim; ``full`` (g,): filling of the evaluation point in the
    midst of the fluid; ``viscous_velocity`` (g, dim) of the ghosts, m/s; ``state`` (g,) that the treatment advances;
    ``position`` (g, dim), m; ``number`` (g,) of the wall of each.
    """

    normal: Array
    distance: Array
    height: Array
    reflection: Array
    velocity: Array
    force: Array
    volume: Array
    full: Array
    viscous_velocity: Array
    state: Array
    position: Array
    number: IntArray


@numba.njit(error_model="numpy", forceinline=True)
def wall_point(walls, lifts, g):  # type: ignore[no-untyped-def]
    """Return the :class:`WallPoint` of wall particle ``g``; ``lifts`` (g, dim) lead from the evaluation points, m."""
    return WallPoint(
        walls.normal[g], walls.distance[g], walls.height[g], lifts[g], walls.reflection[g],
        walls.velocity[g], walls.force[g], walls.state[g], walls.position[g], walls.number[g],
    )  # fmt: skip
