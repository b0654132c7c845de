"""Geometry: regions that are filled with fluid, on a square or cubic lattice."""

from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from sphframe.arrays import Array


class PolygonRegion(BaseModel):
    """The inside of a simple polygon (2-D), corners in m in either sense of rotation."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    shape: Literal["polygon"] = "polygon"
    points: tuple[tuple[float, float], ...] = Field(min_length=3)

    @property
    def lower(self) -> Array:
        """Lower corner of the bounding box, m."""
        return np.asarray(np.min(self.points, axis=0))

    @property
    def upper(self) -> Array:
        """Upper corner of the bounding box, m."""
        return np.asarray(np.max(self.points, axis=0))


class BoxRegion(BaseModel):
    """A rectangle (2-D) or box (3-D) between two corners, m."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    shape: Literal["box"] = "box"
    lower: tuple[float, ...] = Field(min_length=2, max_length=3)
    upper: tuple[float, ...] = Field(min_length=2, max_length=3)

    @model_validator(mode="after")
    def _ordered(self) -> "BoxRegion":
        check_box(self.lower, self.upper)
        return self


Region = Annotated[PolygonRegion | BoxRegion, Field(discriminator="shape")]


def check_box(lower: tuple[float, ...], upper: tuple[float, ...]) -> None:
    """Raise ValueError unless ``lower`` is below ``upper`` along every axis."""
    if len(lower) != len(upper) or any(low >= high for low, high in zip(lower, upper, strict=True)):
        raise ValueError(
            f"lower {lower} and upper {upper} do not span a box: give the same number of coordinates,"
            " each of lower smaller than that of upper"
        )


def grid(axes: Sequence[Array]) -> Array:
    """Return the points (n, dim) of the grid whose coordinates along each axis are ``axes``; the last runs fastest."""
    return np.stack([axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")], axis=1)


def lattice(region: Region, spacing: float) -> Array:
    """Positions (n, dim) of the centres of the :func:`lattice_cell` cells that fill ``region``.

    Cells are counted from the region's lower corner, so the first particle lies half a cell from a wall there. A box
    is filled from face to face. In a polygon each row of cells is divided evenly between the edges that it meets: along
    a leaning wall no gap is left and no particle touches it, from which pressure waves would start.
    """
    lower, upper = np.asarray(region.lower), np.asarray(region.upper)
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
    extent = np.asarray(region.upper, dtype=np.float64) - np.asarray(region.lower, dtype=np.float64)
    if isinstance(region, BoxRegion):
        return np.asarray(extent / np.maximum(np.rint(extent / spacing), 1.0))
    return np.full(len(extent), spacing)
