"""Walls in three dimensions: which side is wet, and their ghosts, mirror points and panels against geometry."""

import numpy as np
import pytest
import shapely
import trimesh
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from sphframe.errors import InputError
from sphframe.geometry import (
    Box,
    BoxWall,
    Circle,
    Cylinder,
    Difference,
    Mesh,
    Plane,
    Sphere,
    Union,
    solid_within,
    wall_groups,
    within,
)
from sphframe.geometry.solid_walls import SolidWalls
from sphframe.geometry.walls import CylinderWall, MeshWall, PlaneWall, SphereWall

from .solid_integrals import filling_errors, wall_integral

TANK = BoxWall(name="tank", lower=(0, 0, 0), upper=(1.0, 0.4, 0.5), open_faces=("+z",))
WATER = Box(lower=(0, 0, 0), upper=(0.4, 0.4, 0.3))
FAR = Box(lower=(-70, -70, -70), upper=(-60, -60, -60))
"""water away from an obstacle, in spacings"""


def group_of(*walls, fluid=WATER, spacing=0.02):
    return SolidWalls(dict(enumerate(walls)), [fluid], spacing)


def sorted_by_place(points, *others):
    order = np.lexsort(points.round(7).T)
    return points[order], *(other[order] for other in others)


def test_the_wall_integral_of_a_face_and_of_an_edge():
    half_space = trimesh.creation.box(bounds=[[-9, -9, 0], [9, 9, 9]])
    marginal = 0.293, 0.0  # of the kernel beyond half a spacing, close to erfc(0.5 / 1.3) / 2, and beyond its support
    np.testing.assert_allclose(
        wall_integral(half_space, np.array([[0, 0, 0.5], [0, 0, 4.0]]), 1.0), marginal, atol=1e-3
    )
    quarter = trimesh.creation.box(bounds=[[-9, 0, 0], [9, 9, 9]])
    one = 1 - marginal[0]
    np.testing.assert_allclose(wall_integral(quarter, np.array([[0, 0.5, 0.5]]), 1.0), 1 - one**2, atol=2e-3)


def test_ghosts_that_no_fluid_reaches_are_left_out():
    ((_, box),) = wall_groups((TANK,), [WATER], 0.02)
    ghosts = box.ghosts(0.02, 4)
    kept, _ = within(3.3 * 0.02, ghosts, None)
    x, y, z = np.meshgrid(*(np.linspace(0.0, size, 21) for size in (1.0, 0.4, 0.5)))
    fluid = cKDTree(np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1))  # on the walls: the nearest that it may be
    reached = fluid.query(ghosts.position)[0] < 3.3 * 0.02
    assert set(map(tuple, ghosts.position[reached])) <= set(map(tuple, kept.position))
    assert 0.6 < len(kept.wall) / len(ghosts.wall) < 0.75  # of four layers the last one, and what is deep in edges


def test_a_container_alone_has_the_lattice_of_its_box():
    ((_, box),) = wall_groups((TANK,), [WATER], 0.02)
    one, other = box.ghosts(0.02, 4), group_of(TANK).ghosts(0.02, 4)
    assert np.all(other.volume == pytest.approx(0.02**3))
    near = np.linalg.norm(one.position - np.clip(one.position, (0, 0, 0), (1.0, 0.4, 9)), axis=1) < 0.08
    first = sorted_by_place(one.position[near], one.mirror[near], one.reflection[near])
    second = sorted_by_place(other.position, other.mirror, other.reflection)
    for a, b in zip(first, second, strict=True):
        np.testing.assert_allclose(a, b, atol=1e-9)


def test_fluid_tells_what_is_a_container_and_what_an_obstacle():
    ball = SphereWall(name="ball", centre=(0.7, 0.2, 0.25), radius=0.12)
    group = group_of(TANK, ball)
    points = [(0.7, 0.2, 0.25), (0.5, 0.2, 0.2), (0.5, 0.2, -0.1), (-0.1, 0.2, 0.2), (0.5, 0.2, 0.9)]
    assert group.behind(np.array(points)).tolist() == [True, False, True, True, False]
    drop = group_of(TANK, ball, fluid=Sphere(centre=(0.7, 0.2, 0.25), radius=0.12))
    assert drop.behind(np.array(points)).tolist() == [False, True, True, True, True]


@pytest.mark.parametrize(
    ("walls", "fluid", "message"),
    [
        ([TANK, SphereWall(name="ball", centre=(0.4, 0.2, 0.2), radius=0.12)], WATER, "'ball' runs through the fluid"),
        ([BoxWall(name="cup", lower=(0.6, 0, 0), upper=(1, 1, 1), open_faces=("+z",))], WATER, "'cup' has open faces"),
    ],
)
def test_a_wall_in_the_fluid_and_an_open_obstacle_are_refused(walls, fluid, message):
    with pytest.raises(InputError, match=message):
        group_of(*walls, fluid=fluid)


