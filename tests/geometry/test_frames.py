"""Frames of rigid bodies: as drawn, and at present."""

import numpy as np
import pytest

from sphframe.geometry import directions_to_world, rotation_matrix, to_body_frame, to_world, turned


@pytest.mark.parametrize("dim", [2, 3])
def test_to_body_frame_is_the_inverse_of_to_world(dim):
    rng = np.random.default_rng(1)
    points, centre, motion = rng.normal(size=(20, dim)), rng.normal(size=dim), rng.normal(size=3 * dim - 3)
    np.testing.assert_allclose(to_body_frame(to_world(points, motion, centre), motion, centre), points, atol=1e-14)


def test_bodies_rotate_counter_clockwise_about_their_displaced_centre():
    motion, centre = np.array([10.0, 20.0, np.pi / 2]), np.array([1.0, 1.0])
    np.testing.assert_allclose(to_world(np.array([[2.0, 1.0]]), motion, centre), [[11.0, 22.0]])


def test_bodies_in_3d_rotate_about_the_axis_of_their_rotation_vector():
    third = 2.0 * np.pi / 3.0 * np.ones(3) / np.sqrt(3.0)  # about the diagonal: x to y, y to z, z to x
    motion, centre = np.array([10.0, 20.0, 30.0, *third]), np.array([1.0, 1.0, 1.0])
    np.testing.assert_allclose(to_world(np.array([[2.0, 1.0, 1.0]]), motion, centre), [[11.0, 22.0, 31.0]])
    np.testing.assert_allclose(directions_to_world(np.eye(3), motion), np.eye(3)[[1, 2, 0]], atol=1e-14)


def test_rotations_are_composed_one_after_the_other():
    about_x, about_y = np.array([np.pi / 2, 0, 0]), np.array([0, np.pi / 2, 0])
    both = rotation_matrix(turned(about_x, about_y))
    np.testing.assert_allclose(both, rotation_matrix(about_y) @ rotation_matrix(about_x), atol=1e-14)
    np.testing.assert_allclose(both @ [0, 1, 0], [1, 0, 0], atol=1e-14)  # y to z to x


def test_directions_are_differences_of_points():
    ends, motion, centre = np.array([[1.0, 2.0], [4.0, 6.0]]), np.array([0.3, -0.2, 0.7]), np.array([1.0, 0.5])
    start, end = to_world(ends, motion, centre)
    np.testing.assert_allclose(directions_to_world(ends[1:] - ends[:1], motion), [end - start], atol=1e-14)


def test_directions_have_no_negative_zeros():
    turned = directions_to_world(np.array([[-0.0, 1.0]]), np.zeros(3))
    assert not np.signbit(turned).any()
