"""Layers of ghosts fill the solid behind any wall: their kernel sum against the exact wall integral."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from sphframe.errors import InputError
from sphframe.geometry.domain import fluid_domain
from sphframe.geometry.layers import layer_points

from .wall_integrals import filling_errors, wall_integral


def basin_around(shape):
    """A basin whose walls are ten spacings away from ``shape``."""
    return shapely.box(*shapely.buffer(shape, 10.0).bounds)


def ring(polygon):
    return shapely.get_coordinates(polygon.exterior)


def errors(walls, fluid, spacing=1.0):
    """Errors of the filling of ``walls`` drawn in spacings; the scene is scaled to ``spacing``."""
    walls = {f"wall {k}": [spacing * np.asarray(line, dtype=float)] for k, line in enumerate(walls)}
    fluid = shapely.transform(fluid, lambda points: spacing * points)
    domain = fluid_domain(walls, fluid, spacing)
    return filling_errors(domain, layer_points(domain, spacing, 4), spacing)


def check(walls, fluid, spacing=1.0):
    error = errors(walls, fluid, spacing)
    assert len(error) > 20
    assert np.abs(error).max() <= 0.03, f"largest error {np.abs(error).max():.4f}"
    assert np.sqrt(np.mean(error**2)) <= 0.015, f"rms {np.sqrt(np.mean(error**2)):.4f}"


def test_the_wall_integral_of_a_straight_wall_and_of_a_corner():
    half_plane, quarter = shapely.box(-99, 0, 99, 99), shapely.box(0, 0, 99, 99)
    assert wall_integral(half_plane, np.array([[0.0, 1e-9]]), 1.0) == pytest.approx(0.5, abs=1e-6)
    assert wall_integral(quarter, np.array([[1e-9, 1e-9]]), 1.0) == pytest.approx(0.75, abs=1e-6)
    assert wall_integral(half_plane, np.array([[0.0, 4.0]]), 1.0) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("spacing", [1.0, 0.02])
@pytest.mark.parametrize("segments", [1, 36, 75, 100, 1000])
def test_a_bed_of_any_number_of_segments(segments, spacing):
    bed = [(50 * k / segments, 0) for k in range(segments + 1)]
    check([[(0, 22), *bed, (50, 22)]], shapely.box(0, 0, 50, 15), spacing)


@pytest.mark.parametrize("angle", [0, 13, 45])
def test_a_tank_turned(angle):
    tank = shapely.affinity.rotate(shapely.LineString([(0, 22), (0, 0), (50, 0), (50, 22)]), angle)
    water = shapely.affinity.rotate(shapely.box(0, 0, 50, 22), angle).intersection(shapely.box(-99, -99, 99, 12))
    check([shapely.get_coordinates(tank)], water)


@pytest.mark.parametrize("radius", [3, 5, 7.3, 15, 50])
def test_circles_from_inside_and_from_outside(radius):
    circle = shapely.Point(0, 0).buffer(radius, quad_segs=64)
    check([ring(circle)], circle)
    basin = basin_around(circle)
    check([ring(circle), ring(basin)], basin.difference(circle))


@pytest.mark.parametrize("angle", range(30, 180, 15))
def test_corners_from_30_to_330_degrees(angle):
    right, turned = np.array([30.0, 0.0]), 30 * np.array([math.cos(math.radians(angle)), math.sin(math.radians(angle))])
    check([[right, (0, 0), turned]], shapely.Polygon([(0, 0), right, turned]))
    rhombus = shapely.Polygon([(0, 0), right, right + turned, turned])
    basin = basin_around(rhombus)
    check([ring(rhombus), ring(basin)], basin.difference(rhombus))


def test_walls_joined_end_to_end_and_walls_that_overlap():
    check([[(0, 22), (0, 0)], [(50, 0), (0, 0)], [(50, 0), (50, 22)]], shapely.box(0, 0, 50, 15))
    plate = ring(shapely.box(24, -4, 32, 22))
    check([[(0, 22), (0, 0), (50, 0), (50, 22)], plate], shapely.box(0, 0, 24, 15))


def test_straight_walls_on_the_lattice_keep_the_lattice():
    domain = fluid_domain({"tank": [np.array([(0, 20), (0, 0), (30, 0), (30, 20)])]}, shapely.box(0, 0, 30, 10), 1.0)
    points = layer_points(domain, 1.0, 4)
    np.testing.assert_allclose(points.position - 0.5, np.rint(points.position - 0.5), atol=1e-12)
    np.testing.assert_array_equal(points.volume, 1.0)
    assert len(points.volume) == 38 * 24 - 30 * 20


@st.composite
def simple_polygons(draw):
    """Star-shaped polygons of 3 to 8 corners, at least 30 degrees each."""
    count = draw(st.integers(3, 8))
    shares = draw(st.lists(st.floats(0.3, 1.0), min_size=count, max_size=count))
    radii = draw(st.lists(st.floats(8.0, 25.0), min_size=count, max_size=count))
    angles = 2 * np.pi * np.cumsum(shares) / sum(shares)
    points = np.array(radii)[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    cosine = -np.einsum("ij,ij->i", before, after) / np.hypot(*before.T) / np.hypot(*after.T)
    polygon = shapely.Polygon(points)
    assume(polygon.is_valid and cosine.max() < math.cos(math.radians(30)) and np.hypot(*after.T).min() > 6.0)
    assume(not polygon.buffer(-4.0).is_empty)
    return polygon


@settings(max_examples=12, deadline=None)
@given(simple_polygons())
def test_random_polygons_from_inside_and_from_outside(polygon):
    basin = basin_around(polygon)
    for walls, fluid in (([ring(polygon)], polygon), ([ring(polygon), ring(basin)], basin.difference(polygon))):
        error = errors(walls, fluid)
        assert np.abs(error).max() <= 0.03, f"largest error {np.abs(error).max():.4f}: {polygon.wkt}"


@pytest.mark.parametrize(
    ("lines", "fluid", "message"),
    [
        ([[(0, 9), (0, 0), (9, 0), (9, 9)], [(5, 0), (5, 8)]], shapely.box(0, 0, 9, 5), "runs through the fluid"),
        ([[(0, 9), (0, 0), (9, 0), (9, 9)], [(2, 2), (2, 4), (4, 4), (4, 2)]], shapely.box(0, 0, 9, 2), "closed wall"),
    ],
)
def test_ambiguous_walls_are_refused_with_name_and_place(lines, fluid, message):
    with pytest.raises(InputError, match=rf"wall 'wall 1' .*{message}"):
        fluid_domain({f"wall {k}": [np.array(line, float)] for k, line in enumerate(lines)}, fluid, 0.1)
