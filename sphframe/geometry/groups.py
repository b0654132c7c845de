"""Geometry: the groups of the walls of a scene, their ghosts and panels together."""

from collections.abc import Sequence

import numpy as np
import shapely

from sphframe.arrays import IntArray
from sphframe.geometry.box_walls import BoxWalls
from sphframe.geometry.ghosts import NONE, GhostPoints, Panels, PlaneWalls, Sides, WallGroup
from sphframe.geometry.shapes import CHORD, Shape
from sphframe.geometry.walls import BoxWall, Wall


def wall_groups(walls: tuple[Wall, ...], fluid: Sequence[Shape], spacing: float) -> list[tuple[str | None, WallGroup]]:
    """Return the groups of ``walls`` with the names of their bodies, None at rest.

    Parameters
    ----------
    walls: all walls of a scene. Those of three dimensions are groups of their own.
    fluid: regions of the fluid at the start; not used in 3-D.
    spacing: of the particles, m.

    Raises
    ------
    InputError: when the side of the fluid is ambiguous.
    """
    if walls[0].dimension == 3:
        return [(wall.body, BoxWalls(k, wall)) for k, wall in enumerate(walls) if isinstance(wall, BoxWall)]
    whole = shapely.geometrycollections([region.geometry(CHORD * spacing) for region in fluid])
    bodies = dict.fromkeys(wall.body for wall in walls)
    return [
        (body, PlaneWalls({k: wall for k, wall in enumerate(walls) if wall.body == body}, whole, spacing))
        for body in bodies
    ]


def ghosts_of(groups: Sequence[WallGroup], spacing: float, layers: int) -> GhostPoints:
    """Return the ghosts of all ``groups``; see :meth:`WallGroup.ghosts`."""
    parts = [group.ghosts(spacing, layers) for group in groups]
    return GhostPoints(*map(np.concatenate, zip(*parts, strict=True)))


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
    nothing = np.zeros_like(centre)
    none = np.full(len(wall), NONE)
    return GhostPoints(
        centre, centre, centre, normal, reflection, size * spacing, wall, none, nothing, nothing
    )  # fmt: skip
