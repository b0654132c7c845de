"""Runs in three dimensions seen obliquely: projection, order, light, and what is refused."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import EllipseCollection, TriMesh

from sphframe.analysis import particles_at, plot_run, water_surface
from sphframe.analysis.films import film_frames
from sphframe.analysis.oblique import _AXES, _TOWARDS, _light_on, draw_oblique, oblique_view
from sphframe.errors import InputError


def test_the_picture_is_seen_from_the_front_the_right_and_above() -> None:
    directions = np.column_stack([_AXES, _TOWARDS])
    np.testing.assert_allclose(directions.T @ directions, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(np.cross(*_AXES.T), _TOWARDS, atol=1e-14)
    assert np.all(_TOWARDS * [1, -1, 1] > 0.0)
    assert _AXES[2].tolist() == pytest.approx([0.0, np.cos(np.radians(22.0))]), "vertical lines stay vertical"


def test_light_falls_on_the_top_and_not_from_below_or_within() -> None:
    lattice = np.stack(np.meshgrid(*[np.arange(9.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    lit = _light_on(lattice, 1.0).reshape(9, 9, 9)
    assert lit[4, 4, 8] > 0.7
    assert lit[4, 4, 0] == 0.0
    assert lit[4, 4, 4] == pytest.approx(0.0, abs=0.05)
    assert lit[4, 0, 4] > lit[8, 4, 4] > lit[4, 8, 4]


def drawn(dataset: xr.Dataset, *, surface: bool = False) -> tuple[Any, xr.Dataset]:
    from matplotlib.figure import Figure

    frame, axes = particles_at(dataset, 0.0), Figure().add_subplot()
    draw_oblique(axes, dataset, frame, frame["pressure"].values, "viridis", (0.0, 1e3), surface=surface)
    return axes, frame


def test_near_particles_hide_far_ones_and_walls_are_where_they_are(tank_3d: xr.Dataset) -> None:
    axes, frame = drawn(tank_3d)
    (discs,) = [artist for artist in axes.collections if isinstance(artist, EllipseCollection)]
    position = frame["position"].values
    order = np.argsort(position @ _TOWARDS)
    np.testing.assert_allclose(discs.get_offsets(), position[order] @ _AXES)
    (left, right), (low, high) = oblique_view(tank_3d, [frame])
    assert np.all((discs.get_offsets() > [left, low]) & (discs.get_offsets() < [right, high]))
    corners = np.concatenate([np.column_stack(line.get_data()) for line in axes.lines if line.get_marker() == "None"])
    assert corners[:, 0].min() == pytest.approx(left, abs=0.05)
    assert corners[:, 0].max() == pytest.approx(right, abs=0.05)


def test_near_triangles_of_the_surface_hide_far_ones(tank_3d: xr.Dataset) -> None:
    pytest.importorskip("pyvista")
    axes, _ = drawn(tank_3d, surface=True)
    (mesh,) = axes.collections
    assert isinstance(mesh, TriMesh)
    water, shown = water_surface(tank_3d, 0.0), mesh._triangulation
    np.testing.assert_allclose(np.stack([shown.x, shown.y], axis=1), water.nodes @ _AXES)
    corners = (water.nodes @ np.column_stack([_AXES, _TOWARDS]))[shown.triangles]
    assert np.all(np.diff(corners[..., 2].mean(axis=1)) >= 0.0)
    (ax, ay), (bx, by) = (np.moveaxis(corners[:, k, :2] - corners[:, 0, :2], 1, 0) for k in (1, 2))
    assert np.all(ax * by > ay * bx), "those seen from within are hidden"
    assert 0.3 < len(shown.triangles) / len(water.triangles) < 0.7


def test_the_surface_has_light_from_above_and_the_colours_of_the_field(tank_3d: xr.Dataset) -> None:
    pytest.importorskip("pyvista")
    water, level = water_surface(tank_3d, 0.0), float(tank_3d.attrs["depth"])
    tank_3d = tank_3d.copy(deep=True)
    tank_3d["pressure"][:] = np.where(tank_3d["position"][..., 2] < 0.5 * level, 1e3, 0.0)
    axes, _ = drawn(tank_3d, surface=True)
    colour = axes.collections[0].get_facecolor()[:, :3]
    front = np.abs(water.nodes[:, 1]) < 1e-6
    middle = np.abs(water.nodes[:, 0] - water.nodes[:, 0].mean()) < 0.1
    height = water.nodes[:, 2] / level
    parts = (height > 0.99, front & (height > 0.65) & (height < 0.85), front & (height < 0.3))
    top, side, bottom = (colour[middle & part].mean(axis=0) for part in parts)
    assert top.sum() > 1.05 * side.sum()
    assert bottom[1] > 3.0 * side[1], "viridis ends with yellow"


def test_removed_particles_are_left_out(tank_3d: xr.Dataset) -> None:
    made = tank_3d.copy(deep=True)
    made["position"][:, 3] = np.nan
    axes, frame = drawn(made)
    assert len(axes.collections[0].get_offsets()) == frame.sizes["particle"] - 1


def test_pictures_and_films(tank_3d: xr.Dataset) -> None:
    figure = plot_run(tank_3d, times=[0.0], oblique=True)
    assert "slice" not in figure.get_suptitle()
    assert not figure.axes[0].axison
    still, later = film_frames(tank_3d, times=[0.0, 0.01], oblique=True)
    assert still.shape == later.shape
    assert (np.ptp(still[:, :1150, :3].astype(int), axis=2) > 40).sum() > 20_000
    assert (still != later).any()


def test_pictures_and_films_of_the_surface(tank_3d: xr.Dataset, tmp_path: Path) -> None:
    pytest.importorskip("pyvista")
    figure = plot_run(tank_3d, tmp_path / "tank.svg", times=[0.0], oblique=True, surface=True)
    assert [type(artist) for artist in figure.axes[0].collections] == [TriMesh]
    assert (tmp_path / "tank.svg").stat().st_size < 1_000_000, "the triangles are an image"
    still, later = film_frames(tank_3d, times=[0.0, 0.01], oblique=True, surface=True)
    assert (np.ptp(still[:, :1150, :3].astype(int), axis=2) > 40).sum() > 20_000
    assert (still != later).any()
    (discs,) = film_frames(tank_3d, times=[0.0], oblique=True)
    assert (still != discs).any()


def test_what_is_refused(tank: xr.Dataset, tank_3d: xr.Dataset, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InputError, match="only runs in three dimensions are seen obliquely"):
        plot_run(tank, oblique=True)
    with pytest.raises(InputError, match="only runs in three dimensions are seen obliquely"):
        next(film_frames(tank, oblique=True))
    with pytest.raises(InputError, match="ask for oblique too"):
        next(film_frames(tank_3d, surface=True))
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(InputError, match="surfaces of triangles need PyVista"):
        plot_run(tank_3d, oblique=True, surface=True)
    with pytest.raises(InputError, match="surfaces of triangles need PyVista"):
        next(film_frames(tank_3d, oblique=True, surface=True))
