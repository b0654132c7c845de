"""The surface of the water as triangles: where it is, that it is closed, and what is refused."""

import sys

import igl
import numpy as np
import pytest
import trimesh
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from sphframe.analysis import particles_at, water_surface
from sphframe.analysis.water import surface_of
from sphframe.errors import InputError

pytest.importorskip("pyvista")
SIZE = np.array([20.0, 12.0, 8.0])


def lattice(lower: tuple[int, ...], upper: tuple[int, ...]) -> np.ndarray:
    axes = [np.arange(low, high) + 0.5 for low, high in zip(lower, upper, strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def vessel() -> tuple[np.ndarray, np.ndarray]:
    """Four layers of points around a box without a lid, up to 6 above the water, and the triangles of the box."""
    points = lattice((-4, -4, -4), (24, 16, 14))
    box = trimesh.creation.box(bounds=[[0.0, 0.0, 0.0], [20.0, 12.0, 14.0]])
    return points[((points < 0.0) | (points > [20.0, 12.0, np.inf])).any(axis=1)], np.asarray(box.triangles)


def solid_of(nodes: np.ndarray, triangles: np.ndarray) -> trimesh.Trimesh:
    made = trimesh.Trimesh(nodes, triangles, process=False)
    assert made.is_watertight
    assert made.is_winding_consistent
    return made


def test_water_in_a_vessel_fills_it_up_to_its_level() -> None:
    water = lattice((0, 0, 0), (20, 12, 8))
    nodes, triangles, normals = surface_of(water, np.ones(len(water)), 1.0, *vessel())
    assert solid_of(nodes, triangles).volume == pytest.approx(np.prod(SIZE), rel=2e-3)
    np.testing.assert_allclose(nodes.min(axis=0), 0.0, atol=1e-6)
    np.testing.assert_allclose(nodes.max(axis=0), SIZE, atol=1e-3)
    above = nodes[:, 2] > 6.0
    rim = (nodes[:, :2] == 0.0).any(axis=1) | (nodes[:, :2] == [20.0, 12.0]).any(axis=1)
    np.testing.assert_allclose(nodes[above & ~rim, 2], 8.0, atol=1e-3)
    inner = above & (np.abs(nodes[:, :2] - [10.0, 6.0]) < [8.0, 4.0]).all(axis=1)
    np.testing.assert_allclose(normals[inner], [[0.0, 0.0, 1.0]] * inner.sum(), atol=1e-2)


def test_a_film_on_the_bed_is_whole() -> None:
    """Particles on the bed itself, more than a spacing apart: thinner than a cell of the grid, but without holes."""
    film = lattice((0, 0, 0), (16, 10, 1)) * [1.25, 1.2, 0.0]
    nodes, triangles, _ = surface_of(film, np.ones(len(film)), 1.0, *vessel())
    made = solid_of(nodes, triangles)
    assert made.euler_number == 2, "one body without holes"
    assert nodes[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    assert 0.2 < nodes[:, 2].max() < 1.0


def test_without_walls_a_block_keeps_its_faces_and_rounds_its_edges() -> None:
    water = lattice((0, 0, 0), (20, 12, 8))
    nodes, triangles, _ = surface_of(water, np.ones(len(water)), 1.0)
    assert solid_of(nodes, triangles).volume == pytest.approx(np.prod(SIZE), rel=0.03)
    assert nodes[np.abs(nodes[:, :2] - [10.0, 6.0]).max(axis=1) < 4.0, 2].max() == pytest.approx(8.0, abs=0.02)
    np.testing.assert_allclose([nodes.min(axis=0), nodes.max(axis=0)], [[0.0] * 3, SIZE], atol=0.06)


def test_a_ball_has_its_volume_and_its_normals() -> None:
    points = lattice((-10, -10, -10), (10, 10, 10))
    points = 0.1 * points[np.linalg.norm(points, axis=1) < 8.0] + [3.0, -2.0, 1.0]
    nodes, triangles, normals = surface_of(points, np.full(len(points), 1e-3), 0.1)
    assert solid_of(nodes, triangles).volume == pytest.approx(1e-3 * len(points), rel=0.02)
    outward = nodes - [3.0, -2.0, 1.0]
    np.testing.assert_allclose(np.linalg.norm(outward, axis=1), 0.8, atol=0.03)
    assert np.all(np.sum(normals * outward, axis=1) > 0.95 * 0.77)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0)


def test_a_drop_of_one_particle_is_seen() -> None:
    nodes, triangles, _ = surface_of(np.array([[10.0, 6.0, 9.3]]), np.ones(1), 1.0, *vessel())
    assert 0.4 < solid_of(nodes, triangles).volume < 1.1


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 60), size=st.floats(0.5, 8.0))
def test_of_any_cloud_it_is_closed_and_all_particles_are_within(seed: int, count: int, size: float) -> None:
    position = np.random.default_rng(seed).uniform(0.0, size, (count, 3))
    nodes, triangles, _ = surface_of(position, np.ones(count), 1.0)
    solid_of(nodes, triangles)
    around = igl.winding_number(nodes, triangles, position)
    np.testing.assert_allclose(around, 1.0, atol=1e-6)


