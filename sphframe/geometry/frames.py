"""Geometry: between the frame in which a rigid body was drawn and where the body is at present.

::

    x = c + X + R (x0 - c),        R = [[cos, -sin], [sin, cos]] in 2-D

with the body's centre c as drawn, its displacement X and its rotation R about the centre, by an angle in 2-D and by a
rotation vector in 3-D.

In each function, ``motion_position`` is the body's position in generalised coordinates, see
:class:`~sphframe.interfaces.Motion`: ``(x, y, angle)`` in (m, m, rad) in 2-D, ``(x, y, z, rx, ry, rz)`` in 3-D.
``centre`` (dim,) is in m.
"""

import math
from typing import Any

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


def moments(arms: Array, forces: Array) -> Array:
    """Return arm x force for each of n pairs, shape (n, 1) in 2-D and (n, 3) in 3-D."""
    if arms.shape[1] == 2:
        return (arms[:, 0] * forces[:, 1] - arms[:, 1] * forces[:, 0])[:, None]
    return np.cross(arms, forces)


def turning_velocities(omega: Array, arms: Array) -> Array:
    """Return omega x arm (n, dim) for an angular velocity, shape (1,) in 2-D and (3,) in 3-D, rad/s."""
    if arms.shape[1] == 2:
        return np.asarray(omega[0] * np.column_stack([-arms[:, 1], arms[:, 0]]))
    return np.cross(omega, arms)


def rotation_matrix(rotation: Array) -> Array:
    """Return the matrix (3, 3) of a rotation vector (3,), in rad.

    >>> rotation_matrix(np.array([0.0, 0.0, np.pi / 2])).round(3) @ np.array([1.0, 0.0, 0.0])
    array([0., 1., 0.])
    """
    matrix: Array = _rotation(rotation).as_matrix()
    return matrix


def turned(rotation: Array, by: Array) -> Array:
    """Return the rotation vector (3,) of ``rotation`` followed by the rotation ``by``, composed as quaternions."""
    vector: Array = (_rotation(by) * _rotation(rotation)).as_rotvec()
    return vector


def _rotation(vector: Array) -> Any:
    from scipy.spatial.transform import Rotation  # slow to import, and not needed in 2-D

    return Rotation.from_rotvec(vector)


def _rotated(vectors: Array, motion_position: Array, sense: float) -> Array:
    """Rotate ``vectors`` (n, dim) by the rotation of the motion, or back where ``sense`` is -1."""
    if vectors.shape[1] == 3:
        matrix = rotation_matrix(sense * motion_position[3:])
    else:
        cos, sin = math.cos(motion_position[2]), sense * math.sin(motion_position[2])
        matrix = np.array([[cos, -sin], [sin, cos]])
    rotated: Array = vectors @ matrix.T
    return rotated
