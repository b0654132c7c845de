"""Shapes against closed forms: areas, lengths, distances, and what is refused."""

import json
import math
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
import trimesh
from hypothesis import example, given
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from sphframe.geometry import (
    SHAPES,
    AnyShape,
    Arc,
    Curve,
    Ellipse,
    Mesh,
    PointsFile,
    Polygon,
    Polyline,
    Region,
    sampled,
)

made = TypeAdapter(AnyShape).validate_python
BOX = {"shape": "box", "lower": (0, 0), "upper": (2, 1)}
DISC = {"shape": "circle", "centre": (1, 1), "radius": 0.5}
ELLIPSE = {"shape": "ellipse", "centre": (0, 0), "semi_axes": (3, 1), "angle": 30}


@pytest.mark.parametrize(
    ("table", "area"),
    [
        ({"shape": "polygon", "points": [(0, 0), (2, 0), (2, 1)]}, 1.0),
        (BOX, 2.0),
        (DISC, 0.25 * math.pi),
        (ELLIPSE, 3.0 * math.pi),
        ({"shape": "curve", "x": "2*cos(2*pi*t)", "y": "sin(2*pi*t)", "closed": True}, 2.0 * math.pi),
        ({"shape": "union", "of": [BOX, {"shape": "box", "lower": (1, 0), "upper": (3, 1)}]}, 3.0),
        ({"shape": "difference", "of": BOX, "minus": [DISC]}, 2.0 - 0.125 * math.pi),
    ],
    ids=lambda value: value["shape"] if isinstance(value, dict) else "",
)
def test_closed_shapes_have_their_area(table: dict[str, Any], area: float) -> None:
    shape = made(table)
    curved = "curve" in table["shape"]
    for tolerance in (1e-2, 1e-4):
        found = shape.geometry(tolerance)
        assert isinstance(found, shapely.Polygon)
        assert found.is_valid
        error = 0.05 * tolerance if table["shape"] == "difference" else 10.0 * tolerance if curved else 1e-12
        assert found.area == pytest.approx(area, abs=error)
    lower, upper = shape.bounds()
    np.testing.assert_allclose([*lower, *upper], shape.geometry(1e-6).bounds, atol=0.003)


@pytest.mark.parametrize("tolerance", [0.1, 0.01, 1e-4])
def test_chords_of_an_arc_are_within_the_tolerance(tolerance: float) -> None:
    line = Arc(centre=(0, 0), radius=2.0, start=20.0, stop=320.0).geometry(tolerance)
    angle = np.radians(np.linspace(20.0, 320.0, 20_001))
    away = shapely.distance(shapely.points(2.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)), line)
    assert tolerance / 2 < away.max() <= tolerance
    assert Arc(centre=(0, 0), radius=2.0, start=20.0, stop=20.5).geometry(tolerance).length == pytest.approx(
        2.0 * math.radians(0.5), rel=1e-4
    )


@pytest.mark.parametrize("tolerance", [0.1, 0.01, 1e-4])
def test_chords_are_within_the_tolerance(tolerance: float) -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 20_001)
    cos, sin = math.cos(math.pi / 6), math.sin(math.pi / 6)
    curve = np.stack([3 * np.cos(angle), np.sin(angle)], axis=1) @ [[cos, sin], [-sin, cos]]
    for shape in (
        Ellipse(centre=(0, 0), semi_axes=(3, 1), angle=30),
        Curve(
            x=f"3*cos(t)*{cos}-sin(t)*{sin}", y=f"3*cos(t)*{sin}+sin(t)*{cos}", start=0, stop=2 * math.pi, closed=True
        ),
    ):
        ring = shape.geometry(tolerance).exterior
        away = shapely.distance(shapely.points(curve), ring)
        assert tolerance / 100 < away.max() <= tolerance
        assert shapely.distance(shapely.points(ring.coords), shapely.LineString(curve)).max() <= tolerance


def test_open_shapes_are_lines_that_keep_their_ends() -> None:
    arc = made({"shape": "arc", "centre": (0, 0), "radius": 2, "start": 180, "stop": 270}).geometry(1e-4)
    assert arc.length == pytest.approx(math.pi, abs=1e-3)
    np.testing.assert_allclose(arc.coords[0], (-2, 0), atol=1e-15)
    np.testing.assert_allclose(arc.coords[-1], (0, -2), atol=1e-15)
    bed = Curve(x="t", y="t**2 / 2", start=0, stop=1).geometry(1e-6)
    assert bed.length == pytest.approx((math.sqrt(2) + math.asinh(1)) / 2, abs=1e-5)
    loop = Polyline(points=[(0, 0), (1, 0), (1, 1), (0, 0)]).geometry(0.1)
    assert loop.is_ring


