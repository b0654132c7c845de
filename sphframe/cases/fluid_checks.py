"""Cases: contradictions between the regions of fluid, and between them and the walls."""

import itertools
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import shapely

from sphframe.arrays import Array
from sphframe.cases.scene import Scene
from sphframe.errors import InputError
from sphframe.geometry import PlaneWalls, Region, WallGroup, common_part, fill, panels_of, wall_groups, wall_lines
from sphframe.geometry.shapes import CHORD
from sphframe.particles import Periods

_THIN = 0.01
"""thickness over spacing below which an overlap or a gap is round-off"""
_NARROW = 0.75
"""width over spacing up to which a gap is taken for a mistake; a wider one is empty space"""


def fluid_problems(scene: Scene, spacing: float, support: float, periods: Periods) -> Iterator[str]:
    """Yield what is wrong with walls and regions of fluid, for particles one ``spacing`` apart and a ``support``, m."""
    try:
        groups = [group for _, group in wall_groups(scene.walls, scene.fluid, spacing, periods)]
    except InputError as error:
        yield str(error)
        return
    for group in groups:
        place = group.thin_place(0.95 * support)
        if place is not None:
            at = ", ".join(f"{x:.6g}" for x in place)
            drawn = ", draw it with corners between its sides or as a line" if len(place) == 2 else ""
            yield (
                f"the solid within walls at ({at}) is thinner than the kernel's support, so that fluid would be"
                f" felt through it; make it {support:.3g} m thick or more{drawn}, or choose a smaller particle_spacing"
            )
        for probe in scene.probes:
            if isinstance(group, PlaneWalls) and group.on_line(probe.position):
                yield (
                    f"probe {probe.name!r} at {probe.position} is on a wall without thickness; move it a little, by"
                    f" {0.01 * spacing:.3g} m or more, to the side on which it measures"
                )
    yield from _surface_problems(scene, groups, spacing)
    for index, region in enumerate(scene.fluid):
        yield from _region_problems(scene, index, region, groups, spacing, periods)
        if scene.initial_pressure is not None and (region.level is not None or region.pressure is not None):
            yield f"fluid[{index}] has a level or pressure, but the case gives its own initial pressure; leave it out"
    yield from _overlaps(scene.fluid, spacing)


def _surface_problems(scene: Scene, groups: Sequence[WallGroup], spacing: float) -> Iterator[str]:
    sliding = [(k, wall) for k, wall in enumerate(scene.walls) if wall.surface_velocity is not None]
    if not sliding:
        return
    panels = panels_of(groups, spacing)
    for k, wall in sliding:
        if wall.body is not None:
            yield (
                f"wall {wall.name!r} has a surface_velocity, and is carried by body {wall.body!r}: leave one out; a"
                " surface_velocity is that of a wall which stays where it is"
            )
        velocity, area = np.array(wall.surface_velocity), panels.area[panels.wall == k]
        across = np.abs(area @ velocity) > 1e-6 * np.linalg.norm(area, axis=1) * np.linalg.norm(velocity)
        if np.any(across):
            x = ", ".join(f"{c:.6g}" for c in panels.centre[panels.wall == k][across][0])
            yield (
                f"surface_velocity = {wall.surface_velocity} of wall {wall.name!r} is not along its surface at ({x});"
                " give a velocity along a straight wall, or turn a curved one with a body"
            )


