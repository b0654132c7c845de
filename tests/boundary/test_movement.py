"""Ghosts of turning bodies move on exact circles, with the velocities and accelerations of their motion."""

import numpy as np
import pytest
import shapely

from sphframe.bodies import Prescribed
from sphframe.boundary.boundary import Boundary
from sphframe.geometry import Box, BoxWall, Difference, Polygon, PolygonWall
from sphframe.interfaces import EvaluationPoint

OBSTACLE = ((0.0, 0.0), (0.0, 0.3), (0.4, 0.3), (0.5, 0.0))
RATE, CENTRE = 3.0, np.array([0.2, -0.1, 0.3])
AXIS = np.array([2.0, -1.0, 2.0]) / 3.0
DRIFT, FALL = np.array([0.4, 0.1, -0.3]), np.array([0.0, 0.5, -9.81])


def about_an_axis(time):
    """A rotation about AXIS at an angle RATE t^2, and a parabola of the centre."""
    shift = DRIFT * time + 0.5 * FALL * time**2
    return (
        [*shift, *(RATE * time**2 * AXIS)],
        [*(DRIFT + FALL * time), *(2.0 * RATE * time * AXIS)],
        [*FALL, *(2.0 * RATE * AXIS)],
    )


def in_the_plane(time):
    """The same in two dimensions."""
    shift = DRIFT * time + 0.5 * FALL * time**2
    return ([*shift[:2], RATE * time**2], [*(DRIFT + FALL * time)[:2], 2.0 * RATE * time], [*FALL[:2], 2.0 * RATE])


def turning(dim, time):
    """A box or an obstacle that turns, at ``time``."""
    if dim == 3:
        wall = BoxWall(lower=(0.0, 0.0, 0.0), upper=(0.4, 0.3, 0.5), body="body")
        body = Prescribed(about_an_axis, centre=tuple(CENTRE))
    else:
        wall = PolygonWall(points=OBSTACLE, closed=True, body="body")
        body = Prescribed(in_the_plane, centre=tuple(CENTRE[:2]))
    plane_sea = Difference(of=Box(lower=(-2, -2), upper=(3, 3)), minus=[Polygon(points=OBSTACLE)])
    sea = plane_sea if dim == 2 else Box(lower=(0.0, 0.0, 0.0), upper=(0.4, 0.3, 0.5))
    boundary = Boundary(
        (wall,), {"body": body}, EvaluationPoint.MIRROR, fluid=[sea], spacing=0.1, support=0.3, no_slip=False
    )
    drawn = boundary.position.copy(), boundary.mirror.copy(), boundary.reflection.copy()
    boundary.move([body.motion(time, *np.zeros((3, 3)))], np.zeros((boundary.count, 9)), np.zeros(dim), 1000.0)
    return boundary, drawn


def exact(points, time, dim):
    """Where ``points`` are, by the formula of Rodrigues."""
    angle = RATE * time**2
    shift = DRIFT * time + 0.5 * FALL * time**2
    if dim == 2:
        points, axis = np.column_stack([points, np.zeros(len(points))]), np.array([0.0, 0.0, 1.0])
    else:
        axis = AXIS
    centre = CENTRE * [1.0, 1.0, float(dim == 3)]
    r = points - centre
    turned = r * np.cos(angle) + np.cross(axis, r) * np.sin(angle) + np.outer(r @ axis, axis) * (1.0 - np.cos(angle))
    return (turned + centre + shift)[:, :dim]


def nearest(points, outline):
    """The points of a polyline that are nearest to ``points``."""
    line = shapely.LineString(outline)
    return shapely.get_coordinates(line.interpolate(line.project(shapely.points(points))))


@pytest.mark.parametrize("dim", [2, 3])
def test_ghosts_and_mirror_points_move_on_exact_circles(dim):
    boundary, (position, mirror, _) = turning(dim, 0.7)
    np.testing.assert_allclose(boundary.position, exact(position, 0.7, dim), atol=1e-13)
    np.testing.assert_allclose(boundary.mirror, exact(mirror, 0.7, dim), atol=1e-13)


@pytest.mark.parametrize("dim", [2, 3])
def test_velocity_and_acceleration_are_those_of_the_wall_point(dim):
    time, step = 0.7, 1e-4
    boundary, (position, mirror, _) = turning(dim, time)
    foot = nearest(position, OBSTACLE + OBSTACLE[:1]) if dim == 2 else 0.5 * (position + mirror)
    before, now, after = (exact(foot, t, dim) for t in (time - step, time, time + step))
    np.testing.assert_allclose(boundary.velocity, (after - before) / (2 * step), rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(boundary.acceleration, (after - 2 * now + before) / step**2, rtol=1e-5, atol=1e-4)


def test_in_an_acute_corner_the_wall_point_of_a_ghost_is_the_nearest_point_of_the_wall():
    """A wedge of 30 degrees that contains the fluid and turns; the mirror points near its edge are moved inwards."""
    rise = 2.0 * np.tan(np.pi / 6)
    wall = PolygonWall(points=((2, 0), (0, 0), (2, rise)), body="body")
    body = Prescribed(in_the_plane, centre=tuple(CENTRE[:2]))
    fluid = [Polygon(points=((0, 0), (1.8, 0), (1.8, 0.9 * rise)))]
    boundary = Boundary(
        (wall,), {"body": body}, EvaluationPoint.MIRROR, fluid=fluid, spacing=0.1, support=0.3, no_slip=False
    )
    position, mirror = boundary.position.copy(), boundary.mirror.copy()
    foot = nearest(position, wall.points)
    moved = np.linalg.norm(position + mirror - 2.0 * foot, axis=1) > 1e-6
    assert moved.sum() > 5
    time, step = 0.7, 1e-4
    boundary.move([body.motion(time, *np.zeros((3, 3)))], np.zeros((boundary.count, 9)), np.zeros(2), 1000.0)
    before, now, after = (exact(foot, t, 2) for t in (time - step, time, time + step))
    np.testing.assert_allclose(boundary.foot, now, atol=1e-13)
    np.testing.assert_allclose(boundary.foot + boundary.depth[:, None] * boundary.normal, boundary.position, atol=1e-13)
    np.testing.assert_allclose(boundary.velocity, (after - before) / (2 * step), rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(boundary.acceleration, (after - 2 * now + before) / step**2, rtol=1e-5, atol=1e-4)


@pytest.mark.parametrize("dim", [2, 3])
def test_reflections_turn_with_the_wall(dim):
    boundary, (position, _, reflection) = turning(dim, 0.7)
    rng = np.random.default_rng(0)
    vectors = rng.normal(size=position.shape)
    origin = np.zeros_like(position)
    present = exact(vectors, 0.7, dim) - exact(origin, 0.7, dim)  # the same vectors, turned
    mirrored = exact(np.einsum("gkm,gm->gk", reflection, vectors), 0.7, dim) - exact(origin, 0.7, dim)
    np.testing.assert_allclose(np.einsum("gkm,gm->gk", boundary.reflection, present), mirrored, atol=1e-12)