@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=3, max_size=6, unique=True))
@example([(1.0, 1.0), (0.0, 1.7e-35), (-1.0, 0.0), (0.0, 0.0)])  # valid, but without area
def test_a_polygon_is_either_valid_or_refused(points: list[tuple[float, float]]) -> None:
    try:
        polygon = Polygon(points=points).geometry(0.1)
    except ValidationError:
        pass
    else:
        assert polygon.is_valid
        assert polygon.area > 0


def test_points_come_from_a_file_and_stay_with_the_shape(tmp_path: Path) -> None:
    path = tmp_path / "bed.csv"
    path.write_text("\ufeff# surveyed\nx, y\n0, 0\n1, 0.5\n2,0\n", encoding="utf-8")
    shape = PointsFile(file=str(path), closed=True)
    assert shape.geometry(0.1).area == 0.5
    stored = json.loads(shape.model_dump_json())
    path.unlink()
    assert PointsFile(**stored) == shape


def test_points_of_a_function_are_a_shape() -> None:
    points = sampled(lambda t: (np.cos(t), np.sin(t)), 0.0, math.pi, 1e-5)
    assert Polygon(points=points.tolist()).geometry(0.1).area == pytest.approx(math.pi / 2, abs=1e-4)
    straight = sampled(lambda t: (t, 0.0), 0.0, 1.0, 1e-5)
    assert len(straight) == 17
    # along itself, with its tip between two points
    back = sampled(lambda t: (1.0 - t**2, 0.0 * t), -0.775, 0.825, 1e-5)
    assert back[:, 0].max() == pytest.approx(1.0, abs=1e-5)


def test_a_shape_far_away_is_drawn_as_finely() -> None:
    def curve(x: float) -> Curve:
        return Curve(x=f"{x} + 0.01 * cos(t)", y="0.02 * sin(t)", start=0.1, stop=0.1 + 2 * math.pi, closed=True)

    assert np.subtract(curve(1e3).bounds(), [[1e3, 0.0], [1e3, 0.0]]) == pytest.approx(np.array(curve(0.0).bounds()))


@pytest.mark.parametrize("table", [{"shape": "sphere", "centre": (0, 0, 1), "radius": 2}], ids=str)
def test_solids_have_their_volume(table: dict[str, Any]) -> None:
    for tolerance in (0.1, 0.01):
        mesh = made(table).geometry(tolerance)
        assert mesh.is_watertight
        assert mesh.volume == pytest.approx(4 / 3 * math.pi * 8, rel=1e-9)
        radius = np.linalg.norm(mesh.triangles_center - [0, 0, 1], axis=1)
        assert np.abs(radius - 2).max() < 1.1 * tolerance
    cylinder = made({"shape": "cylinder", "start": (0, 0, 0), "stop": (1, 1, 0), "radius": 0.5})
    assert cylinder.dimension == 3
    assert cylinder.geometry(0.001).volume == pytest.approx(0.25 * math.pi * math.sqrt(2), rel=1e-9)


def test_a_mesh_is_repaired_where_there_is_one_way(tmp_path: Path) -> None:
    cube = trimesh.creation.box(extents=(1, 2, 3))
    triangles = cube.triangles.copy()
    triangles[4] = triangles[4][::-1]
    triangles = np.vstack([triangles, triangles[:1], [[[0, 0, 0], [1, 1, 1], [2, 2, 2]]]])
    soup = trimesh.Trimesh(triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3), process=False)
    for suffix in ("stl", "ply", "obj"):
        path = tmp_path / f"cube.{suffix}"
        soup.export(path)
        shape = Mesh(file=str(path), scale=0.1, offset=(1, 0, 0))
        assert shape.geometry(0.1).volume == pytest.approx(6e-3)
        np.testing.assert_allclose(shape.bounds(), [[0.95, -0.1, -0.15], [1.05, 0.1, 0.15]], atol=1e-6)
        stored = shape.model_dump()
        path.write_bytes(path.read_bytes() + b"\n")
        with pytest.raises(ValidationError, match="has changed since the case was stored"):
            Mesh(**stored)


