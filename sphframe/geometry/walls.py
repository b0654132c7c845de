"""Geometry: walls as polygons and boxes: their nearest points, and where ghosts may stand behind them."""

import itertools
import math
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from sphframe.arrays import Array, BoolArray
from sphframe.geometry.shapes import check_box, grid

TOLERANCE = 1e-9
"""share of a length below which two points are taken to be equal"""


class PolygonWall(BaseModel):
    """A polyline in 2-D with the fluid on its LEFT when it is traversed; ``closed`` joins the last point to the first.

    A tank is drawn from the top of its left wall, down, along the bed and up the right wall; an obstacle in the
    fluid is a closed polygon drawn clockwise.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    shape: Literal["polygon"] = "polygon"
    name: str = "wall"
    points: tuple[tuple[float, float], ...] = Field(min_length=2)
    closed: bool = False
    body: str | None = None
    """name of the body that carries the wall; None means a wall at rest"""

    @model_validator(mode="after")
    def _distinct_points(self) -> "PolygonWall":
        start, end = self.segments()
        if np.any(np.linalg.norm(end - start, axis=1) <= 0.0):
            raise ValueError(f"wall {self.name!r} has two equal points in a row; give each corner once")
        return self

    @property
    def dimension(self) -> int:
        """Dimension of space."""
        return 2

    def segments(self) -> tuple[Array, Array]:
        """Start and end points (m, 2) of the segments."""
        points = np.array(self.points, dtype=np.float64)
        if self.closed:
            return points, np.roll(points, -1, axis=0)
        return points[:-1], points[1:]

    def outline(self) -> list[Array]:
        """Polylines (k, dim) that draw the wall."""
        points = np.array(self.points, dtype=np.float64)
        return [np.vstack([points, points[:1]]) if self.closed else points]

    def candidates(self, spacing: float, layers: int) -> Array:
        """Return the positions (k, dim) in m where ghosts may stand, in ``layers`` of one ``spacing`` (m) each."""
        start, end = self.segments()
        tangent = (end - start) / np.linalg.norm(end - start, axis=1, keepdims=True)
        normal = np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)
        depths: Array = (np.arange(layers, dtype=np.float64) + 0.5) * spacing
        found: list[Array] = []
        for a, b, n in zip(start, end, normal, strict=True):
            count = max(round(float(np.linalg.norm(b - a)) / spacing), 1)
            along = a + ((np.arange(count) + 0.5) / count)[:, None] * (b - a)
            found.extend(along + depth * n for depth in depths)
        last = len(start) if self.closed else len(start) - 1
        for i in range(last):
            k = (i + 1) % len(start)
            found.append(_corner_ghosts(start[k], tangent[i], normal[i], tangent[k], normal[k], depths))
        return np.vstack(found)

    def nearest(self, position: Array) -> tuple[Array, Array]:
        """Nearest wall points (n, 2) to ``position`` (n, 2) and the free-slip reflection matrices (n, 2, 2)."""
        start, end = self.segments()
        best = np.full(len(position), np.inf)
        foot = np.zeros_like(position)
        at_corner = np.zeros(len(position), dtype=np.bool_)
        for a, b in zip(start, end, strict=True):
            edge = b - a
            t = np.clip((position - a) @ edge / (edge @ edge), 0.0, 1.0)
            point = a + t[:, None] * edge
            distance = np.linalg.norm(position - point, axis=1)
            closer = distance < best - TOLERANCE * np.linalg.norm(edge)
            best[closer] = distance[closer]
            foot[closer] = point[closer]
            beyond = np.abs((position - point) @ edge) > TOLERANCE * (edge @ edge)
            at_corner[closer] = beyond[closer]
        return foot, _reflections(position - foot, at_corner)

    def is_behind(self, position: Array) -> BoolArray:
        """Whether each ``position`` (n, 2) lies behind the wall, not on it, judged at the nearest point.

        Beyond the open ends of a polyline nothing is behind it.
        """
        start, end = self.segments()
        best = np.full(len(position), np.inf)
        side = np.zeros(len(position))
        free_ends = np.zeros(len(position), dtype=np.bool_)
        for k, (a, b) in enumerate(zip(start, end, strict=True)):
            edge = b - a
            raw = (position - a) @ edge / (edge @ edge)
            t = np.clip(raw, 0.0, 1.0)
            offset = position - a - t[:, None] * edge
            distance = np.linalg.norm(offset, axis=1)
            length = float(np.linalg.norm(edge))
            across = (position[:, 0] - a[0]) * edge[1] - (position[:, 1] - a[1]) * edge[0]
            sine = across / (length * np.maximum(distance, 1e-300))
            tie = np.abs(distance - best) <= TOLERANCE * length
            closer = (distance < best) & ~tie
            # at a corner two segments are equally near: the one whose normal is closer to the offset decides
            take = closer | (tie & (np.abs(sine) > np.abs(side)))
            side[take] = sine[take]
            open_end = ((k == 0) & (raw < 0.0)) | ((k == len(start) - 1) & (raw > 1.0))
            free_ends[take] = (open_end & (not self.closed))[take]
            best = np.minimum(best, distance)
        on_wall = best <= TOLERANCE * np.ptp(np.vstack([start, end]))
        return np.asarray((side > 0.0) & ~free_ends & ~on_wall)


class BoxWall(BaseModel):
    """A rectangular (2-D) or box-shaped (3-D) container around the fluid, with some faces left open."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    shape: Literal["box"] = "box"
    name: str = "wall"
    lower: tuple[float, ...] = Field(min_length=2, max_length=3)
    upper: tuple[float, ...] = Field(min_length=2, max_length=3)
    open_faces: tuple[Literal["-x", "+x", "-y", "+y", "-z", "+z"], ...] = ()
    body: str | None = None

    @model_validator(mode="after")
    def _box(self) -> "BoxWall":
        check_box(self.lower, self.upper)
        if self.dimension == 2 and any(face[1] == "z" for face in self.open_faces):
            raise ValueError(f"open_faces {self.open_faces} name z, but wall {self.name!r} is two-dimensional")
        return self

    @property
    def dimension(self) -> int:
        """Dimension of space."""
        return len(self.lower)

    def outline(self) -> list[Array]:
        """Polylines (k, dim) that draw the edges of the box, without those between two open faces."""
        low, high = np.array(self.lower), np.array(self.upper)
        lines = []
        for axis in range(self.dimension):
            others = [k for k in range(self.dimension) if k != axis]
            for ends in itertools.product((0, 1), repeat=self.dimension - 1):
                if all("-+"[end] + "xyz"[k] in self.open_faces for k, end in zip(others, ends, strict=True)):
                    continue
                first = np.where(np.insert(ends, axis, 0), high, low)
                second = np.where(np.insert(ends, axis, 1), high, low)
                lines.append(np.array([first, second]))
        return lines

    def _reach(self) -> tuple[Array, Array]:
        """Bounds of the closed part: an open face lies at infinity."""
        low, high = np.array(self.lower, dtype=np.float64), np.array(self.upper, dtype=np.float64)
        for sign, axis in self.open_faces:
            if sign == "-":
                low["xyz".index(axis)] = -np.inf
            else:
                high["xyz".index(axis)] = np.inf
        return low, high

    def candidates(self, spacing: float, layers: int) -> Array:
        """Return the positions (k, dim) in m where ghosts may stand, in ``layers`` of one ``spacing`` (m) each."""
        low, high = np.array(self.lower), np.array(self.upper)
        reach_low, reach_high = self._reach()
        counts = np.maximum(np.rint((high - low) / spacing).astype(int), 1)
        axes = []
        for k in range(self.dimension):
            step = (high[k] - low[k]) / counts[k]
            before = 0 if np.isinf(reach_low[k]) else layers
            after = 0 if np.isinf(reach_high[k]) else layers
            axes.append(low[k] + (np.arange(-before, counts[k] + after) + 0.5) * step)
        position = grid(axes)
        return position[np.any((position < reach_low) | (position > reach_high), axis=1)]

    def nearest(self, position: Array) -> tuple[Array, Array]:
        """Nearest wall points (n, dim) to outside ``position`` (n, dim) and the free-slip reflection matrices."""
        low, high = self._reach()
        foot = np.clip(position, low, high)
        crossed = (position < low) | (position > high)
        reflection = np.zeros((len(position), self.dimension, self.dimension))
        for k in range(self.dimension):
            reflection[:, k, k] = np.where(crossed[:, k], -1.0, 1.0)
        return foot, reflection

    def is_behind(self, position: Array) -> BoolArray:
        """Whether each ``position`` (n, dim) lies behind a closed face (outside the fluid)."""
        low, high = self._reach()
        on_wall = TOLERANCE * float(np.max(np.subtract(self.upper, self.lower)))
        return np.asarray(np.any((position < low - on_wall) | (position > high + on_wall), axis=1))


