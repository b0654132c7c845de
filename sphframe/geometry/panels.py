"""Geometry: walls are cut into panels, over which pressure is integrated."""

import itertools
from dataclasses import dataclass

import numpy as np

from sphframe.arrays import Array, IntArray
from sphframe.geometry.shapes import grid
from sphframe.geometry.walls import BoxWall, PolygonWall, Wall


@dataclass(frozen=True)
class Panels:
    """Panel ``centre`` (k, dim), m; ``area`` (k, dim), the area vector out of the fluid, m^(dim-1); ``wall`` (k,)."""

    centre: Array
    area: Array
    wall: IntArray


def wall_panels(walls: tuple[Wall, ...], spacing: float) -> Panels:
    """Cut all ``walls`` into panels of about ``spacing``."""
    cut = [_polygon(wall, spacing) if isinstance(wall, PolygonWall) else _box(wall, spacing) for wall in walls]
    owners = [np.full(len(centre), index) for index, (centre, _) in enumerate(cut)]
    return Panels(np.vstack([c for c, _ in cut]), np.vstack([a for _, a in cut]), np.concatenate(owners))


def _polygon(wall: PolygonWall, spacing: float) -> tuple[Array, Array]:
    centres, areas = [], []
    for a, b in zip(*wall.segments(), strict=True):
        edge = b - a
        count = max(round(float(np.linalg.norm(edge)) / spacing), 1)
        centres.append(a + ((np.arange(count) + 0.5) / count)[:, None] * edge)
        areas.append(np.tile([edge[1] / count, -edge[0] / count], (count, 1)))
    return np.vstack(centres), np.vstack(areas)


def _box(wall: BoxWall, spacing: float) -> tuple[Array, Array]:
    low, high = np.array(wall.lower), np.array(wall.upper)
    counts = np.maximum(np.rint((high - low) / spacing).astype(int), 1)
    steps = (high - low) / counts
    middles = [low[k] + (np.arange(counts[k]) + 0.5) * steps[k] for k in range(wall.dimension)]
    centres, areas = [], []
    for k, (sign, bound) in itertools.product(range(wall.dimension), (("-", low), ("+", high))):
        if sign + "xyz"[k] in wall.open_faces:
            continue
        axes = [np.array([bound[k]]) if m == k else middles[m] for m in range(wall.dimension)]
        centre = grid(axes)
        area = np.zeros_like(centre)
        area[:, k] = np.prod(np.delete(steps, k)) * (1.0 if sign == "+" else -1.0)
        centres.append(centre)
        areas.append(area)
    return np.vstack(centres), np.vstack(areas)