def test_a_mesh_with_a_hole_names_the_triangles(tmp_path: Path) -> None:
    cube = trimesh.creation.box()
    cube.update_faces(np.arange(12) != 5)
    cube.export(tmp_path / "open.stl")
    with pytest.raises(ValidationError, match=r"not closed: 3 of its triangles \(counted from 0: \d+, \d+, \d+"):
        Mesh(file=str(tmp_path / "open.stl"))


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({"shape": "polygon", "points": [(0, 0), (1, 1), (1, 0), (0, 1)]}, r"crosses .* itself at \(0.5, 0.5\)"),
        ({"shape": "polygon", "points": [(0, 0), (1, 1), (2, 2)]}, "lie on one line"),
        ({"shape": "polygon", "points": [(0, 0), (1, 0), (1, 1), (0, 0)]}, "closed outline joins its last point"),
        ({"shape": "polygon", "points": [(0, 0), (1, 0), (1, 0), (0, 1)]}, r"point 2 equals the one before it, \(1.0"),
        ({"shape": "polygon", "points": [(0, 0), (1, 0), (math.nan, 1)]}, "finite number"),
        ({"shape": "polygon", "points": [(0, 0), (1, 0)]}, "at least 3 items"),
        ({"shape": "polyline", "points": [(0, 0), (2, 0), (2, 1), (1, -1)]}, r"crosses .* itself at \(1.5, 0\)"),
        ({"shape": "polyline", "points": [(0, 0), (0, 0)]}, "point 1 equals the one before"),
        ({"shape": "box", "lower": (0, 1), "upper": (1, 0)}, "do not span a box"),
        ({"shape": "circle", "centre": (0, 0), "radius": 0}, "greater than 0"),
        ({"shape": "ellipse", "centre": (0, 0), "semi_axes": (1, -1)}, "greater than 0"),
        ({"shape": "arc", "centre": (0, 0), "radius": 1, "start": 0, "stop": 360}, 'shape = "circle"'),
        ({"shape": "curve", "x": "t", "y": "__import__('os')"}, "is not understood"),
        ({"shape": "curve", "x": "t", "y": "t.real"}, "is not understood"),
        ({"shape": "curve", "x": "t", "y": "sin(t, t)"}, "is not understood"),
        ({"shape": "curve", "x": "t", "y": "2 *"}, "not an expression of t"),
        ({"shape": "curve", "x": "t", "y": "1 / t"}, "not finite at t = 0"),
        ({"shape": "curve", "x": "t", "y": "9**9**9**9"}, "not finite"),
        ({"shape": "curve", "x": "t", "y": "abs(t - 0.55) / (t - 0.55)"}, "jumps at t = 0.55"),
        ({"shape": "curve", "x": "1", "y": "2"}, "equals the one before"),
        ({"shape": "curve", "x": "t", "y": "t", "start": 1, "stop": 0}, "give start < stop"),
        ({"shape": "points", "file": "missing.csv"}, "cannot read missing.csv: no such file"),
        ({"shape": "union", "of": [BOX]}, "at least 2 items"),
        (
            {"shape": "union", "of": [BOX, {"shape": "polyline", "points": [(0, 0), (1, 1)]}]},
            "polyline is an open line",
        ),
        ({"shape": "difference", "of": DISC, "minus": [{**DISC, "radius": 1}]}, "nothing is left of the difference"),
        ({"shape": "cylinder", "start": (0, 0, 0), "stop": (0, 0, 0), "radius": 1}, "start and stop"),
        ({"shape": "mesh", "file": "missing.stl"}, "cannot read the mesh missing.stl: no such file"),
        ({"shape": "square"}, "does not match any of the expected tags"),
    ],
    ids=lambda value: value.get("shape") if isinstance(value, dict) else value[:20],
)
def test_what_cannot_be_represented_is_refused(table: dict[str, Any], message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        made(table)


@pytest.mark.parametrize(
    ("text", "message"),
    [("0, 0\n1\n", "line 2"), ("0, 0\n1; 2\n", "line 2"), ("x, y\nm, m\n", "line 2"), ("1, 2\n", "too few")],
)
def test_files_of_points_are_refused_with_the_line(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "bed.csv").write_text(text)
    with pytest.raises(ValidationError, match=message):
        PointsFile(file=str(tmp_path / "bed.csv"))


def test_every_shape_has_an_example_or_says_what_its_file_holds() -> None:
    for model in SHAPES.values():
        assert ">>>" in model.__doc__ or "file" in model.model_fields
    assert len(SHAPES) == 14


def test_the_examples_of_the_page_of_shapes_run() -> None:
    page = (Path(__file__).parents[2] / "docs" / "shapes.md").read_text(encoding="utf-8")
    tables, code = (re.search(rf"```{kind}\n(.*?)```", page, flags=re.DOTALL) for kind in ("toml", "python"))
    assert tables
    assert code
    drum, jet = TypeAdapter(tuple[Region, Region]).validate_python(tomllib.loads(tables[1])["fluid"])
    assert drum.geometry(1e-4).area == pytest.approx(math.pi * 0.045)
    assert jet.velocity == (0.0, -2.0)
    exec(code[1], {})