def test_a_shell_that_is_wet_on_both_sides_is_refused():
    shell = SphereWall(name="shell", centre=(0.7, 0.2, 0.25), radius=0.12)
    with pytest.raises(InputError, match="'shell' has fluid on both sides at"):
        SolidWalls({0: TANK, 1: shell}, [WATER, Sphere(centre=(0.7, 0.2, 0.25), radius=0.12)], 0.02)


def turned_box(tmp_path, size=(10, 9, 8)):
    mesh = trimesh.creation.box(size)
    mesh.apply_transform(trimesh.transformations.rotation_matrix(0.7, [1, 2, 3]))
    mesh.export(tmp_path / "box.stl")
    return str(tmp_path / "box.stl")


@pytest.mark.parametrize("radius", [3, 5, pytest.param(7.3, marks=pytest.mark.long)])
def test_spheres_are_filled_from_inside_and_from_outside(radius):
    centre = (0.2, 0.1, 0.3)
    inside = group_of(SphereWall(centre=centre, radius=radius), fluid=Sphere(centre=centre, radius=radius), spacing=1.0)
    outside = group_of(SphereWall(centre=centre, radius=radius), fluid=FAR, spacing=1.0)
    for group, rms in ((inside, 0.0165 if radius == 3 else 0.0145), (outside, 0.01)):
        error = filling_errors(group, 1.0, count=150)
        assert np.abs(error).max() <= 0.03
        assert np.sqrt(np.mean(error**2)) <= rms


@pytest.mark.parametrize(
    "solid",
    ["cylinder", pytest.param("box", marks=pytest.mark.long), pytest.param("turned box", marks=pytest.mark.long)],
)
def test_cylinders_boxes_and_turned_boxes_are_filled(tmp_path, solid):
    file, ends = turned_box(tmp_path), {"start": (0, 0, 0), "stop": (12, 5, 3), "radius": 5.5}
    for wall, fluid, rms in {
        "cylinder": [(CylinderWall(**ends), FAR, 0.01), (CylinderWall(**ends), Cylinder(**ends), 0.015)],
        "box": [(BoxWall(lower=(0, 0, 0), upper=(10, 9, 8.3)), FAR, 0.01)],
        "turned box": [(MeshWall(file=file), FAR, 0.01), (MeshWall(file=file), Mesh(file=file), 0.016)],
    }[solid]:  # most errors within a turned box are near edges
        error = filling_errors(group_of(wall, fluid=fluid, spacing=1.0), 1.0, count=150)
        assert np.abs(error).max() <= 0.03, (wall, fluid)
        assert np.sqrt(np.mean(error**2)) <= rms, (wall, fluid)


@settings(max_examples=3, deadline=None)
@example((10.0, 11.0, 9.0), (0.0, 0.0, 0.0), 1.0)
@example((8.0, 8.0, 8.0), (0.0, 0.0, 0.0), 1.7307872820624008)  # faces along lines of the columns that divide cells
@example((8.0, 8.0, 8.0), (0.0, 0.2, 0.0), 0.2)  # a ghost nearly as near to two faces
@given(st.tuples(*[st.floats(8.0, 14.0)] * 3), st.tuples(*[st.floats(-3.0, 3.0)] * 3), st.floats(0.2, 3.0))
def test_random_boxes_and_spheres(tmp_path_factory, size, axis, angle):
    mesh = trimesh.creation.box(size)
    mesh.apply_transform(trimesh.transformations.rotation_matrix(angle, np.add(axis, (0, 0, 4))))
    file = tmp_path_factory.mktemp("boxes") / "box.stl"
    mesh.export(file)
    ball = SphereWall(centre=axis, radius=0.5 * size[0])
    spheres = 4 / 3 * np.pi * ball.radius**3
    for wall, volume, tolerance in ((MeshWall(file=str(file)), mesh.volume, 1e-6), (ball, spheres, 5e-3)):
        group = group_of(wall, fluid=FAR, spacing=1.0)
        ghosts = group.ghosts(1.0, 9)  # fill it to its middle
        assert ghosts.volume.sum() == pytest.approx(volume, rel=tolerance)
        assert group.behind(ghosts.position).all()
        assert not group.behind(ghosts.mirror).any()
        feet = group.domain.feet(ghosts.position)
        middle = 0.5 * (ghosts.position + ghosts.mirror)
        # the nearest face of a point that is moved by d <= 1e-4 dx is at most 2 d further than the nearest one
        as_near = np.abs(np.linalg.norm(ghosts.position - middle, axis=1) - feet.depth) < 2e-4
        on_wall = np.abs(group.domain.feet(middle).depth) < 1e-9
        assert np.all(as_near & on_wall), "outside of a convex obstacle no mirror point is moved"
        error = filling_errors(group, 1.0, count=60)
        assert np.abs(error).max() <= 0.03


