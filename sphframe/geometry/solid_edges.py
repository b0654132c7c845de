"""Geometry: faces, sharp edges and corners of walls in three dimensions, and how ghosts behind them are reflected."""

from typing import NamedTuple

import numpy as np

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.geometry.domain import OPEN, SHARP
from sphframe.geometry.ghosts import NONE
from sphframe.geometry.solid_domain import Feet, SolidDomain


class Place(NamedTuple):
    """Walls to which ghosts belong, and their reflections; see :class:`~sphframe.geometry.ghosts.GhostPoints`."""

    wall: IntArray
    normal: Array
    reflection: Array
    other: IntArray
    other_normal: Array
    other_dual: Array


class SolidEdges:
    """Sharp edges and corners of the boundary of a ``domain``; points closer than ``same`` (m) are the same."""

    def __init__(self, domain: SolidDomain, same: float) -> None:
        surface = domain.surface
        self._surface, self._wall, self._same = surface, domain.wall, same
        pairs, edges = surface.face_adjacency, surface.face_adjacency_edges
        walled = (domain.wall[pairs] != OPEN).all(axis=1)
        sharp = walled & (surface.face_adjacency_angles > SHARP)
        along = surface.vertices[edges[:, 1]] - surface.vertices[edges[:, 0]]
        along /= np.linalg.norm(along, axis=1)[:, None]
        # for each triangle and the edge opposite to each of its corners: the neighbour there, NONE across smooth edges
        self._across = np.full((len(surface.faces), 3), NONE)
        self._direction = np.zeros((len(surface.faces), 3, 3))
        for side in (0, 1):
            face = pairs[sharp, side]
            opposite = np.argmax(~(surface.faces[face][:, :, None] == edges[sharp][:, None, :]).any(axis=2), axis=1)
            self._across[face, opposite] = pairs[sharp, 1 - side]
            self._direction[face, opposite] = along[sharp]
        # at each vertex: the sum of t t^T over its sharp edges, whose eigenvalues tell a corner from an edge
        spread = np.zeros((len(surface.vertices), 3, 3))
        for end in (0, 1):
            np.add.at(spread, edges[sharp, end], along[sharp, :, None] * along[sharp, None, :])
        value, vector = np.linalg.eigh(spread)
        self._on_edge = value[:, 2] > 0.0
        self._corner = value[:, 1] > np.sin(SHARP) ** 2 * value[:, 2]
        self._vertex_direction = vector[:, :, 2]
        self._vertex_triangles = [_extreme(surface.faces, domain.wall, len(surface.vertices), sign) for sign in (1, -1)]

    def at(self, feet: Feet, position: Array) -> Place:
        """Return the place of ghosts at ``position`` (g, 3), whose nearest points on the boundary are ``feet``."""
        surface, triangle = self._surface, feet.triangle
        offset = position - feet.point
        distance = np.linalg.norm(offset, axis=1)[:, None]
        normal = np.where(distance > self._same, offset / np.maximum(distance, 1e-300), surface.face_normals[triangle])
        first, second = triangle.copy(), np.full(len(triangle), NONE)
        direction, corner = np.zeros_like(position), np.zeros(len(triangle), dtype=np.bool_)
        edge = np.zeros(len(triangle), dtype=np.bool_)
        vertices = surface.triangles[triangle]
        for k in range(3):  # the edge opposite to corner k
            start, stop = vertices[:, (k + 1) % 3], vertices[:, (k + 2) % 3]
            along = (stop - start) / np.linalg.norm(stop - start, axis=1)[:, None]
            beside = np.linalg.norm(np.cross(feet.point - start, along), axis=1)
            here = (beside <= self._same) & (self._across[triangle, k] != NONE)
            second[here], direction[here] = self._across[triangle, k][here], self._direction[triangle, k][here]
            edge |= here
        for k in range(3):
            number = surface.faces[triangle, k]
            here = (np.linalg.norm(feet.point - vertices[:, k], axis=1) <= self._same) & self._on_edge[number]
            first[here], second[here] = (chosen[number[here]] for chosen in self._vertex_triangles)
            direction[here], corner[here] = self._vertex_direction[number[here]], self._corner[number[here]]
            edge |= here
        identity = np.eye(3)
        reflection = identity - 2.0 * normal[:, :, None] * normal[:, None, :]
        turned = 2.0 * direction[:, :, None] * direction[:, None, :] - identity
        reflection = np.where(edge[:, None, None], np.where(corner[:, None, None], -identity, turned), reflection)
        shared = edge & (self._wall[first] != self._wall[second])
        return Place(self._wall[first], normal, reflection, *self._shares(first, second, shared))

    def _shares(self, first: IntArray, second: IntArray, shared: BoolArray) -> tuple[IntArray, Array, Array]:
        normal, other = self._surface.face_normals[first], self._surface.face_normals[second]
        cosine = np.einsum("ij,ij->i", normal, other)[:, None]
        dual = (other - cosine * normal) / np.maximum(1.0 - cosine**2, 1e-12)
        only = shared[:, None]
        return np.where(shared, self._wall[second], NONE), np.where(only, other, 0.0), np.where(only, dual, 0.0)


def _extreme(triangles: IntArray, wall: IntArray, count: int, sign: int) -> IntArray:
    """Return for each vertex (count,) the triangle of the wall with the lowest (``sign`` 1) or highest (-1) index."""
    order = np.argsort(-sign * wall, kind="stable")
    order = order[wall[order] != OPEN]
    found = np.zeros(count, np.int64)
    found[triangles[order]] = order[:, None]  # the last one counts
    return found
