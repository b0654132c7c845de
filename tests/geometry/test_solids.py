"""Area, centroid and moments of solids, against closed forms."""

import math

import numpy as np
import pytest
import shapely
import trimesh

from sphframe.geometry import Box, PolygonWall, solid_of, solid_within
from sphframe.geometry.walls import CircleWall, EllipseWall, PolylineWall, UnionWall


@pytest.mark.parametrize("clockwise", [False, True])
def test_a_turned_rectangle(clockwise):
    corners = np.array([[-0.3, -0.1], [0.3, -0.1], [0.3, 0.1], [-0.3, 0.1]])[:: -1 if clockwise else 1]
    turn = np.array([[math.cos(0.4), -math.sin(0.4)], [math.sin(0.4), math.cos(0.4)]])
    solid = solid_of(shapely.Polygon(corners @ turn.T + [5.0, -3.0]))
    assert solid.volume == pytest.approx(0.12)
    assert solid.centroid == pytest.approx([5.0, -3.0])
    assert solid.moments == pytest.approx(np.array([[0.12 * (0.6**2 + 0.2**2) / 12.0]]))


def test_a_triangle():
    # polar moment about the centroid: area / 36 times the sum of the squares of the sides
    solid = solid_of(shapely.Polygon([(0, 0), (0.4, 0), (0.1, 0.3)]))
    sides = [0.4**2, 0.3**2 + 0.3**2, 0.1**2 + 0.3**2]
    assert solid.moments[0, 0] == pytest.approx(0.06 / 36.0 * sum(sides))
    assert solid.centroid == pytest.approx([0.5 / 3.0, 0.1])


def test_a_ring_and_two_discs():
    disc = shapely.Point(2.0, 1.0).buffer(0.5, quad_segs=400)
    hole = shapely.Point(2.0, 1.0).buffer(0.3, quad_segs=400)
    ring = solid_of(disc - hole)
    assert ring.volume == pytest.approx(math.pi * (0.25 - 0.09), rel=1e-5)
    assert ring.moments[0, 0] == pytest.approx(math.pi / 2.0 * (0.5**4 - 0.3**4), rel=1e-5)
    pair = solid_of(shapely.union(disc, shapely.Point(5.0, 1.0).buffer(0.5, quad_segs=400)))
    assert pair.centroid == pytest.approx([3.5, 1.0])
    assert pair.moments[0, 0] == pytest.approx(2 * (math.pi / 2 * 0.5**4 + math.pi * 0.25 * 1.5**2), rel=1e-5)


def test_a_block_in_space():
    mesh = trimesh.creation.box((1.0, 2.0, 3.0), trimesh.transformations.translation_matrix([4, 5, 6]))
    solid = solid_of(mesh)
    assert solid.volume == pytest.approx(6.0)
    assert solid.centroid == pytest.approx([4.0, 5.0, 6.0])
    assert solid.moments == pytest.approx(0.5 * np.diag([13.0, 10.0, 5.0]))


def test_only_closed_walls_enclose_a_solid():
    open_wall = PolygonWall(points=[(0, 1), (0, 0), (1, 0)])
    hull = PolygonWall(points=[(0, 0), (0, 1), (1, 1), (1, 0)], closed=True)
    assert solid_within([open_wall]) is None
    solid = solid_within([open_wall, hull])
    assert solid is not None
    assert solid.volume == 1.0


def test_the_solid_within_a_wall_of_any_closed_shape():
    disc = solid_within([CircleWall(centre=(2, 1), radius=0.5)])
    oval = solid_within([EllipseWall(centre=(2, 1), semi_axes=(0.5, 0.2), angle=30)])
    for solid, a, b in ((disc, 0.5, 0.5), (oval, 0.5, 0.2)):
        assert solid.volume == pytest.approx(math.pi * a * b, rel=1e-12)
        assert solid.centroid == pytest.approx([2.0, 1.0], abs=1e-12)
        assert solid.moments[0, 0] == pytest.approx(math.pi * a * b * (a * a + b * b) / 4.0, rel=1e-4)
    boxes = [Box(lower=(0, 0), upper=(2, 1)), Box(lower=(0, 0), upper=(1, 2))]
    ell = solid_within([UnionWall(of=boxes)])
    assert ell.volume == pytest.approx(3.0)
    assert ell.centroid == pytest.approx([5.0 / 6.0, 5.0 / 6.0])
    assert solid_within([PolylineWall(points=((0, 0), (1, 0)))]) is None