def test_reflections_at_faces_edges_and_corners():
    container = BoxWall(name="box", lower=(0, 0, 0), upper=(10, 10, 10))
    ghosts = group_of(container, fluid=Box(lower=(0, 0, 0), upper=(10, 10, 5)), spacing=1.0).ghosts(1.0, 4)
    at = {tuple(p): s for p, s in zip(ghosts.position.round(6), ghosts.reflection, strict=True)}
    np.testing.assert_allclose(at[-0.5, 5.5, 5.5], np.diag([-1, 1, 1]), atol=1e-12)
    np.testing.assert_allclose(at[-0.5, 5.5, 10.5], np.diag([-1, 1, -1]), atol=1e-12)
    np.testing.assert_allclose(at[-0.5, -1.5, 10.5], np.diag([-1, -1, -1]), atol=1e-12)


def test_mirror_points_in_a_sharp_edge_are_within_the_fluid(tmp_path):
    """Those of one face of a wedge of 22 degrees lie behind the other, unless they are moved."""
    path = tmp_path / "wedge.stl"
    trimesh.creation.extrude_polygon(shapely.Polygon([(0, 0), (1.0, 0), (1.0, 0.4)]), 0.5).export(path)
    group = group_of(MeshWall(name="wedge", file=str(path)), fluid=Mesh(file=str(path)), spacing=0.05)
    ghosts = group.ghosts(0.05, 3)
    assert group.domain.feet(ghosts.mirror).depth.max() < 0.0


def test_particles_just_before_a_wall_are_not_behind_it():
    """The winding number has single precision, in which 1 - 2e-8 is 1."""
    tank = BoxWall(name="tank", lower=(0, 0, 0), upper=(3.22, 1.0, 1.0), open_faces=("+z",))
    group = group_of(tank, fluid=Box(lower=(2, 0, 0), upper=(3.22, 1, 0.5)), spacing=0.05)
    places = np.random.default_rng(2).uniform(0.1, 0.9, (200, 3)) * [3.22, 1.0, 1.0]
    for axis, wall, outward in ((0, 0.0, -1.0), (0, 3.22, 1.0), (1, 0.0, -1.0), (1, 1.0, 1.0), (2, 0.0, -1.0)):
        for distance, behind in ((-2e-8, False), (1e-5, True)):
            places[:, axis] = wall + outward * distance
            assert np.all(group.behind(places) == behind)
        places[:, axis] = 0.5


def test_a_mesh_is_drawn_by_its_sharp_edges_and_three_sections(tmp_path):
    path = tmp_path / "box.stl"
    trimesh.creation.box((1.0, 2.0, 3.0)).export(path)
    lines = MeshWall(name="box", file=str(path)).outline()
    lengths = sorted(float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum()) for line in lines)
    np.testing.assert_allclose(lengths, [*[1.0] * 4, *[2.0] * 4, *[3.0] * 4, 6.0, 8.0, 10.0], rtol=1e-6)


def test_the_edge_between_an_obstacle_and_the_bed_is_shared():
    block = BoxWall(name="block", lower=(0.6, 0.1, 0), upper=(0.8, 0.3, 0.3))
    ghosts = group_of(TANK, block).ghosts(0.02, 4)
    shared = ghosts.other >= 0
    assert shared.any()
    assert set(zip(ghosts.wall[shared].tolist(), ghosts.other[shared].tolist(), strict=True)) <= {(0, 1), (1, 0)}
    np.testing.assert_allclose(np.einsum("ij,ij->i", ghosts.other_dual[shared], ghosts.other_normal[shared]), 1.0)


def test_panels_add_up_to_the_surface_and_to_the_buoyancy(tmp_path):
    mesh = trimesh.creation.torus(0.3, 0.1)
    mesh.export(tmp_path / "torus.stl")
    tank = BoxWall(name="tank", lower=(-1, -1, -1), upper=(1, 1, 1))
    water = Box(lower=(-1, -1, -1), upper=(1, 1, -0.5))
    panels = group_of(tank, MeshWall(name="torus", file=str(tmp_path / "torus.stl")), fluid=water).panels(0.02)
    own = panels.wall == 1
    np.testing.assert_allclose(panels.area[own].sum(axis=0), 0.0, atol=1e-12)
    force = -(panels.centre[own, 2:] * panels.area[own]).sum(axis=0)
    np.testing.assert_allclose(force, [0, 0, mesh.volume], atol=2e-3 * mesh.volume)


