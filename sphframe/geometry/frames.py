"""Geometry: between the frame in which a rigid body was drawn and where the body is at present.

::

    x = c + X + R(angle) (x0 - c),        R = [[cos, -sin], [sin, cos]]

with the body's centre c as drawn, its displacement X and, in 2-D, its rotation by the angle about the centre.

In each function, ``motion_position`` (3,) is the body's position in generalised coordinates: ``(x, y, angle)`` in
(m, m, rad) in 2-D, ``(x, y, z)`` in m in 3-D, where bodies do not rotate. ``centre`` (dim,) is in m.
"""

import math

import numpy as np

from sphframe.arrays import Array


def to_world(points: Array, motion_position: Array, centre: Array) -> Array:
    """Return the present positions (n, dim) of ``points`` (n, dim) that are given as drawn, all in m.

    Examples
    --------
    >>> quarter_turn = np.array([1.0, 0.0, np.pi / 2])
    >>> to_world(np.array([[2.0, 0.0]]), quarter_turn, np.array([0.0, 0.0])).round(3)
    array([[1., 2.]])
    """
    return _rotated(points - centre, motion_position, 1.0) + centre + motion_position[: points.shape[1]]


def directions_to_world(directions: Array, motion_position: Array) -> Array:
    """Return vectors (n, dim) such as normals and areas, given as drawn, with their present directions."""
    return _rotated(directions, motion_position, 1.0) + 0.0  # the sum turns -0.0 into 0.0


def to_body_frame(points: Array, motion_position: Array, centre: Array) -> Array:
    """Return present positions ``points`` (n, dim) in the frame in which the body was drawn, all in m.

    It is the inverse of :func:`to_world`.
    """
    return _rotated(points - centre - motion_position[: points.shape[1]], motion_position, -1.0) + centre


def _rotated(vectors: Array, motion_position: Array, sense: float) -> Array:
    """Rotate ``vectors`` (n, dim) by the angle of the motion, or back where ``sense`` is -1."""
    if vectors.shape[1] == 3:
        return vectors
    cos, sin = math.cos(motion_position[2]), sense * math.sin(motion_position[2])
    rotated: Array = vectors @ np.array([[cos, sin], [-sin, cos]])
    return rotated
