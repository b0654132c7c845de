"""The particles of a region against geometry: volumes, distances, and the kernel sum with the exact solid share."""

import math
from pathlib import Path

import numpy as np
import pytest
import shapely
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from sphframe.geometry import (
    BoxRegion,
    CircleRegion,
    CurveRegion,
    CylinderRegion,
    DifferenceRegion,
    EllipseRegion,
    MeshRegion,
    PolygonRegion,
    Region,
    SphereRegion,
    UnionRegion,
    common_part,
    fill,
)

from .wall_integrals import gaussian


def beside_a_slope(angle: float) -> PolygonRegion:
    return PolygonRegion(points=((0, 0), (1, 0), (1 + 0.3 / math.tan(math.radians(angle)), 0.3), (0, 0.3)))


CURVED: dict[str, Region] = {
    **{f"{angle} degrees": beside_a_slope(angle) for angle in (15, 30, 45, 60, 75, 120)},
    "disc": CircleRegion(centre=(0.37, 0.21), radius=0.3),
    "small disc": CircleRegion(centre=(0.37, 0.21), radius=0.1),
    "ellipse": EllipseRegion(centre=(0, 0), semi_axes=(0.4, 0.2), angle=20),
    "half-full drum": DifferenceRegion(
        of={"shape": "circle", "centre": (0, 0), "radius": 0.3},
        minus=[{"shape": "box", "lower": (-1, 0), "upper": (1, 1)}],
    ),
    "annulus": DifferenceRegion(
        of={"shape": "circle", "centre": (0, 0), "radius": 0.3},
        minus=[{"shape": "circle", "centre": (0, 0), "radius": 0.15}],
    ),
}
DX = 0.02


def filling(region: Region, spacing: float) -> np.ndarray:
    """Kernel sum plus the share of the kernel outside the region, by quadrature, of particles close to its outline."""
    position, volume = fill(region, spacing)
    area = region.geometry(1e-3 * spacing)
    shapely.prepare(area)
    h = 1.3 * spacing
    radius, angle = np.meshgrid((np.arange(60) + 0.5) / 20.0 * h, (np.arange(120) + 0.5) / 60.0 * np.pi)
    disc = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1).reshape(-1, 2)
    weight = (gaussian(radius, h) * radius).ravel()
    tree = cKDTree(position)
    found = []
    for x in position[shapely.distance(area.boundary, shapely.points(position)) < 1.5 * spacing]:
        near = tree.query_ball_point(x, 3 * h)
        fluid = volume[near] @ gaussian(np.linalg.norm(position[near] - x, axis=1), h)
        outside = ~shapely.contains_xy(area, *(x + disc).T)
        found.append(fluid + weight[outside].sum() / weight.sum())
    return np.array(found)


def test_the_lattice_itself_fills_a_box_within_two_per_cent() -> None:
    found = filling(BoxRegion(lower=(0, 0), upper=(0.6, 0.3)), DX)
    assert 1.0 < found.min() < found.max() < 1.02


@pytest.mark.parametrize("name", CURVED)
def test_along_slopes_and_curves_the_filling_is_that_of_the_lattice(name: str) -> None:
    found = filling(CURVED[name], DX)
    assert found.min() > 0.99
    assert found.max() < 1.035
    assert np.std(found) < 0.006


@pytest.mark.parametrize("name", CURVED)
@pytest.mark.parametrize("spacing", [0.02, 0.017, 0.0123])
def test_volumes_add_up_to_the_area(name: str, spacing: float) -> None:
    region = CURVED[name]
    position, volume = fill(region, spacing)
    area = region.geometry(1e-3 * spacing)
    assert volume.sum() == pytest.approx(area.area, rel=1e-12)
    assert abs(len(volume) - area.area / spacing**2) < 0.04 * len(volume)  # whole layers
    assert shapely.contains_xy(area, *position.T).all()
    assert cKDTree(position).query(position, 2)[0][:, 1].min() > 0.65 * spacing
    assert 0.4 < volume.min() / spacing**2 < volume.max() / spacing**2 < 1.4


@settings(deadline=None, max_examples=30)
@given(st.floats(0.03, 0.2), st.lists(st.floats(0.1, 1.0), min_size=3, max_size=8))
def test_volumes_of_any_star_add_up(spacing: float, radii: list[float]) -> None:
    angle = 2.0 * np.pi * np.arange(len(radii)) / len(radii)
    region = PolygonRegion(points=(np.array(radii) * [np.cos(angle), np.sin(angle)]).T.tolist())
    assert fill(region, spacing).volume.sum() == pytest.approx(region.geometry(1.0).area, rel=1e-12)


def test_a_box_has_its_lattice() -> None:
    position, volume = fill(BoxRegion(lower=(0, 0), upper=(1.2, 0.6)), 0.004)
    assert position.shape == (45_000, 2)
    assert volume == pytest.approx(0.004**2)
    assert fill(BoxRegion(lower=(0, 0, 0), upper=(1, 1, 0.98)), 0.1).volume == pytest.approx(0.098 * 0.01)