@pytest.mark.parametrize(
    ("wall", "thin"),
    [
        (BoxWall(lower=(0, 0, 0), upper=(10, 9, 4.5)), False),
        (BoxWall(lower=(0, 0, 0), upper=(10, 9, 3.5)), True),
        (SphereWall(centre=(0, 0, 0), radius=2.1), False),
        (SphereWall(centre=(0, 0, 0), radius=1.8), True),
        (CylinderWall(start=(0, 0, 0), stop=(12, 5, 3), radius=1.7), True),
    ],
)
def test_a_solid_thinner_than_the_support_is_noticed(wall, thin):
    place = group_of(wall, fluid=FAR, spacing=1.0).thin_place(3.9)
    assert (place is not None) == thin
    assert place is None or np.all((np.array(place) > wall.bounds()[0]) & (np.array(place) < wall.bounds()[1]))


def test_sharp_edges_are_not_thin_but_fins_are(tmp_path):
    wedge = trimesh.creation.extrude_polygon(shapely.Polygon([(0, 0), (20, 0), (0, 9)]), 12)
    fin = trimesh.creation.extrude_polygon(
        shapely.Polygon([(0, 0), (9, 0), (9, 9), (5, 9), (5, 20), (2, 20), (2, 9), (0, 9)]), 12
    )
    for mesh, thin in ((wedge, False), (fin, True)):
        mesh.apply_transform(trimesh.transformations.rotation_matrix(0.7, [1, 2, 3]))
        mesh.export(tmp_path / "part.stl")
        place = group_of(MeshWall(file=str(tmp_path / "part.stl")), fluid=FAR, spacing=1.0).thin_place(3.9)
        assert (place is not None) == thin


def test_solids_can_be_joined_and_cut():
    cut = Difference(of=Box(lower=(0, 0, 0), upper=(1, 1, 1)), minus=[Sphere(centre=(0.5, 0.5, 0.5), radius=0.2)])
    assert cut.geometry(1e-3).volume == pytest.approx(1 - 4 / 3 * np.pi * 0.2**3, rel=1e-6)
    pair = Union(of=[Box(lower=(0, 0, 0), upper=(1, 1, 1)), Box(lower=(1, 0, 0), upper=(2, 1, 1))])
    assert pair.geometry(1e-3).volume == pytest.approx(2.0)
    with pytest.raises(ValueError, match="circle: a shape of the plane cannot be joined"):
        Union(of=[Box(lower=(0, 0, 0), upper=(1, 1, 1)), Circle(centre=(0, 0), radius=1)])


def test_a_body_takes_its_mass_from_its_solid():
    solid = solid_within([BoxWall(lower=(0, 0, 0), upper=(3, 2, 1))])
    assert solid.volume == pytest.approx(6.0)
    np.testing.assert_allclose(solid.centroid, [1.5, 1.0, 0.5])
    np.testing.assert_allclose(solid.moments, np.diag([5.0, 10.0, 13.0]) * 6 / 12, atol=1e-12)
    assert solid_within([TANK]) is None


def test_a_plane_bounds_the_fluid_on_the_side_where_it_is():
    """A tank with a slope of 1 : 2 across it; the normal of the plane may also point into the solid."""
    box = {"lower": (-20, -20, -20), "upper": (40, 40, 40)}
    slope = Plane(point=(10, 0, 0), normal=(-1, 0, 2), **box)
    tank = BoxWall(name="tank", lower=(0, 0, 0), upper=(20, 10, 12), open_faces=("+z",))
    water = Difference(of=Box(lower=(0, 0, 0), upper=(20, 10, 9)), minus=[slope])
    for sign in (-1, 1):
        bed = PlaneWall(name="bed", point=(10, 0, 0), normal=(-sign, 0, 2 * sign), **box)
        group = group_of(tank, bed, fluid=water, spacing=1.0)
        assert group.behind(np.array([(15, 5, 2.4), (15, 5, 2.6), (5, 5, -0.1)])).tolist() == [True, False, True]
        panels = group.panels(1.0)
        own = (panels.wall == 1) & (panels.centre[:, 2] < 12)  # not the face of the box above the tank
        np.testing.assert_allclose(panels.area[own].sum(axis=0), [50, 0, -100], atol=1e-9)
    error = filling_errors(group, 1.0, count=100)
    assert np.abs(error).max() <= 0.03
    assert np.sqrt(np.mean(error**2)) <= 0.015


def test_a_plane_that_does_not_cut_its_box_is_refused():
    box = {"lower": (0, 0, 0), "upper": (1, 1, 1)}
    assert Plane(point=(0.5, 0, 0), normal=(2, 0, 0), **box).geometry(0.1).bounds.tolist() == [[0, 0, 0], [0.5, 1, 1]]
    for point, normal in (((2, 0, 0), (1, 0, 0)), ((0.5, 0.5, 0.5), (0, 0, 0)), ((0, 0, 1), (0, 0, 1))):
        with pytest.raises(ValueError, match=r"does not cut the box .*; give a point in the box, and a normal"):
            Plane(point=point, normal=normal, **box)
