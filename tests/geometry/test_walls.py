"""Ghosts, mirror points, panels and lattices against geometry."""

import math

import numpy as np
import pytest

from sphframe.geometry import Box, BoxWall, Difference, Polygon, PolygonWall, wall_groups

TANK = PolygonWall(points=((0, 1), (0, 0), (2, 0), (2, 1)))
WATER = Box(lower=(0.1, 0.1), upper=(1.4, 0.4))


def group_of(*walls, fluid=WATER, spacing=0.05):
    (_, group), *others = wall_groups(walls, [fluid], spacing)
    assert not others
    return group


def leaning(angle):
    foot = 1.0 / math.tan(math.radians(180 - angle))
    return PolygonWall(points=((0, 1), (0, 0), (2, 0), (2 + foot, 1)))


@pytest.mark.parametrize("angle", [60, 90, 120, 150])
def test_mirror_points_lie_inside_at_the_same_distance(angle):
    group = group_of(leaning(angle))
    ghosts = group.ghosts(0.05, 4)
    foot, _ = group.domain.feet(ghosts.position)
    inside = np.hypot(*(0.5 * (ghosts.position + ghosts.mirror) - foot).T) < 1e-12
    assert group.behind(ghosts.position).all()
    assert not group.behind(ghosts.mirror).any()
    assert inside.all() if angle >= 90 else inside.mean() > 0.9
    depth = np.hypot(*(ghosts.mirror - group.domain.feet(ghosts.mirror)[0]).T)
    assert depth.min() > 0.02


@pytest.mark.parametrize("angle", [60, 90, 120, 150])
def test_ghosts_fill_the_layers_evenly(angle):
    ghosts = group_of(leaning(angle)).ghosts(0.05, 4)
    length = 2 + 1 + 1 / math.sin(math.radians(180 - angle))
    mitres = math.tan(math.radians(45)) + math.tan(math.radians(90 - 0.5 * angle))
    assert ghosts.volume.sum() == pytest.approx(length * 4 * 0.05 + mitres * (4 * 0.05) ** 2, rel=0.01)
    np.testing.assert_allclose(ghosts.volume, 0.05**2, rtol=0.45)
    gaps = np.linalg.norm(ghosts.position[:, None] - ghosts.position[None], axis=2)
    np.fill_diagonal(gaps, np.inf)
    assert gaps.min() > 0.49 * 0.05


def test_polygon_and_box_tank_have_the_same_ghosts():
    box = BoxWall(lower=(0, 0), upper=(2, 1), open_faces=("+y",))
    one, other = group_of(TANK).ghosts(0.1, 4), group_of(box).ghosts(0.1, 4)

    def key(ghosts):
        table = np.hstack([ghosts.position, ghosts.mirror, ghosts.reflection.reshape(-1, 4)]).round(9) + 0.0
        return table[np.lexsort(table.T)]

    np.testing.assert_allclose(key(one), key(other), atol=1e-9)


def test_reflections():
    ghosts = group_of(TANK).ghosts(0.1, 2)
    at = {tuple(p): s for p, s in zip(ghosts.position.round(9), ghosts.reflection, strict=True)}
    np.testing.assert_allclose(at[-0.05, 0.55], [[-1, 0], [0, 1]], atol=1e-12)
    np.testing.assert_allclose(at[0.55, -0.05], [[1, 0], [0, -1]], atol=1e-12)
    np.testing.assert_allclose(at[-0.05, -0.05], [[-1, 0], [0, -1]], atol=1e-12)


def test_box_of_three_dimensions():
    wall = BoxWall(lower=(0, 0, 0), upper=(1, 1, 1), open_faces=("+z",))
    group = group_of(wall, fluid=Box(lower=(0, 0, 0), upper=(1, 1, 0.5)))
    ghosts = group.ghosts(0.1, 4)
    assert len(ghosts.position) == 18 * 18 * 14 - 10**3
    assert not group.behind(ghosts.mirror[np.all(ghosts.mirror[:, :2] < 1.0, axis=1)]).any()
    corner = np.argmin(np.linalg.norm(ghosts.position - [-0.05, -0.05, -0.05], axis=1))
    np.testing.assert_allclose(ghosts.mirror[corner], [0.05, 0.05, 0.05])
    np.testing.assert_allclose(ghosts.reflection[corner], -np.eye(3))