Wall = Annotated[PolygonWall | BoxWall, Field(discriminator="shape")]


def _corner_ghosts(corner: Array, t1: Array, n1: Array, t2: Array, n2: Array, depths: Array) -> Array:
    """Ghosts in the wedge behind a corner where the polyline turns left (the fluid's angle is below 180 degrees)."""
    turn = math.atan2(t1[0] * t2[1] - t1[1] * t2[0], float(t1 @ t2))
    if turn <= TOLERANCE:
        return np.empty((0, 2))
    if abs(turn - math.pi / 2) < 1e-6:  # a right angle: continue the lattice of both faces
        a, b = np.meshgrid(depths, depths, indexing="ij")
        return corner + a.reshape(-1, 1) * n1 + b.reshape(-1, 1) * n2
    # rings with whole numbers of ghosts, each as wide as the volume of its ghosts: more would repel the fluid
    rings = []
    spacing = 2.0 * depths[0]
    inner, ghosts = 0.0, 0
    for depth in depths:
        count = max(round(turn * depth / spacing), 1)
        ghosts += count
        outer = math.sqrt(2.0 * ghosts / turn) * spacing
        angle = math.atan2(n1[1], n1[0]) + turn * (np.arange(count) + 0.5) / count
        rings.append(corner + 0.5 * (inner + outer) * np.stack([np.cos(angle), np.sin(angle)], axis=1))
        inner = outer
    return np.vstack(rings)


def _reflections(offset: Array, at_corner: BoolArray) -> Array:
    """S = 1 - 2 n n^T along ``offset`` (n, 2), or -1 at corners."""
    normal = offset / np.maximum(np.linalg.norm(offset, axis=1, keepdims=True), 1e-300)
    identity = np.eye(2)
    plane = identity - 2.0 * normal[:, :, None] * normal[:, None, :]
    return np.where(at_corner[:, None, None], -identity, plane)
