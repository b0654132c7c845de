"""Geometry: walls of three dimensions as closed surfaces of triangles, open faces continued far beyond the wall."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.geometry.domain import SHARP


class WallSolid(NamedTuple):
    """A closed surface: ``vertices`` (v, 3), m; ``triangles`` (t, 3), facing outwards; which of them are ``open`` (t,).

    An open triangle bounds the solid where the wall has an open face, far beyond it, or continues the wall up to there.
    """

    vertices: Array
    triangles: IntArray
    open: BoolArray


def box_solid(lower: Sequence[float], upper: Sequence[float], open_faces: Sequence[str], far: float) -> WallSolid:
    """Return a box, continued by ``far`` (m) across its ``open_faces``, such as ``"+z"``."""
    reach = [[far * (sign + axis in open_faces) for sign in "-+"] for axis in "xyz"]
    inner = np.array([lower, upper], dtype=np.float64).T
    places = [
        np.unique([*pair, pair[0] - below, pair[1] + above]) for pair, (below, above) in zip(inner, reach, strict=True)
    ]
    corners, is_open = [], []
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, -1):
            for i in range(len(places[a]) - 1):
                for j in range(len(places[b]) - 1):
                    square = np.empty((4, 3))
                    square[:, axis] = places[axis][side]
                    square[:, a] = places[a][[i, i + 1, i + 1, i]]
                    square[:, b] = places[b][[j, j, j + 1, j + 1]]
                    corners.append(square if side else square[::-1])
                    middle = square.mean(axis=0)
                    is_open.append(bool(np.any((middle < inner[:, 0]) | (middle > inner[:, 1]))))
    vertices, index = np.unique(np.concatenate(corners), axis=0, return_inverse=True)
    squares = index.reshape(-1, 4)
    triangles = np.concatenate([squares[:, [0, 1, 2]], squares[:, [0, 2, 3]]])
    return WallSolid(vertices, triangles, np.tile(is_open, 2))


def cylinder_solid(
    start: Sequence[float], stop: Sequence[float], circle: Array, open_ends: Sequence[str], far: float
) -> WallSolid:
    """Return a cylinder whose section is a ``circle`` (n, 2), m, continued by ``far`` (m) beyond its ``open_ends``."""
    ends = np.array([start, stop], dtype=np.float64)
    along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    across = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    across /= np.linalg.norm(across)
    ring = circle @ np.array([across, np.cross(along, across)])
    places = [end + ring for end in ends]
    flags = [False]
    if "start" in open_ends:
        places, flags = [places[0] - far * along, *places], [True, *flags]
    if "stop" in open_ends:
        places, flags = [*places, places[-1] + far * along], [*flags, True]
    n, k = len(ring), np.arange(len(ring))
    after = (k + 1) % n
    triangles, is_open = [], []
    for level, flag in enumerate(flags):
        base = level * n
        triangles += [np.stack([base + k, base + after, base + n + after], axis=1)]
        triangles += [np.stack([base + k, base + n + after, base + n + k], axis=1)]
        is_open += [np.full(2 * n, flag)]
    fan = np.stack([np.zeros(n - 2, dtype=np.int64), k[1:-1], k[2:]], axis=1)
    triangles += [fan[:, ::-1], fan + len(flags) * n]
    is_open += [np.full(n - 2, flags[0] and "start" in open_ends), np.full(n - 2, "stop" in open_ends)]
    return WallSolid(np.concatenate(places), np.concatenate(triangles), np.concatenate(is_open))


def drawn_lines(mesh: Any) -> list[Array]:
    """Return polylines (k, 3), m, that show a ``mesh``: its sharp edges, and three sections through its middle."""
    edges = mesh.face_adjacency_edges[mesh.face_adjacency_angles > SHARP]
    middle = mesh.bounds.mean(axis=0)
    sections = [mesh.section(plane_normal=normal, plane_origin=middle) for normal in np.eye(3)]
    return [*mesh.vertices[edges], *(line for section in sections if section is not None for line in section.discrete)]
