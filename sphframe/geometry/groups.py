"""Geometry: the groups of the walls of a scene, their ghosts and panels together."""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
import shapely

from sphframe.arrays import IntArray
from sphframe.errors import InputError
from sphframe.geometry.box_walls import BoxWalls
from sphframe.geometry.ghosts import GhostPoints, NoWalls, Panels, PlaneWalls, Sides, WallGroup
from sphframe.geometry.shapes import CHORD, Shape
from sphframe.geometry.solid_walls import SolidWalls
from sphframe.geometry.walls import BoxWall, Wall
from sphframe.particles import Periods


def wall_groups(
    walls: tuple[Wall, ...], fluid: Sequence[Shape], spacing: float, periods: Periods | None = None
) -> list[tuple[str | None, WallGroup]]:
    """Return the groups of ``walls`` with the names of their bodies, None at rest.

    Parameters
    ----------
    walls
        all walls of a scene.
    fluid
        regions of the fluid at the start, which tell which sides of walls are wet.
    spacing
        of the particles, m.
    periods
        in which walls and fluid repeat themselves.

    Raises
    ------
    InputError
        when the side of the fluid is ambiguous, or walls cannot repeat themselves.
    """
    if not walls:
        return [(None, NoWalls(fluid[0].dimension))]
    members = {
        body: {k: wall for k, wall in enumerate(walls) if wall.body == body}
        for body in dict.fromkeys(wall.body for wall in walls)
    }
    if walls[0].dimension == 3:
        groups = [(body, _solid_group(own, fluid, spacing)) for body, own in members.items()]
        if periods and any(not isinstance(group, BoxWalls) for _, group in groups):
            raise InputError(
                "in three dimensions with periodic directions, walls can only be one box around the fluid, with open"
                ' faces where it repeats itself: give shape = "box" and open_faces such as ["-y", "+y"]'
            )
        return groups
    if not periods:
        return [(body, _plane_walls(tuple(own.items()), tuple(fluid), spacing)) for body, own in members.items()]
    return [(body, PlaneWalls(own, _whole(fluid, spacing), spacing, periods)) for body, own in members.items()]


def _whole(fluid: Sequence[Shape], spacing: float) -> shapely.Geometry:
    return shapely.geometrycollections([region.geometry(CHORD * spacing) for region in fluid])


@lru_cache(maxsize=32)
def _plane_walls(walls: tuple[tuple[int, Wall], ...], fluid: tuple[Shape, ...], spacing: float) -> PlaneWalls:
    """Return walls that are kept, since the same ones are compared with other treatments or methods."""
    return PlaneWalls(dict(walls), _whole(fluid, spacing), spacing)


def _solid_group(walls: Mapping[int, Wall], fluid: Sequence[Shape], spacing: float) -> WallGroup:
    """Return the group of walls of three dimensions; a box that alone holds all fluid keeps its lattice."""
    (index, wall), *others = walls.items()
    if not others and isinstance(wall, BoxWall):
        bounds = np.array([region.bounds() for region in fluid])
        low, high = (
            np.where([sign + axis in wall.open_faces for axis in "xyz"], sense * np.inf, place)
            for sign, sense, place in (("-", -1.0, wall.lower), ("+", 1.0, wall.upper))
        )
        if np.all(bounds[:, 0] > low - 0.25 * spacing) and np.all(bounds[:, 1] < high + 0.25 * spacing):
            return BoxWalls(index, wall)
    return _solid_walls(tuple(walls.items()), tuple(fluid), spacing)


@lru_cache(maxsize=8)
def _solid_walls(walls: tuple[tuple[int, Wall], ...], fluid: tuple[Shape, ...], spacing: float) -> SolidWalls:
    """Return walls that are kept, since checks and the run ask for the same ones."""
    return SolidWalls(dict(walls), fluid, spacing)


def ghosts_of(groups: Sequence[WallGroup], spacing: float, layers: int) -> GhostPoints:
    """Return the ghosts of all ``groups``; see :meth:`WallGroup.ghosts`."""
    parts = [group.ghosts(spacing, layers) for group in groups]
    return parts[0] if len(parts) == 1 else GhostPoints(*map(np.concatenate, zip(*parts, strict=True)))


def sides_of(groups: Sequence[WallGroup], spacing: float, layers: int) -> tuple[Sides, IntArray] | None:
    """Return the sides of all ``groups`` and the group of each; None where no wall is thin, and in 3-D."""
    parts = [group.sides(spacing, layers) for group in groups if isinstance(group, PlaneWalls)]
    if not any(np.any(part.thin) for part in parts):
        return None
    first = 0
    for k, part in enumerate(parts):
        parts[k] = part._replace(chart=part.chart + first, ghost_chart=part.ghost_chart + first)
        first += int(part.chart.max(initial=-1)) + 1
    together = Sides(*map(np.concatenate, zip(*parts, strict=True)))
    return together, np.repeat(np.arange(len(parts)), [len(part.ends) for part in parts])


def within(
    support: float, ghosts: GhostPoints, sides: tuple[Sides, IntArray] | None
) -> tuple[GhostPoints, tuple[Sides, IntArray] | None]:
    """Return what is left without ghosts as far from their wall as the ``support`` (m), which no fluid reaches."""
    near: Any = np.linalg.norm(ghosts.position - ghosts.foot, axis=1) < support
    if sides is not None:
        own, group = sides
        sides = own._replace(ghost_chart=own.ghost_chart[near], kind=own.kind[near]), group
    kept = {id(part): part[near] for part in ghosts}  # once what is the same array
    return GhostPoints(*(kept[id(part)] for part in ghosts)), sides


def panels_of(groups: Sequence[WallGroup], spacing: float) -> Panels:
    """Return the panels of all ``groups``; see :meth:`WallGroup.panels`."""
    parts = [group.panels(spacing) for group in groups]
    return Panels(*map(np.concatenate, zip(*parts, strict=True)))


def row_of(groups: Sequence[WallGroup], distance: float, spacing: float) -> GhostPoints:
    """Return wall particles in one row on the walls, ``distance`` (m) apart, with volumes ``spacing`` (m) deep."""
    centre, area, wall = panels_of(groups, distance)
    size = np.linalg.norm(area, axis=1)
    normal = area / size[:, None]
    reflection = np.eye(centre.shape[1]) - 2.0 * normal[:, :, None] * normal[:, None, :]
    return GhostPoints.without_corners(centre, centre, centre, normal, reflection, size * spacing, wall)
