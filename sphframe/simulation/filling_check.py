"""Simulation: a check before the run that fluid and ghosts together fill the kernel beside the walls.

::

    F(x) = sum_j V_j W(x - x_j)

over fluid particles and ghosts is one where they fill the support of the kernel. It is computed half a spacing inside
the middle of each panel of the walls, and at the particles next to walls. Where the support reaches empty space, as
below a free surface or beside the end of a wall, less than one is right, and only more than one is a deviation.
"""

import warnings
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.boundary.boundary import Boundary
from sphframe.cases import CaseWarning
from sphframe.compiled import specialise
from sphframe.errors import InputError
from sphframe.geometry import Wall, panels_of
from sphframe.geometry.shapes import grid
from sphframe.neighbours import NeighbourLists, Sight, share_points
from sphframe.particles import Columns, Periods
from sphframe.physics import LoopParameters, sample_points
from sphframe.simulation.components import Components

REPORTED, REFUSED = 0.05, 0.25
"""deviations of F from one above which a case is reported and refused"""
_SHORT = 0.02
"""deficit of F from which the support is searched for empty space"""
_NEAR = 0.9
"""distance over spacing within which a point inside the fluid has a particle"""


class WallFilling(NamedTuple):
    """F (k,) at ``points`` (k, dim), m, beside ``wall`` (k,); whether particles can fill the support there (k,)."""

    points: Array
    wall: IntArray
    value: Array
    full: BoolArray

    @property
    def deviation(self) -> Array:
        """F - 1 (k,); 0 where F is below one because of empty space."""
        return np.where(self.full, self.value - 1.0, np.maximum(self.value - 1.0, 0.0))


def filling_by(
    position: Array,
    volume: Array,
    points: Array,
    components: Components,
    parameters: LoopParameters,
    sight: Sight | None,
    periods: Periods,
) -> Array:
    """Return sum_j V_j W(x - x_j) at ``points`` x (k, dim), m, over particles at ``position`` (n, dim), m.

    With ``sight``, the last ones are the ghosts, and counted is what is seen from each point. With ``periods``, the
    nearest copies of particles count.
    """
    columns, sums = Columns.of(points.shape[1]), np.zeros(len(points))
    if len(points) and len(position):
        rows = columns.zeros(len(position))
        rows[:, columns.position], rows[:, columns.volume] = periods.wrapped(position), volume
        lists = NeighbourLists(columns.dim, len(rows), 0, parameters.support, 0.0, periods=periods)
        numbers = lists.sort(rows)
        rows = rows[numbers]
        near, counts = lists.around(points, rows)
        if sight is not None:
            shares, n = np.zeros(near.shape), len(position) - len(sight.ghost_chart)
            share_points(points, rows, numbers, n, parameters.support, near, counts, shares, sight)
            listed = np.arange(near.shape[1]) < counts[:, None]
            rows = rows[near[listed]]  # a row of its own for each point that sees a particle
            rows[:, columns.volume] *= shares[listed]
            near[listed] = np.arange(len(rows))
        sample = specialise(sample_points, components.parts)
        sample(points, rows, near, counts, parameters, np.zeros(len(points)), sums)
    return sums


def filling_beside_walls(
    boundary: Boundary,
    position: Array,
    volume: Array,
    spacing: float,
    components: Components,
    parameters: LoopParameters,
) -> WallFilling:
    """Return F beside the walls of ``boundary``, as drawn, with fluid particles at ``position`` (n, dim), m."""
    from scipy.spatial import cKDTree

    copies, margin = boundary.periods, 2.0 * parameters.support
    fluid = cKDTree(copies.with_copies(position, margin)[0])
    panels = panels_of(boundary.groups, spacing)
    normal = panels.area / np.linalg.norm(panels.area, axis=1)[:, None]
    inside = panels.centre - 0.5 * spacing * normal
    wet = (fluid.query(inside)[0] < _NEAR * spacing) & ~_behind(boundary, inside)
    if boundary.count:
        around, own = copies.with_copies(boundary.position, margin)
        distance, ghost = cKDTree(around).query(position)
        ghost = own[ghost]
    else:
        distance, ghost = np.full(len(position), np.inf), np.zeros(len(position), np.int64)
    next_to = distance < 1.25 * spacing
    points = np.vstack([inside[wet], position[next_to]])
    wall = np.concatenate([panels.wall[wet], boundary.wall[ghost[next_to]]])
    every, volumes = np.vstack([position, boundary.position]), np.concatenate([volume, boundary.volume])
    value = filling_by(every, volumes, points, components, parameters, boundary.sight, copies)

    full = np.ones(len(points), dtype=np.bool_)
    along = np.arange(-parameters.support, parameters.support + spacing, spacing)
    offsets = grid([along] * points.shape[1])
    offsets = offsets[np.linalg.norm(offsets, axis=1) < parameters.support]
    short = np.flatnonzero(value < 1.0 - _SHORT)
    for chunk in np.array_split(short, max(len(short) * len(offsets) // 1_000_000, 1)):
        around = (points[chunk][:, None] + offsets).reshape(-1, points.shape[1])
        empty = fluid.query(around, distance_upper_bound=_NEAR * spacing)[0] == np.inf
        empty[empty] = ~_behind(boundary, around[empty])
        full[chunk] = ~empty.reshape(len(chunk), len(offsets)).any(axis=1)
    return WallFilling(points, wall, value, full)


def _behind(boundary: Boundary, points: Array) -> BoolArray:
    behind = np.zeros(len(points), dtype=np.bool_)
    for group in boundary.groups:
        behind |= group.behind(points)
    return behind


def check_filling(filling: WallFilling, walls: Sequence[Wall], *, refuse: bool) -> None:
    """Check that F is one beside all ``walls``.

    Warns
    -----
    CaseWarning
        with the worst place beside each wall where F deviates by more than 5 %.

    Raises
    ------
    InputError
        where F deviates by more than 25 %, if ``refuse``.
    """
    deviation = np.abs(filling.deviation)
    messages = []
    for wall in np.unique(filling.wall[deviation > REPORTED]):
        own = np.where(filling.wall == wall, deviation, 0.0)
        worst = int(np.argmax(own))
        place = ", ".join(f"{x:.6g}" for x in filling.points[worst])
        messages.append(
            f"beside wall {walls[wall].name!r}, fluid and ghosts fill the kernel by {filling.value[worst]:.0%} at"
            f" ({place}), where it should be 100 %; it deviates by more than {REPORTED:.0%} at"
            f" {np.count_nonzero(own > REPORTED)} of {np.count_nonzero(filling.wall == wall)} places beside this wall;"
            " draw the fluid up to the wall, or choose a smaller particle_spacing ('sphframe show --walls' draws it)"
        )
    if refuse and deviation.max(initial=0.0) > REFUSED:
        advice = f'deviations above {REFUSED:.0%} are refused, unless guards.filling = "report"'
        raise InputError("\n".join([*messages, advice]))
    for message in messages:
        warnings.warn(message, CaseWarning, stacklevel=2)
