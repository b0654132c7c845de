"""Geometry: the parts of lattice cells inside a closed triangle mesh, found along vertical columns."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from sphframe.arrays import Array, IntArray

_PARTS, _LEVELS = 6, 4
"""parts along x and y, and along z, into which a cell is divided"""
_SHARE = (np.arange(_PARTS) + 0.5) / _PARTS - 0.5
"""middles of the parts, from the middle of the cell, over its width"""


def straight_faces(mesh: Any) -> list[tuple[int, float]]:
    """Return (axis, coordinate) of the faces of a mesh that are perpendicular to an axis, the largest first."""
    found: dict[tuple[int, float], float] = {}
    for axis in range(3):
        for k in np.flatnonzero(np.abs(mesh.face_normals[:, axis]) > 1.0 - 1e-9):
            place = axis, float(mesh.triangles[k, 0, axis])
            found[place] = found.get(place, 0.0) + float(mesh.area_faces[k])
    return sorted(found, key=lambda place: (-found[place], place))


def parts_inside(mesh: Any, axes: Sequence[tuple[Array, Array]]) -> Iterator[tuple[IntArray, Array, Array]]:
    """Yield the parts of the cells of a lattice that are inside a mesh, layer by layer along x.

    Each cell is divided into 36 columns; along these, its content is exact. They stand on a sheared square lattice, on
    which no two columns of a cell have the same x or the same y, so that faces across x or y are found to 1/36 too.

    Parameters
    ----------
    mesh
        a watertight ``trimesh.Trimesh``.
    axes
        centres and widths of the cells along each axis, m.

    Returns
    -------
    Iterator[tuple[IntArray, Array, Array]]
        For each part: the index of its cell, its centre (3,), m, and its volume, m3.
    """
    x, y = ((centre[:, None] + _SHARE * width[:, None]).ravel() for centre, width in axes[:2])
    counts = [len(centre) for centre, _ in axes]
    thickness = np.repeat(axes[2][1], _LEVELS) / _LEVELS
    top = axes[2][0][0] - 0.5 * axes[2][1][0] + np.cumsum(thickness)
    bottom = top - thickness
    column, low, high = _intervals(mesh.triangles, axes)
    for layer in range(counts[0]):
        inside = slice(*np.searchsorted(column, np.array([layer, layer + 1]) * _PARTS * len(y)))
        first = np.searchsorted(top, low[inside], side="right")
        number = np.maximum(np.searchsorted(bottom, high[inside]) - first, 0)
        pair, rank = _expanded(number)
        k = first[pair] + rank
        floor, ceiling = np.maximum(bottom[k], low[inside][pair]), np.minimum(top[k], high[inside][pair])
        i, j = np.divmod(column[inside][pair], len(y))
        area = axes[0][1][layer] * axes[1][1][j // _PARTS] / _PARTS**2
        cell = (layer * counts[1] + j // _PARTS) * counts[2] + k // _LEVELS
        at = *_sheared(x, y, axes, i, j), 0.5 * (floor + ceiling)
        yield cell, np.stack(at, axis=1), (ceiling - floor) * area


def _sheared(x: Array, y: Array, axes: Sequence[tuple[Array, Array]], i: IntArray, j: IntArray) -> tuple[Array, Array]:
    """Return the coordinates (n,) of the columns ``i``, ``j``, which stand on parts with the middles ``x``, ``y``."""
    (_, width), (_, breadth) = axes[:2]
    shift_x = width[i // _PARTS] / _PARTS * _SHARE[j % _PARTS]
    shift_y = breadth[j // _PARTS] / _PARTS * _SHARE[i % _PARTS]
    return x[i] + shift_x, y[j] + shift_y


def _intervals(triangles: Array, axes: Sequence[tuple[Array, Array]]) -> tuple[IntArray, Array, Array]:
    """Return the intervals inside the mesh along each vertical column: number of the column, and both ends.

    Whether a line meets a triangle is decided edge by edge, and for an edge that two triangles share in the same way,
    so that each line enters the mesh as often as it leaves it.
    """
    corner, ranges, middles = triangles[:, :, :2], [], []
    for axis, (centre, width) in enumerate(axes[:2]):
        middle, half = (centre[:, None] + _SHARE * width[:, None]).ravel(), 0.5 * np.repeat(width, _PARTS) / _PARTS
        middles.append(middle)
        ranges.append(np.searchsorted(middle + half, corner[:, :, axis].min(axis=1)))
        ranges.append(np.searchsorted(middle - half, corner[:, :, axis].max(axis=1)))
    first_i, last_i, first_j, last_j = ranges
    t, rank = _expanded((last_i - first_i) * (last_j - first_j))
    i, j = first_i[t] + rank // (last_j - first_j)[t], first_j[t] + rank % (last_j - first_j)[t]
    x, y = _sheared(middles[0], middles[1], axes, i, j)
    met = np.zeros(len(t), dtype=np.bool_)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        swap = np.lexsort(np.stack([corner[:, [a, b], 0], corner[:, [a, b], 1]]), axis=-1)[:, 0] == 1
        start, stop = (np.where(swap[:, None], corner[:, q], corner[:, p])[t] for p, q in ((a, b), (b, a)))
        between = (start[:, 1] > y) != (stop[:, 1] > y)
        slope = (stop[:, 0] - start[:, 0]) / np.where(between, stop[:, 1] - start[:, 1], 1.0)
        met ^= between & (x < start[:, 0] + (y - start[:, 1]) * slope)
    t, i, j, x, y = t[met], i[met], j[met], x[met], y[met]
    origin, u, v = triangles[t, 0], triangles[t, 1] - triangles[t, 0], triangles[t, 2] - triangles[t, 0]
    normal = np.cross(u, v)
    offset = (x - origin[:, 0]) * normal[:, 0] + (y - origin[:, 1]) * normal[:, 1]
    height = origin[:, 2] - offset / np.where(normal[:, 2] == 0.0, 1.0, normal[:, 2])
    height = np.clip(height, triangles[t, :, 2].min(axis=1), triangles[t, :, 2].max(axis=1))
    line = i * len(middles[1]) + j
    order = np.lexsort((height, line))
    return line[order][::2], height[order][::2], height[order][1::2]


def _expanded(number: IntArray) -> tuple[IntArray, IntArray]:
    """Repeat each k ``number[k]`` times, and count from zero within each."""
    owner = np.repeat(np.arange(len(number)), number)
    return owner, np.arange(len(owner)) - np.repeat(np.cumsum(number) - number, number)