def test_a_lattice_fits_all_edges_parallel_to_an_axis() -> None:
    points = ((0, 0), (1.2, 0), (1.2, 0.4), (0.811, 0.4), (0.811, 0.293), (0.387, 0.293), (0.387, 0.4), (0, 0.4))
    position, volume = fill(PolygonRegion(points=points), DX)
    away = shapely.distance(shapely.LinearRing(points), shapely.points(position))
    assert away.min() / DX == pytest.approx(0.5, abs=0.05)
    assert volume.sum() == pytest.approx(0.48 - 0.424 * 0.107, rel=1e-12)
    low, high = ({"shape": "box", "lower": (0, y), "upper": (x, y + 0.2)} for x, y in ((1, 0), (0.31, 0.2)))
    assert np.unique(fill(UnionRegion(of=[low, high]), DX).volume.round(12)).size <= 4


SPHERE = SphereRegion(centre=(0.1, 0.2, 0.3), radius=0.5)


def test_volumes_of_solids_add_up(tmp_path: Path) -> None:
    torus = trimesh.creation.torus(0.5, 0.2)
    torus.export(tmp_path / "torus.ply")
    regions = {
        4.0 / 3.0 * math.pi * 0.125: SPHERE,
        math.pi * 0.09 * math.sqrt(0.45): CylinderRegion(start=(0, 0, 0), stop=(0.6, 0, 0.3), radius=0.3),
        torus.volume: MeshRegion(file=str(tmp_path / "torus.ply")),
    }
    for expected, region in regions.items():
        position, volume = fill(region, 0.08)
        assert volume.sum() == pytest.approx(expected, rel=1e-6)
        assert abs(len(volume) * 0.08**3 / expected - 1.0) < 0.01
        assert 0.4 < volume.min() / 0.08**3 < volume.max() / 0.08**3 < 1.7
        assert cKDTree(position).query(position, 2)[0][:, 1].min() > 0.6 * 0.08


def test_beside_a_sphere_the_filling_is_that_of_the_lattice() -> None:
    """The share outside is a Monte Carlo integral, the kernel a Gaussian cut off at 3 h."""
    spacing, rng = 0.08, np.random.default_rng(0)
    position, volume = fill(SPHERE, spacing)
    h = 1.1 * spacing

    def kernel(r: np.ndarray) -> np.ndarray:
        return (np.exp(-((r / h) ** 2)) - math.exp(-9.0)) / (5.55192 * h**3) * (r < 3 * h)

    ball = rng.normal(size=(100_000, 3))
    ball *= (3 * h * rng.random(len(ball)) ** (1 / 3) / np.linalg.norm(ball, axis=1))[:, None]
    weight = kernel(np.linalg.norm(ball, axis=1))
    depth = SPHERE.radius - np.linalg.norm(position - SPHERE.centre, axis=1)
    tree = cKDTree(position)
    found = []
    for x in position[depth < 1.5 * spacing][::20]:
        near = tree.query_ball_point(x, 3 * h)
        outside = np.linalg.norm(x + ball - SPHERE.centre, axis=1) > SPHERE.radius
        fluid = volume[near] @ kernel(np.linalg.norm(position[near] - x, axis=1))
        found.append(fluid + weight[outside].sum() / weight.sum())
    assert 0.99 < np.min(found) < np.max(found) < 1.04
    assert depth.min() > 0.15 * spacing


def test_a_mesh_of_a_box_has_the_lattice_of_the_box(tmp_path: Path) -> None:
    lower, upper = (0, 0, 0), (1, 0.5, 0.31)
    trimesh.creation.box(bounds=(lower, upper)).export(tmp_path / "box.obj")
    mesh, box = fill(MeshRegion(file=str(tmp_path / "box.obj")), 0.05), fill(BoxRegion(lower=lower, upper=upper), 0.05)
    np.testing.assert_allclose(mesh.position, box.position, atol=1e-9)
    np.testing.assert_allclose(mesh.volume, box.volume, rtol=1e-9)


def test_what_solids_have_in_common() -> None:
    """Two balls of radius 0.5 whose centres are 0.6 apart: pi (4 R + d) (2 R - d)^2 / 12."""
    other = SphereRegion(centre=(0.7, 0.2, 0.3), radius=0.5)
    found = common_part(SPHERE, other, 0.05)
    assert found is not None
    assert found[0] == pytest.approx(math.pi * 2.6 * 0.16 / 12.0, rel=0.15)
    np.testing.assert_allclose(found[1], (0.4, 0.2, 0.3), atol=0.01)
    apart = SphereRegion(centre=(0.9, 0.8, 0.3), radius=0.499)
    assert common_part(SPHERE, apart, 0.05) is None
    assert common_part(SPHERE, BoxRegion(lower=(0.6, -1, -1), upper=(1, 1, 1)), 0.05) is None


def test_particles_of_a_region_cannot_be_changed() -> None:
    with pytest.raises(ValueError, match="read-only"):
        fill(CURVED["disc"], DX).position[0] = 0.0


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"level": 0.2, "pressure": 5.0}, "both given"),
        ({"level": -0.1}, "lies below the region"),
        ({"level": math.nan}, "finite"),
        ({"velocity": (1.0, 0.0, 0.0)}, "2 components"),
    ],
)
def test_impossible_states_are_refused(given: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        BoxRegion(lower=(0, 0), upper=(1, 1), **given)


def test_an_open_line_is_no_region() -> None:
    with pytest.raises(ValueError, match="open line"):
        CurveRegion(x="t", y="t**2")