def _region_problems(
    scene: Scene, index: int, region: Region, groups: Sequence[WallGroup], spacing: float, periods: Periods
) -> Iterator[str]:
    position = fill(region, spacing).position
    if len(position) == 0:
        yield f"fluid[{index}] holds no particle; enlarge it or choose a smaller particle_spacing"
        return
    for group in groups:
        behind = group.behind(position)
        if np.any(behind):
            yield (
                f"{behind.sum()} of {len(position)} particles of fluid[{index}] lie behind a wall, the first at"
                f" {tuple(position[behind][0].round(6).tolist())}; draw the fluid within the walls"
            )
    rim = max((float(wall.bounds()[1][-1]) for wall in scene.walls if not periods.repeats[-1]), default=np.inf)
    top = float(position[:, -1].max())
    if top > rim:
        yield f"fluid[{index}] reaches {top:g} m, above the rim of the walls at {rim:g} m; raise the walls"
    lower, upper = np.array(scene.domain)
    outside = int(np.count_nonzero(np.any((position < lower) | (position > upper), axis=1)))
    if outside:
        yield (
            f"{outside} of {len(position)} particles of fluid[{index}] lie outside the domain {scene.domain};"
            f" enlarge the domain"
        )


def _overlaps(regions: tuple[Region, ...], spacing: float) -> Iterator[str]:
    for (i, one), (k, other) in itertools.combinations(enumerate(regions), 2):
        common = common_part(one, other, spacing)
        if common is not None:
            place = ", ".join(f"{x:.4g}" for x in common[1])
            yield (
                f"fluid[{i}] and fluid[{k}] overlap in {common[0]:.3g} m{one.dimension} around ({place}), where there"
                ' would be twice the fluid; draw them side by side, or as one region of shape = "union"'
            )


def fluid_reservations(scene: Scene, spacing: float) -> Iterator[str]:
    """Yield where fluid and wall are apart, or overlap, by less than a particle (2-D)."""
    walls = wall_lines(scene.walls, spacing)
    if walls.is_empty:
        return
    fluid = shapely.union_all([region.geometry(CHORD * spacing) for region in scene.fluid], grid_size=1e-6 * spacing)
    point, width = _distances(fluid, walls, spacing)
    # the water's surface meets walls at an angle; only where both are about parallel are they meant to be one line
    parallel = np.abs(width[:, 0] - width[:, 1]) < 0.05 * spacing
    for sign in (1.0, -1.0):
        wrong = parallel & (sign * width.mean(axis=1) > 2.0 * _THIN * spacing)
        if wrong.any():
            worst = int(np.argmax(np.where(wrong, sign * width.mean(axis=1), 0.0)))
            x, y = point[worst].mean(axis=0)
            where = f"{abs(width[worst].mean()):.3g} m at ({x:.4g}, {y:.4g})"
            yield (
                f"the fluid ends {where} before a wall, a gap that no particle fills; draw it up to the wall"
                if sign > 0
                else f"the fluid reaches {where} behind a wall; draw it up to the wall"
            )


def _distances(fluid: Any, walls: Any, spacing: float) -> tuple[Array, Array]:
    """Points (n, 2, 2) at 1/4 and 3/4 of each half spacing of an outline, and the distances (n, 2) to walls.

    A distance, m, is measured along the normal out of the fluid; it is NaN where there is no wall near.
    """
    points, normals = [], []
    for part in shapely.get_parts(fluid):
        for ring in shapely.get_parts(shapely.orient_polygons(part).boundary):
            corner = shapely.get_coordinates(shapely.segmentize(ring, 0.5 * spacing))
            edge = np.diff(corner, axis=0)
            points.append(corner[:-1, None] + edge[:, None] * [[0.25], [0.75]])
            normal = np.stack([edge[:, 1], -edge[:, 0]], axis=1) / np.linalg.norm(edge, axis=1)[:, None]
            normals.append(np.repeat(normal[:, None], 2, axis=1))
    point, normal = np.concatenate(points), np.concatenate(normals)
    reach = np.stack([point - 0.5 * spacing * normal, point + _NARROW * spacing * normal], axis=2)
    hit = shapely.shortest_line(shapely.points(point), shapely.intersection(shapely.linestrings(reach), walls))
    width = np.full(hit.shape, np.nan)
    met = ~shapely.is_missing(hit)
    nearest = shapely.get_coordinates(shapely.get_point(hit[met], 1))
    width[met] = np.einsum("nk,nk->n", nearest - point[met], normal[met])
    return point, width
