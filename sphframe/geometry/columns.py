"""Geometry: the parts of lattice cells inside a closed triangle mesh, found along vertical columns."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from sphframe.arrays import Array, IntArray

_PARTS = 4
"""parts along each edge into which a cell is divided"""


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

    Each cell is divided into columns; along these, its content is exact.

    Parameters
    ----------
    mesh: a watertight ``trimesh.Trimesh``.
    axes: centres and widths of the cells along each axis, m.

    Returns
    -------
    For each part: the index of its cell, its centre (3,), m, and its volume, m3.
    """
    share = (np.arange(_PARTS) + 0.5) / _PARTS - 0.5
    x, y, z = ((centre[:, None] + share * width[:, None]).ravel() for centre, width in axes)
    counts = [len(centre) for centre, _ in axes]
    thickness = np.repeat(axes[2][1], _PARTS) / _PARTS
    bottom, top = z - 0.5 * thickness, z + 0.5 * thickness
    column, low, high = _intervals(mesh.triangles, x, y)
    for layer in range(counts[0]):
        inside = slice(*np.searchsorted(column, np.array([layer, layer + 1]) * _PARTS * len(y)))
        first = np.searchsorted(top, low[inside], side="right")
        number = np.maximum(np.searchsorted(bottom, high[inside]) - first, 0)
        pair, rank = _expanded(number)
        k = first[pair] + rank
        floor, ceiling = np.maximum(bottom[k], low[inside][pair]), np.minimum(top[k], high[inside][pair])
        i, j = np.divmod(column[inside][pair], len(y))
        area = axes[0][1][layer] * axes[1][1][j // _PARTS] / _PARTS**2
        cell = (layer * counts[1] + j // _PARTS) * counts[2] + k // _PARTS
        yield cell, np.stack([x[i], y[j], 0.5 * (floor + ceiling)], axis=1), (ceiling - floor) * area


def _intervals(triangles: Array, x: Array, y: Array) -> tuple[IntArray, Array, Array]:
    """Return the intervals inside the mesh along the vertical line at each (x, y): number of the line, and both ends.

    Whether a line meets a triangle is decided edge by edge, and for an edge that two triangles share in the same way,
    so that each line enters the mesh as often as it leaves it.
    """
    corner = triangles[:, :, :2]
    first_i, last_i = np.searchsorted(x, corner[:, :, 0].min(axis=1)), np.searchsorted(x, corner[:, :, 0].max(axis=1))
    first_j, last_j = np.searchsorted(y, corner[:, :, 1].min(axis=1)), np.searchsorted(y, corner[:, :, 1].max(axis=1))
    t, rank = _expanded((last_i - first_i) * (last_j - first_j))
    i, j = first_i[t] + rank // (last_j - first_j)[t], first_j[t] + rank % (last_j - first_j)[t]
    met = np.zeros(len(t), dtype=np.bool_)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        swap = np.lexsort(np.stack([corner[:, [a, b], 0], corner[:, [a, b], 1]]), axis=-1)[:, 0] == 1
        start, stop = (np.where(swap[:, None], corner[:, q], corner[:, p])[t] for p, q in ((a, b), (b, a)))
        between = (start[:, 1] > y[j]) != (stop[:, 1] > y[j])
        slope = (stop[:, 0] - start[:, 0]) / np.where(between, stop[:, 1] - start[:, 1], 1.0)
        met ^= between & (x[i] < start[:, 0] + (y[j] - start[:, 1]) * slope)
    t, i, j = t[met], i[met], j[met]
    origin, u, v = triangles[t, 0], triangles[t, 1] - triangles[t, 0], triangles[t, 2] - triangles[t, 0]
    normal = np.cross(u, v)
    offset = (x[i] - origin[:, 0]) * normal[:, 0] + (y[j] - origin[:, 1]) * normal[:, 1]
    height = origin[:, 2] - offset / np.where(normal[:, 2] == 0.0, 1.0, normal[:, 2])
    height = np.clip(height, triangles[t, :, 2].min(axis=1), triangles[t, :, 2].max(axis=1))
    line = i * len(y) + j
    order = np.lexsort((height, line))
    return line[order][::2], height[order][::2], height[order][1::2]


def _expanded(number: IntArray) -> tuple[IntArray, IntArray]:
    """Repeat each k ``number[k]`` times, and count from zero within each."""
    owner = np.repeat(np.arange(len(number)), number)
    return owner, np.arange(len(owner)) - np.repeat(np.cumsum(number) - number, number)
