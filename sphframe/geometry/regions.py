"""Geometry: regions that are filled with fluid, on a square or cubic lattice."""

from typing import Annotated

import numpy as np
from pydantic import Field

from sphframe.arrays import Array
from sphframe.geometry.shapes import Box, Polygon, grid


class PolygonRegion(Polygon):
    """The inside of a simple polygon (2-D), corners in m in either sense of rotation."""


class BoxRegion(Box):
    """A rectangle (2-D) or box (3-D) between two corners, m."""


Region = Annotated[PolygonRegion | BoxRegion, Field(discriminator="shape")]


def lattice(region: Region, spacing: float) -> Array:
    """Positions (n, dim) of the centres of the :func:`lattice_cell` cells that fill ``region``.

    Cells are counted from the region's lower corner, so the first particle lies half a cell from a wall there. A box
    is filled from face to face. In a polygon each row of cells is divided evenly between the edges that it meets: along
    a leaning wall no gap is left and no particle touches it, from which pressure waves would start.
    """
    lower, upper = region.bounds()
    cell = lattice_cell(region, spacing)
    counts = np.maximum(np.rint((upper - lower) / cell).astype(int), 1)
    axes = [low + (np.arange(count) + 0.5) * edge for low, count, edge in zip(lower, counts, cell, strict=True)]
    if isinstance(region, BoxRegion):
        return grid(axes)
    rows = [np.empty((0, 2))]
    for y in axes[1]:
        crossings = _crossings(np.array(region.points), y)
        for left, right in zip(crossings[::2], crossings[1::2], strict=True):
            count = round((right - left) / spacing)
            x = left + (np.arange(count) + 0.5) / max(count, 1) * (right - left)
            rows.append(np.stack([x, np.full(count, y)], axis=1))
    return np.vstack(rows)


def _crossings(corners: Array, y: float) -> list[float]:
    """Sorted x at which the polygon's edges cross the height ``y``; an even number of them."""
    crossings = []
    for (x1, y1), (x2, y2) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if (y1 > y) != (y2 > y):
            crossings.append(float(x1 + (y - y1) * (x2 - x1) / (y2 - y1)))
    return sorted(crossings)


def lattice_cell(region: Region, spacing: float) -> Array:
    """Edges (dim,) of a lattice cell, m: ``spacing``, or in a box the nearest length of which a whole number fits."""
    extent = np.subtract(*region.bounds()[::-1])
    if isinstance(region, BoxRegion):
        return np.asarray(extent / np.maximum(np.rint(extent / spacing), 1.0))
    return np.full(len(extent), spacing)
