"""Geometry: the walls of one box of three dimensions, whose ghosts are on a lattice."""

from typing import final

import numpy as np

from sphframe.arrays import Array, BoolArray
from sphframe.geometry.ghosts import GhostPoints, Panels, WallGroup
from sphframe.geometry.shapes import grid
from sphframe.geometry.walls import BoxWall


@final
class BoxWalls(WallGroup):
    """The faces of one ``box`` of three dimensions, the wall ``index``; its ghosts are on a lattice.

    Along each axis the box is divided into whole numbers of cells; the layers behind its faces are one spacing deep.
    """

    def __init__(self, index: int, box: BoxWall) -> None:
        self._index = index
        self._box_lower, self._box_upper = np.array(box.lower), np.array(box.upper)
        self._open = [[sign + axis in box.open_faces for axis in "xyz"] for sign in "-+"]
        self._lower = np.where(self._open[0], -np.inf, self._box_lower)
        self._upper = np.where(self._open[1], np.inf, self._box_upper)

    def ghosts(self, spacing: float, layers: int) -> GhostPoints:
        """Return ghosts in layers at (k + 1/2) ``spacing`` (m) behind the faces, whose edges and corners are filled."""
        depth = (np.arange(layers) + 0.5) * spacing
        places, widths = [], []
        for k in range(3):
            low, high = self._box_lower[k], self._box_upper[k]
            count = max(round((high - low) / spacing), 1)
            within = low + (np.arange(count) + 0.5) * (high - low) / count
            below = low - depth[::-1] if not self._open[0][k] else depth[:0]
            above = high + depth if not self._open[1][k] else depth[:0]
            places.append(np.concatenate([below, within, above]))
            widths.append(np.repeat([spacing, (high - low) / count, spacing], [len(below), count, len(above)]))
        position, volume = grid(places), np.prod(grid(widths), axis=1)
        crossed = (position < self._lower) | (position > self._upper)
        ghost = np.any(crossed, axis=1)
        position, crossed = position[ghost], crossed[ghost]
        reflection = np.where(crossed[:, :, None], -1.0, 1.0) * np.eye(3)
        foot = np.clip(position, self._lower, self._upper)
        offset = position - foot
        return GhostPoints.without_corners(
            position,
            2.0 * foot - position,
            foot,
            offset / np.linalg.norm(offset, axis=1)[:, None],
            reflection,
            volume[ghost],
            np.full(len(position), self._index),
        )

    def panels(self, spacing: float) -> Panels:
        """Cut the closed faces into rectangles of about ``spacing`` (m)."""
        size = self._box_upper - self._box_lower
        counts = np.maximum(np.rint(size / spacing).astype(int), 1)
        steps = size / counts
        axes = zip(self._box_lower, counts, steps, strict=True)
        middles = [low + (np.arange(count) + 0.5) * step for low, count, step in axes]
        centres, areas = [np.empty((0, 3))], [np.empty((0, 3))]
        for side, bound in enumerate((self._box_lower, self._box_upper)):
            for k in (axis for axis in range(3) if not self._open[side][axis]):
                centre = grid([bound[k : k + 1] if axis == k else middles[axis] for axis in range(3)])
                area = np.zeros_like(centre)
                area[:, k] = np.prod(np.delete(steps, k)) * (2 * side - 1)
                centres.append(centre)
                areas.append(area)
        centre = np.vstack(centres)
        return Panels(centre, np.vstack(areas), np.full(len(centre), self._index))

    def behind(self, points: Array) -> BoolArray:
        """Return whether each of ``points`` (n, 3), m, lies behind a closed face, and not on it."""
        on_wall = 1e-9 * float(np.max(self._box_upper - self._box_lower))
        return np.asarray(np.any((points < self._lower - on_wall) | (points > self._upper + on_wall), axis=1))

    def feet_behind(self, points: Array) -> tuple[BoolArray, Array]:
        """Return which of ``points`` (n, 3), m, lie behind a closed face, and their nearest points on the box."""
        foot = np.clip(points, self._lower, self._upper)
        return np.any(foot != points, axis=1), foot
