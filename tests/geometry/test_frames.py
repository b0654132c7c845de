"""Frames of rigid bodies: as drawn, and at present."""

import numpy as np
import pytest

from sphframe.geometry import directions_to_world, to_body_frame, to_world


@pytest.mark.parametrize("dim", [2, 3])
def test_to_body_frame_is_the_inverse_of_to_world(dim):
    rng = np.random.default_rng(1)
    points, centre, motion = rng.normal(size=(20, dim)), rng.normal(size=dim), rng.normal(size=3)
    np.testing.assert_allclose(to_body_frame(to_world(points, motion, centre), motion, centre), points, atol=1e-14)


def test_bodies_rotate_counter_clockwise_about_their_displaced_centre():
    motion, centre = np.array([10.0, 20.0, np.pi / 2]), np.array([1.0, 1.0])
    np.testing.assert_allclose(to_world(np.array([[2.0, 1.0]]), motion, centre), [[11.0, 22.0]])


def test_bodies_in_3d_do_not_rotate():
    motion, centre = np.array([1.0, 2.0, 3.0]), np.array([5.0, 5.0, 5.0])
    np.testing.assert_allclose(to_world(np.zeros((1, 3)), motion, centre), [[1.0, 2.0, 3.0]])


def test_directions_are_differences_of_points():
    ends, motion, centre = np.array([[1.0, 2.0], [4.0, 6.0]]), np.array([0.3, -0.2, 0.7]), np.array([1.0, 0.5])
    start, end = to_world(ends, motion, centre)
    np.testing.assert_allclose(directions_to_world(ends[1:] - ends[:1], motion), [end - start], atol=1e-14)


def test_directions_have_no_negative_zeros():
    turned = directions_to_world(np.array([[-0.0, 1.0]]), np.zeros(3))
    assert not np.signbit(turned).any()
