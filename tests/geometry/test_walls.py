"""Ghosts, mirror points, panels and lattices against geometry."""

import math

import numpy as np
import pytest

from sphframe.geometry import BoxRegion, BoxWall, PolygonWall, wall_ghosts, wall_panels

TANK = PolygonWall(points=((0, 1), (0, 0), (2, 0), (2, 1)))


def leaning(angle):
    foot = 1.0 / math.tan(math.radians(180 - angle))
    return PolygonWall(points=((0, 1), (0, 0), (2, 0), (2 + foot, 1)))


@pytest.mark.parametrize("angle", [60, 90, 120, 150])
def test_mirror_points_lie_inside_at_the_same_distance(angle):
    wall = leaning(angle)
    ghosts = wall_ghosts((wall,), 0.05, 4)
    foot = 0.5 * (ghosts.position + ghosts.mirror)
    np.testing.assert_allclose(wall.nearest(foot)[0], foot, atol=1e-12)
    assert wall.is_behind(ghosts.position).all()
    if angle >= 90:
        assert not wall.is_behind(ghosts.mirror).any()


@pytest.mark.parametrize("angle", [60, 90, 120, 150])
def test_ghosts_fill_the_layers_evenly(angle):
    ghosts = wall_ghosts((leaning(angle),), 0.05, 4)
    length = 2 + 1 + 1 / math.sin(math.radians(180 - angle))
    turns = math.radians(90) + math.radians(180 - angle)
    wedges = 0.5 * turns * (4 * 0.05) ** 2
    expected = (length * 4 * 0.05 + wedges) / 0.05**2
    assert len(ghosts.position) == pytest.approx(expected, rel=0.05)
    gaps = np.linalg.norm(ghosts.position[:, None] - ghosts.position[None], axis=2)
    np.fill_diagonal(gaps, np.inf)
    assert gaps.min() > 0.49 * 0.05


def test_polygon_and_box_tank_have_the_same_ghosts():
    box = BoxWall(lower=(0, 0), upper=(2, 1), open_faces=("+y",))
    one, other = wall_ghosts((TANK,), 0.1, 4), wall_ghosts((box,), 0.1, 4)

    def key(ghosts):
        table = np.hstack([ghosts.position, ghosts.mirror, ghosts.reflection.reshape(-1, 4)]).round(9) + 0.0
        return table[np.lexsort(table.T)]

    np.testing.assert_allclose(key(one), key(other), atol=1e-9)


def test_reflections():
    ghosts = wall_ghosts((TANK,), 0.1, 2)
    at = {tuple(p): s for p, s in zip(ghosts.position.round(9), ghosts.reflection, strict=True)}
    np.testing.assert_allclose(at[-0.05, 0.55], [[-1, 0], [0, 1]], atol=1e-12)
    np.testing.assert_allclose(at[0.55, -0.05], [[1, 0], [0, -1]], atol=1e-12)
    np.testing.assert_allclose(at[-0.05, -0.05], [[-1, 0], [0, -1]], atol=1e-12)


def test_box_of_three_dimensions():
    wall = BoxWall(lower=(0, 0, 0), upper=(1, 1, 1), open_faces=("+z",))
    ghosts = wall_ghosts((wall,), 0.1, 4)
    assert len(ghosts.position) == 18 * 18 * 14 - 10**3
    assert not wall.is_behind(ghosts.mirror[np.all(ghosts.mirror[:, :2] < 1.0, axis=1)]).any()
    corner = np.argmin(np.linalg.norm(ghosts.position - [-0.05, -0.05, -0.05], axis=1))
    np.testing.assert_allclose(ghosts.mirror[corner], [0.05, 0.05, 0.05])
    np.testing.assert_allclose(ghosts.reflection[corner], -np.eye(3))


def inside_clockwise(convex, position):
    """Whether each position lies on the right of every edge."""
    start, end = convex.segments()
    edge, offset = end - start, position[:, None] - start
    return np.all(edge[:, 0] * offset[..., 1] < edge[:, 1] * offset[..., 0], axis=1)


def test_ghosts_of_an_obstacle_stay_inside_it():
    obstacle = PolygonWall(points=((0.4, 0.2), (0.4, 0.8), (0.9, 0.8), (1.0, 0.2)), closed=True)
    ghosts = wall_ghosts((obstacle,), 0.04, 4)
    assert inside_clockwise(obstacle, ghosts.position).all()
    assert not inside_clockwise(obstacle, ghosts.mirror).any()


def test_is_behind_knows_open_ends_and_corners():
    position = np.array([[-0.1, 0.5], [0.1, 0.5], [-0.1, 1.2], [-0.1, -0.1], [1.0, -0.2], [2.1, 0.5], [1.0, 3.0]])
    assert list(TANK.is_behind(position)) == [True, False, False, True, True, True, False]


@pytest.mark.parametrize(
    "wall", [leaning(120), BoxWall(lower=(0, 0), upper=(2, 1), open_faces=("+y",)), BoxWall(lower=(0, 0), upper=(2, 1))]
)
def test_panels_integrate_a_hydrostatic_pressure(wall):
    panels = wall_panels((wall,), 0.01)
    pressure = 2.0 - panels.centre[:, 1]
    force = (pressure[:, None] * panels.area).sum(axis=0)
    # closed with the missing lid, the force is the weight of the content; the lid bears (2 - 1) over its length
    if isinstance(wall, PolygonWall):
        lid = 2 + 1 / math.tan(math.radians(60))
        assert force[1] == pytest.approx(-(0.5 * (2 + lid) + lid), rel=1e-3)
    else:
        assert force[1] == pytest.approx(-2 * 2.0 if wall.open_faces else -2 * 2.0 + 2 * 1.0, rel=1e-9)
        assert force[0] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    "make",
    [
        lambda: BoxRegion(lower=(0, 1), upper=(1, 0)),
        lambda: BoxWall(lower=(0, 0), upper=(1, 1), open_faces=("+z",)),
        lambda: PolygonWall(points=((0, 0), (0, 0), (1, 0))),
    ],
)
def test_impossible_shapes_are_refused(make):
    with pytest.raises(ValueError, match=r"do not span|two-dimensional|equal points"):
        make()
