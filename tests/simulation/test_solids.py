"""Solids in three dimensions: nothing comes behind them, and bodies float and sink as they must."""

from pathlib import Path
from typing import Any

import igl
import numpy as np
import pytest
import trimesh

from sphframe import Simulation, load_case
from sphframe.cases.custom import Custom
from sphframe.geometry import to_world

SPACING = 0.025
TANK = {"shape": "box", "name": "tank", "lower": (0, 0, 0), "upper": (0.5, 0.4, 0.4), "open_faces": ("+z",)}


def solid(name: str) -> Any:
    if name == "torus":  # its tube and its hole have radii of two spacings
        mesh = trimesh.creation.torus(4 * SPACING, 2 * SPACING, major_sections=48, minor_sections=24)
        mesh.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [0, 1, 0]))
    elif name == "sphere":
        mesh = trimesh.creation.icosphere(3, 0.07)
    else:
        mesh = trimesh.creation.box((0.1, 0.12, 0.14))
    mesh.apply_translation((0.33, 0.2, 0.2))
    return mesh


def depth_behind(mesh: Any, points: Any) -> Any:
    """Depth within ``mesh`` by winding numbers, whatever the normals of the triangles."""
    kind = igl.SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER
    vertices, triangles = np.array(mesh.vertices), np.array(mesh.faces, np.int64)
    return -igl.signed_distance(np.ascontiguousarray(points), vertices, triangles, sign_type=kind)[0]


@pytest.mark.parametrize(
    ("name", "moving"),
    [pytest.param("torus", False, marks=pytest.mark.long), ("torus", True), ("sphere", False), ("box", True)],
)
def test_particles_within_a_solid_are_put_back_on_it(tmp_path: Path, name: str, moving: bool) -> None:
    mesh = solid(name)
    mesh.export(tmp_path / "solid.stl")
    wall = {"shape": "mesh", "name": "solid", "file": str(tmp_path / "solid.stl")}
    turning = {"name": "free", "density": 3000.0, "initial_velocity": (1.0, 2.0, 3.0, 9.0, 8.0, 7.0)}
    water = {"shape": "box", "lower": (0, 0, 0), "upper": (0.2, 0.4, 0.35)}
    case = Custom(
        dimension=3,
        particle_spacing=SPACING,
        until=1.0,
        walls=[TANK, {**wall, "body": "body"} if moving else wall],
        fluid=[water],
        bodies={"body": turning} if moving else {},
    )
    simulation = Simulation(load_case(case), threads=1)
    system, n = simulation.system, simulation.system.fluid_count
    simulation.advance()
    if moving:
        at = simulation.body_motions()["body"].position
        mesh.vertices = to_world(mesh.vertices, at, mesh.center_mass)
    generator = np.random.default_rng(0)
    points = trimesh.sample.sample_surface_even(mesh, n, seed=1)[0]
    points += 0.3 * SPACING * generator.uniform(-1, 1, points.shape)
    rows, velocity = system.rows[: len(points), :3], system.rows[:n, 3:6]
    rows[:] = points
    system.find_neighbours()
    velocity[:] = generator.normal(size=velocity.shape)
    before, first_velocity = system.rows[:n, :3].copy(), velocity.copy()
    depth = depth_behind(mesh, before)
    system.put_back()
    after, least = system.rows[:n, :3], 0.005 * SPACING  # the wall follows the curves of the mesh to this distance
    within, outside = depth > least, depth < -least
    assert within.sum() > 100
    np.testing.assert_array_equal(after[outside], before[outside])
    np.testing.assert_allclose(np.linalg.norm((after - before)[within], axis=1), depth[within], atol=least)
    assert depth_behind(mesh, after).max() < least
    change = velocity - first_velocity
    np.testing.assert_array_equal(change[outside], 0.0)
    normal = (before - after)[within] / depth[within, None]
    wall = np.zeros_like(normal)
    if moving:
        rate = system.bodies.motions[0].velocity
        wall = rate[:3] + np.cross(rate[3:], after[within] - mesh.center_mass)
    into = np.einsum("ij,ij->i", first_velocity[within] - wall, normal)[:, None]
    np.testing.assert_allclose(change[within], -np.maximum(into, 0.0) * normal, atol=0.02 * np.abs(into).max())


@pytest.mark.parametrize("name", ["torus", "sphere", "box"])
def test_water_thrown_at_a_solid_is_never_behind_it(tmp_path: Path, name: str) -> None:
    mesh = solid(name)
    mesh.export(tmp_path / "solid.stl")
    wall: Any = {"shape": "mesh", "name": "solid", "file": str(tmp_path / "solid.stl")}
    if name == "box":
        wall = {"shape": "box", "name": "solid", "lower": tuple(mesh.bounds[0]), "upper": tuple(mesh.bounds[1])}
    water = {"shape": "box", "lower": (0.05, 0.1, 0.075), "upper": (0.2, 0.3, 0.325), "velocity": (2.5, 0, 0)}
    case = Custom(dimension=3, particle_spacing=SPACING, until=1.0, walls=[TANK, wall], fluid=[water])
    simulation = Simulation(load_case(case), threads=1)
    while simulation.time < 0.12:
        simulation.advance()
        if simulation.step % 5 == 0:
            position = simulation.fields().position
            assert depth_behind(mesh, position).max() < 0.005 * SPACING
    assert simulation.particles_outside() == 0
    assert np.sum(depth_behind(mesh, position) > -SPACING) > 30, "some are beside it"