def test_points_of_a_thin_wall_within_the_water_are_no_solid() -> None:
    water = lattice((0, 0, 0), (20, 12, 8))
    points, box = vessel()
    thin = lattice((8, 3, 2), (12, 9, 6))  # its two sides have points in the water of the other side
    made = surface_of(water, np.ones(len(water)), 1.0, np.concatenate([points, thin]), box)
    for one, other in zip(made, surface_of(water, np.ones(len(water)), 1.0, points, box), strict=True):
        np.testing.assert_array_equal(one, other)


def test_points_on_the_walls_are_no_solid() -> None:
    water = lattice((0, 0, 0), (20, 12, 8))
    _, box = vessel()
    lining = np.concatenate([
        lattice((0, 0, 0), (20, 12, 1)) * [1.0, 1.0, 0.0], lattice((0, 0, 0), (1, 12, 14)) * [0.0, 1.0, 1.0]
    ])  # fmt: skip
    made = surface_of(water, np.ones(len(water)), 1.0, lining, box)
    for one, other in zip(made, surface_of(water, np.ones(len(water)), 1.0), strict=True):
        np.testing.assert_array_equal(one, other)


def test_the_surface_of_a_run(tank_3d: xr.Dataset) -> None:
    frame, spacing = particles_at(tank_3d, 0.0), float(tank_3d.attrs["particle_spacing"])
    water = tank_3d.sph.water_surface(0.0)
    volume = float((tank_3d["particle_mass"] / frame["density"]).sum())
    assert solid_of(water.nodes, water.triangles).volume == pytest.approx(volume, rel=5e-3)
    lower, upper = (f(tank_3d["outline_node"].values, axis=0) for f in (np.min, np.max))
    upper[2] = lower[2] + float(tank_3d.attrs["depth"])
    np.testing.assert_allclose(water.nodes.min(axis=0), lower, atol=1e-6)
    np.testing.assert_allclose(water.nodes.max(axis=0), upper, atol=0.05 * spacing)
    np.testing.assert_allclose(water.average @ np.ones(frame.sizes["particle"]), 1.0)
    depth = water.average @ frame["position"].values - water.nodes
    assert np.abs(depth).max() < 1.2 * spacing, "averages are those of particles near by"


def test_particles_that_were_removed_are_not_water(tank_3d: xr.Dataset) -> None:
    made = tank_3d.copy(deep=True)
    across, spacing = made["position"].values[0, :, 0].copy(), float(made.attrs["particle_spacing"])
    for name in ("position", "pressure", "density"):
        made[name][0, across < across.mean()] = np.nan
    half, whole = water_surface(made, 0.0), water_surface(tank_3d, 0.0)
    volume = [solid_of(water.nodes, water.triangles).volume for water in (half, whole)]
    assert volume[0] == pytest.approx(0.5 * volume[1], rel=0.03)
    position = particles_at(made, 0.0)["position"].values
    assert np.abs(half.average @ position - half.nodes).max() < 1.2 * spacing, "and do not shift the others"


def test_what_is_refused(tank: xr.Dataset, tank_3d: xr.Dataset, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InputError, match="only runs in three dimensions have a surface of triangles"):
        water_surface(tank)
    dry = tank_3d.copy(deep=True)
    dry["position"][-1] = np.nan
    with pytest.raises(InputError, match=r"no water in the frame at t = 0\.01\d* s"):
        water_surface(dry)
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(
        InputError, match=r"surfaces of triangles need PyVista: install it with pip install 'sphframe\[vt"
    ):
        water_surface(tank_3d)