def inside_clockwise(convex, position):
    """Whether each position lies on the right of every edge."""
    points = convex.outline()[0]
    edge, offset = np.diff(points, axis=0), position[:, None] - points[:-1]
    return np.all(edge[:, 0] * offset[..., 1] < edge[:, 1] * offset[..., 0], axis=1)


def test_ghosts_of_an_obstacle_stay_inside_it():
    obstacle = PolygonWall(points=((0.4, 0.2), (0.4, 0.8), (0.9, 0.8), (1.0, 0.2)), closed=True)
    water = Difference(of=Box(lower=(-1, -1), upper=(2, 2)), minus=[Polygon(points=obstacle.points)])
    ghosts = group_of(obstacle, fluid=water).ghosts(0.04, 4)
    assert inside_clockwise(obstacle, ghosts.position).all()
    assert not inside_clockwise(obstacle, ghosts.mirror).any()


def test_what_is_behind_knows_open_ends_and_corners():
    position = np.array([[-0.1, 0.5], [0.1, 0.5], [-0.1, 1.2], [-0.1, -0.1], [1.0, -0.2], [2.1, 0.5], [1.0, 3.0]])
    assert list(group_of(TANK).behind(position)) == [True, False, False, True, True, True, False]


@pytest.mark.parametrize(
    "wall", [leaning(120), BoxWall(lower=(0, 0), upper=(2, 1), open_faces=("+y",)), BoxWall(lower=(0, 0), upper=(2, 1))]
)
def test_panels_integrate_a_hydrostatic_pressure(wall):
    panels = group_of(wall).panels(0.01)
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
        lambda: Box(lower=(0, 1), upper=(1, 0)),
        lambda: BoxWall(lower=(0, 0), upper=(1, 1), open_faces=("+z",)),
        lambda: PolygonWall(points=((0, 0), (0, 0), (1, 0))),
        lambda: PolygonWall(points=((0, 0), (1, 1), (1, 0), (0, 1)), closed=True),
        lambda: PolygonWall(points=((0, 0), (1, 1), (1, 0), (0, 1))),
        lambda: PolygonWall(points=((0, 0), (1, 0), (2, 0)), closed=True),
        lambda: PolygonWall(points=((0, 0), (math.nan, 0))),
    ],
)
def test_impossible_shapes_are_refused(make):
    with pytest.raises(
        ValueError, match=r"do not span|two-dimensional|equals the one before|itself at \(0.5, 0.5\)|one line|finite"
    ):
        make()


def test_the_direction_in_which_a_wall_is_drawn_does_not_matter():
    one, other = (group_of(PolygonWall(points=points)).ghosts(0.05, 4) for points in (TANK.points, TANK.points[::-1]))
    order, other_order = (np.lexsort(ghosts.position.round(9).T) for ghosts in (one, other))
    for name in ("position", "mirror", "reflection", "volume"):
        np.testing.assert_allclose(getattr(one, name)[order], getattr(other, name)[other_order], atol=1e-12)


def test_a_corner_between_two_walls_is_shared():
    left, bed = PolygonWall(name="left", points=((0, 1), (0, 0))), PolygonWall(name="bed", points=((0, 0), (2, 0)))
    ghosts = group_of(left, bed).ghosts(0.1, 2)
    corner = np.all(ghosts.position < 0.0, axis=1)
    assert corner.sum() == 4
    np.testing.assert_array_equal(ghosts.other[~corner], -1)
    first = np.array([[-1.0, 0.0], [0.0, -1.0]])[ghosts.wall[corner]]
    np.testing.assert_array_equal(ghosts.wall[corner] + ghosts.other[corner], 1)
    np.testing.assert_allclose(np.einsum("ij,ij->i", ghosts.other_dual[corner], first), 0.0, atol=1e-12)
    np.testing.assert_allclose(np.einsum("ij,ij->i", ghosts.other_dual[corner], ghosts.other_normal[corner]), 1.0)
