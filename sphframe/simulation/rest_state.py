"""Simulation: the compressible rest state, the default initial state of a case."""

import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.cases import Scene
from sphframe.geometry import Region, WallGroup, wall_lines
from sphframe.geometry.shapes import CHORD

_TOUCHING = 1.3
"""distance of particles over spacing up to which their regions touch"""


def still_levels(
    scene: Scene, positions: Sequence[Array], spacing: float, groups: Sequence[WallGroup], upward: Array
) -> Array:
    """Return the still water level (n,), m, of each region of fluid, whose particles are at ``positions``.

    It is the ``level`` of the region. Regions without one share the highest point, or level, of all regions that are
    connected with them by touching regions; in 2-D, regions on both sides of a wall do not touch. Fluid that does not
    stand on a wall falls freely: its pressure is zero, and its level minus infinity. ``groups`` are the walls, and
    ``upward`` (dim,) is the unit vector along which heights are measured.
    """
    count = len(positions)
    given = np.array([np.nan if region.level is None else region.level for region in scene.fluid])
    own = np.where(np.isnan(given), [_top(region, upward, spacing) for region in scene.fluid], given)
    walls = wall_lines(scene.walls, spacing)
    component = _components(positions, walls, spacing) if count > 1 else np.zeros(1, dtype=int)
    levels = given.copy()
    for c in np.unique(component):
        position = np.vstack([positions[k] for k in range(count) if component[k] == c])
        height = position @ upward
        stands = _stands(position[height < height.min() + 0.99 * spacing], groups, walls, spacing * upward)
        levels[np.isnan(given) & (component == c)] = own[component == c].max() if stands else -np.inf
    return levels


def _components(positions: Sequence[Array], walls: Any, spacing: float) -> IntArray:
    """Return the number (n,) of the group of touching regions to which each region belongs."""
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    touching = np.zeros((len(positions), len(positions)), dtype=np.bool_)
    trees = [cKDTree(position) for position in positions]
    for i, k in itertools.combinations(range(len(positions)), 2):
        distance, nearest = trees[i].query(positions[k], distance_upper_bound=_TOUCHING * spacing)
        near = np.isfinite(distance)
        touching[i, k] = np.any(~_crosses(positions[k][near], positions[i][nearest[near]], walls))
    return np.asarray(connected_components(touching, directed=False)[1])


def _top(region: Region, upward: Array, spacing: float) -> float:
    """Height of the highest point of a region along ``upward``."""
    if upward[-1] == 1.0:
        return float(region.bounds()[1][-1])
    drawn = region.geometry(CHORD * spacing)
    points = shapely.get_coordinates(drawn) if region.dimension == 2 else drawn.vertices
    return float((points @ upward).max())


def _stands(lowest: Array, groups: Sequence[WallGroup], walls: Any, spacing: Array) -> bool:
    """Whether a wall lies less than a ``spacing`` (dim,) below most of the ``lowest`` particles (n, dim) of a fluid."""
    below = lowest - spacing
    on_wall = _crosses(lowest, below, walls)
    for group in groups:
        on_wall |= group.behind(below)
    return bool(on_wall.mean() > 0.5)


def _crosses(start: Array, stop: Array, walls: Any) -> BoolArray:
    """Whether each line from ``start`` to ``stop`` (n, dim) meets a wall; in 3-D, no."""
    if start.shape[1] == 3 or not len(start):
        return np.zeros(len(start), dtype=np.bool_)
    return np.asarray(shapely.intersects(walls, shapely.linestrings(np.stack([start, stop], axis=1))))


def pressure_at_depth(
    depth: Array, density: Any, reference_density: float, sound_speed: float, gravity: float
) -> Array:
    """Return the pressure (Pa) at ``depth`` (m) below the surface at rest, from dp/ddepth = rho(p) g and p(0) = 0.

    For the linear equation of state this is rho0 c0^2 (exp(g depth / c0^2) - 1). ``density`` is the inverse equation
    of state, rho(p, rho0, c0). Above the surface the pressure is zero.
    """
    deepest = float(np.max(depth, initial=0.0))
    if deepest <= 0.0 or gravity == 0.0:
        return np.zeros_like(depth)
    from scipy.integrate import solve_ivp  # slow to import, and not needed by cases that give their initial pressure

    solution = solve_ivp(
        lambda _, p: [density(p[0], reference_density, sound_speed) * gravity],
        (0.0, deepest),
        [0.0],
        rtol=1e-11,
        atol=1e-9 * reference_density * gravity * deepest,
        dense_output=True,
    )
    return np.where(depth > 0.0, solution.sol(np.maximum(depth, 0.0))[0], 0.0)