def test_a_box_and_its_mesh_bear_the_same_forces(tmp_path: Path) -> None:
    lower, upper = (0.2, 0.1, 0.0), (0.35, 0.25, 0.2)
    trimesh.creation.box(bounds=[lower, upper]).export(tmp_path / "box.stl")
    drawn = {"shape": "box", "lower": lower, "upper": upper}
    mesh = {"shape": "mesh", "file": str(tmp_path / "box.stl")}
    loads = []
    for shape in (drawn, mesh):
        water = {"shape": "box", "lower": (0, 0, 0), "upper": (0.2, 0.4, 0.275)}  # it is let go beside the box
        case = Custom(
            dimension=3, particle_spacing=SPACING, until=1.0, walls=[TANK, {**shape, "name": "box"}], fluid=[water]
        )
        simulation = Simulation(load_case(case), threads=1)
        for _ in range(20):
            simulation.advance()
        load = simulation.wall_loads()["box"]
        loads.append(np.concatenate([load.force, load.force_by_pressure, load.moment]))
    assert loads[0][0] > 5.0
    np.testing.assert_allclose(loads[1], loads[0], rtol=1e-3, atol=1e-3 * loads[0][0])


def with_body(mesh: Any, path: Path, size: tuple[float, float], depth: float, **body: Any) -> Simulation:
    """A tank of the ``size``, with water around the ``mesh``, which is free to move."""
    mesh.export(path)
    tank = {**TANK, "upper": (*size, depth + 0.2)}
    wall = {"shape": "mesh", "name": "solid", "file": str(path), "body": "solid"}
    water = {"shape": "box", "lower": (0, 0, 0), "upper": (*size, depth)}
    around = {"shape": "difference", "of": water, "minus": [{"shape": "mesh", "file": str(path)}]}
    case = Custom(
        dimension=3,
        particle_spacing=SPACING,
        until=1.0,
        walls=[tank, wall],
        fluid=[around],
        bodies={"solid": {"name": "free", **body}},
    )
    return Simulation(load_case(case), threads=1)


@pytest.mark.long
def test_a_floating_cube_that_is_turned_rights_itself(tmp_path: Path) -> None:
    edge, depth, turned = 0.2, 0.25, np.radians(10)
    mesh = trimesh.creation.box((edge, edge, edge))
    mesh.apply_transform(trimesh.transformations.rotation_matrix(turned, [0, 1, 0]))
    mesh.apply_translation((0.2, 0.2, depth))  # half of it is under water, as its mass asks
    mass = 1000.0 * edge**3 / 2
    low = (0.2 - 0.06 * np.sin(turned), 0.2, depth - 0.06 * np.cos(turned))  # its ballast is deep
    inertia = (mass * edge**2 / 6,) * 3
    simulation = with_body(mesh, tmp_path / "cube.stl", (0.4, 0.4), depth, mass=mass, inertia=inertia, centre=low)
    tilts = []
    while simulation.time < 0.25:
        simulation.advance()
        motion = simulation.body_motions()["solid"]
        x, y, rise, rx, ry, rz = motion.position
        tilts.append(turned + ry)
        middle = low[2] + rise + 0.06 * np.cos(tilts[-1])
        assert abs(depth - middle) < 0.5 * SPACING, "the draught is that of Archimedes"
        assert np.abs([x, y, rx, rz]).max() < 0.02
    crossing = simulation.time * np.argmax(np.array(tilts) < 0.0) / len(tilts)
    assert 0.15 < crossing < 0.24
    assert np.radians(-10) < min(tilts) < np.radians(-1)
    assert simulation.particles_outside() == 0


@pytest.mark.long
def test_a_heavy_sphere_sinks_to_the_bed_and_stays(tmp_path: Path) -> None:
    mesh, radius = trimesh.creation.icosphere(3, 0.07), 0.07
    mesh.apply_translation((0.15, 0.15, radius + 0.03))
    simulation = with_body(mesh, tmp_path / "sphere.stl", (0.3, 0.3), 0.25, density=2500.0)
    heights = []
    while simulation.time < 0.25:
        simulation.advance()
        heights.append(0.03 + simulation.body_motions()["solid"].position[2])
    assert min(heights) > -0.1 * SPACING
    assert np.abs(heights[-50:]).max() < 0.1 * SPACING
    assert simulation.particles_outside() == 0
