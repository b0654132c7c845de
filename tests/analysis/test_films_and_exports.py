"""Films and exports, read by other programs, hold the data of the dataset."""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from typer.testing import CliRunner

import sphframe
from sphframe.analysis import animate_run, export_run, particles_at, plot_run, references_for, vtk_parts, water_surface
from sphframe.analysis.drawing import view_of
from sphframe.analysis.films import film_frames
from sphframe.analysis.placed import walls_at
from sphframe.cli.app import app
from sphframe.errors import InputError


def test_frames_of_a_film_show_the_water(tank: xr.Dataset) -> None:
    still, moved = film_frames(tank, times=[0.0, 0.02])
    assert still.shape == moved.shape
    assert still.shape[1] == 1280
    assert not any(size % 2 for size in still.shape[:2])
    coloured = np.ptp(still[:, :1150, :3].astype(int), axis=2) > 40  # not grey, left of the colour bar
    assert coloured.sum() > 20_000
    assert (still != moved).any(), "the time, at least, changes"


@pytest.mark.parametrize("ending", ["mp4", "gif"])
def test_film_is_read_back(tank: xr.Dataset, tmp_path: Path, ending: str) -> None:
    imageio_ffmpeg = pytest.importorskip("imageio_ffmpeg")
    film = tmp_path / f"tank.{ending}"
    going = tank.assign_attrs(completed="no", run_status="running")
    count = animate_run(going, film, field="speed", frames_per_second=10.0)
    assert count == tank.sizes["time"]
    assert imageio_ffmpeg.count_frames_and_secs(str(film))[0] == count


def test_films_that_cannot_be_made(tank: xr.Dataset, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"\.mp4 or \.gif"):
        animate_run(tank, tmp_path / "tank.avi")
    with pytest.raises(InputError, match="no frame yet"):
        animate_run(tank.isel(time=slice(0)), tmp_path / "tank.gif")


@pytest.mark.parametrize("to", ["vtkhdf", "pvd"])
@pytest.mark.parametrize("name", ["tank", "tank_3d"])
def test_vtk_reads_what_was_exported(name: str, to: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    pyvista = pytest.importorskip("pyvista")
    dataset = request.getfixturevalue(name)
    export_run(dataset, tmp_path, to)
    last = dataset.sizes["time"] - 1
    fluid, ghosts, walls = (_read(tmp_path, part, to, last) for part in ("fluid", "ghosts", "walls"))
    frame = dataset.isel(time=-1)
    dim = dataset.sizes["space"]
    assert fluid.n_points == dataset.sizes["particle"]
    np.testing.assert_array_equal(fluid.points[:, :dim], frame["position"])
    for field in ("pressure", "density"):
        np.testing.assert_array_equal(fluid[field], frame[field])
    np.testing.assert_array_equal(fluid["velocity"][:, :dim], frame["velocity"])
    low, high = (f(frame["position"].values, axis=0) for f in (np.min, np.max))
    np.testing.assert_allclose(np.reshape(fluid.bounds, (3, 2))[:dim], np.stack([low, high], axis=1))
    assert ghosts.n_points == dataset.sizes["ghost"]
    np.testing.assert_array_equal(ghosts["pressure"], frame["ghost_pressure"])
    np.testing.assert_array_equal(walls.points[:, :dim], dataset["outline_node"])
    if dim == 3:  # the surfaces of the closed faces of the tank
        surfaces = _read(tmp_path, "surfaces", to, last)
        size = np.ptp(dataset["outline_node"].values, axis=0)
        assert surfaces.area == pytest.approx(size[0] * size[1] + 2 * (size[0] + size[1]) * size[2])
    if to == "pvd":
        steps = ElementTree.parse(tmp_path / "fluid.pvd").findall("./Collection/DataSet")
        np.testing.assert_array_equal([float(step.get("timestep", "")) for step in steps], dataset["time"])
        assert pyvista.PVDReader(tmp_path / "fluid.pvd").time_values == dataset["time"].values.tolist()


@pytest.mark.parametrize("to", ["vtkhdf", "pvd"])
def test_vtk_reads_the_surface_of_the_water(tank_3d: xr.Dataset, to: str, tmp_path: Path) -> None:
    pytest.importorskip("pyvista")
    made = tank_3d.copy(deep=True)
    made["position"][-1, ::2] = np.nan  # so that the surface has other triangles at the end
    made["velocity"][:] = [0.3, 0.0, -0.4]
    written = export_run(made, tmp_path, to, surface=True)
    assert {"water", "fluid", "surfaces"} < {path.stem for path in written}
    for step, time in ((0, 0.0), (made.sizes["time"] - 1, None)):
        water, read = water_surface(made, time), _read(tmp_path, "water", to, step, made.sizes["time"])
        np.testing.assert_allclose(read.points, water.nodes, atol=1e-6)
        np.testing.assert_array_equal(read.regular_faces, water.triangles)
        assert read.is_manifold
        pressure = water.average @ particles_at(made, time)["pressure"].values
        np.testing.assert_allclose(read["pressure"], pressure, rtol=1e-5, atol=1e-3)
        np.testing.assert_allclose(read["velocity"], [[0.3, 0.0, -0.4]] * read.n_points, atol=1e-6)
        np.testing.assert_allclose(read["speed"], 0.5, atol=1e-6)
        np.testing.assert_allclose(read.point_data.active_normals, water.normals, atol=1e-6)


def test_surfaces_that_cannot_be_exported(tank: xr.Dataset, tank_3d: xr.Dataset, tmp_path: Path) -> None:
    pytest.importorskip("pyvista")
    with pytest.raises(InputError, match="only runs in three dimensions"):
        export_run(tank, tmp_path / "tank", "pvd", surface=True)
    with pytest.raises(InputError, match="written as pvd or vtkhdf, not as csv"):
        export_run(tank_3d, tmp_path / "tank", "csv", surface=True)
    assert not (tmp_path / "tank").exists()
    dry = tank_3d.copy(deep=True)
    dry["position"][0] = np.nan
    with pytest.raises(InputError, match="no water in the frame at t = 0 s"):
        export_run(dry, tmp_path / "tank", "pvd", surface=True)
    assert "water" not in vtk_parts(tank_3d)


def _read(folder: Path, part: str, to: str, step: int, steps: int | None = None):  # type: ignore[no-untyped-def]
    import pyvista

    if to == "pvd":
        return pyvista.read(folder / f"{part}_{step:04d}.vtp")
    from vtkmodules.vtkIOHDF import vtkHDFReader

    reader = vtkHDFReader()
    reader.SetFileName(str(folder / f"{part}.vtkhdf"))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == (steps or step + 1)
    reader.SetStep(step)
    reader.Update()
    return pyvista.wrap(reader.GetOutput())


@pytest.mark.parametrize("to", ["pvd", "vtkhdf"])
def test_exports_are_not_much_larger_than_the_run(tank: xr.Dataset, to: str, tmp_path: Path) -> None:
    """Of a run of 120 frames, so that what all files begin with does not count."""
    pytest.importorskip("pyvista")
    times = np.linspace(0.0, 1.2, 120)
    disorder = np.random.default_rng(1).normal(size=(120, 480, 2))
    frames = [tank.isel(time=-1).drop_vars("time") + 0 * tank.probe_time[0].values for _ in times]
    longer = xr.concat(
        [frame[["position", "velocity", "pressure", "density", "ghost_pressure"]] for frame in frames], "time"
    )
    longer = longer.assign_coords(time=times) + 1e-3 * disorder.mean()
    for name in ("position", "velocity"):
        longer[name] = longer[name] + 1e-3 * disorder
    for name in ("pressure", "density"):
        longer[name] = longer[name] + disorder[..., 0]
    made = tank.drop_dims("time").merge(longer)
    export_run(made, tmp_path / to, to)
    size = sum(file.stat().st_size for file in (tmp_path / to).iterdir())
    assert size < {"pvd": 1.5, "vtkhdf": 1.52}[to] * made.nbytes, "of noise, which cannot be compressed"


@pytest.mark.parametrize(("name", "turn"), [("tank", [0.0, 0.1, np.pi / 2]), ("tank_3d", [0, 0, 0.1, 0, np.pi / 2, 0])])
def test_turned_bodies_are_drawn_turned(name: str, turn: list[float], request: pytest.FixtureRequest) -> None:
    """A quarter turn about (0.2, 0.3) or the axis y there: x - 0.2 becomes the height above 0.3, less or more 0.1 m."""
    dataset = request.getfixturevalue(name)
    dim, end = dataset.sizes["space"], float(dataset.time[-1])
    centre = np.array([0.2, 0.3] if dim == 2 else [0.2, 7.0, 0.3])
    progress, angle = dataset["probe_time"].values / end, turn[2] if dim == 2 else turn[3:]
    made = dataset.assign(
        body_position=(("probe_time", "body", "space"), progress[:, None, None] * np.array(turn[:dim])),
        body_angle=(("probe_time", "body", *(["space"] * (dim - 2))), np.multiply.outer(progress, angle)[:, None]),
        body_centre=(("body", "space"), centre[None]),
        wall_body=dataset["wall_body"] * 0,
        ghost_body=dataset["ghost_body"] * 0,
    )

    def expected(points: np.ndarray) -> np.ndarray:
        across, up = points[..., 0] - 0.2, points[..., -1] - 0.3
        sense = 1.0 if dim == 2 else -1.0  # a positive turn about y leads from z to x
        result = points.copy()
        result[..., 0], result[..., -1] = 0.2 - sense * up, 0.4 + sense * across
        return result

    walls = np.concatenate([points for points, _ in walls_at(made, end)])
    np.testing.assert_allclose(walls, expected(dataset["outline_node"].values), atol=1e-12)
    assert np.ptp(view_of(made, [particles_at(made, end)])[1]) > 0.9, "the picture shows where the walls have turned to"
    parts = pytest.importorskip("pyvista") and vtk_parts(made, end)
    flat = np.s_[:, :dim]
    np.testing.assert_allclose(parts["ghosts"].points[flat], expected(dataset["ghost_position"].values), atol=1e-12)
    if dim == 3:
        surface = expected(dataset["triangle_node"].values.reshape(-1, 3))
        np.testing.assert_allclose(parts["surfaces"].points, surface, atol=1e-12)
        half = walls_at(made, 0.5 * end)[0][0] - centre
        length = np.linalg.norm(dataset["outline_node"].values[0] - centre)
        assert np.linalg.norm(half - [0, 0, 0.05], axis=1)[0] == pytest.approx(length, rel=1e-3), (
            "walls keep their shape"
        )


def test_csv_holds_all_samples(tank: xr.Dataset, tmp_path: Path) -> None:
    (path,) = export_run(tank, tmp_path / "tables", "csv")
    table = pd.read_csv(path)
    np.testing.assert_allclose(table["time (s)"], tank["probe_time"])
    np.testing.assert_allclose(table["probe_pressure[P0] (Pa)"], tank["probe_pressure"].sel(probe="P0"))
    np.testing.assert_allclose(table["total_energy (J m-1)"], tank["total_energy"])
    with pytest.raises(InputError, match="pvd, vtkhdf, csv"):
        export_run(tank, tmp_path, "vtk")


def test_references_of_a_folder_are_those_of_the_probes(tank: xr.Dataset, tmp_path: Path) -> None:
    for name in ("measured_P0", "measured_P9"):
        (tmp_path / f"{name}.csv").write_text("# columns: t,p\n0,1\n0.1,1\n")
    found = references_for(tank, tmp_path)
    assert [series.name for series in found] == ["measured_P0"]
    shown = [text.get_text() for text in plot_run(tank, reference=found).findobj() if hasattr(text, "get_text")]
    assert "measured_P0" in shown
    (tmp_path / "measured_P0.csv").unlink()
    with pytest.raises(InputError, match=r"measured_P1\.csv"):
        references_for(tank, tmp_path)


def test_commands(tmp_path: Path) -> None:
    path = tmp_path / "tank.nc"
    case = {"particle_spacing": 0.025, "until": 0.002, "frame_interval": 0.001, "courant_number": 0.3}
    sphframe.run("hydrostatic-tank", output=path, threads=1, **case).dataset.close()
    for arguments, made in (
        (["plot", str(path), "--time", "0.001", "--surface"], "tank.png"),
        (["animate", str(path), "-o", str(tmp_path / "tank.gif")], "tank.gif"),
        (["export", str(path), "--to", "csv"], "tank-csv/series.csv"),
        (["export", str(path), "--to", "pvd"], "tank-pvd/fluid.pvd"),
    ):
        result = CliRunner().invoke(app, arguments)
        assert result.exit_code == 0, result.output
        assert made in result.output.replace("\n", "")
        assert (tmp_path / made).stat().st_size > 100
    assert CliRunner().invoke(app, ["plot", str(path), "--field", "colour"]).exit_code == 2


def test_commands_that_show_the_surface_of_the_water(tank: xr.Dataset, tank_3d: xr.Dataset, tmp_path: Path) -> None:
    pytest.importorskip("pyvista")
    tank_3d.isel(time=[0]).to_netcdf(tmp_path / "box.nc", format="NETCDF3_64BIT")
    tank.isel(time=[0]).to_netcdf(tmp_path / "flat.nc", format="NETCDF3_64BIT")
    for command, made in (
        (["plot", "--oblique"], "box.png"),
        (["animate", "--oblique", "-o", str(tmp_path / "box.gif")], "box.gif"),
        (["export"], "box-pvd/water.pvd"),
    ):
        for name, code in (("box.nc", 0), ("flat.nc", 2)):
            result = CliRunner().invoke(app, [command[0], str(tmp_path / name), "--surface", *command[1:]])
            assert result.exit_code == code, result.output
            assert ("Traceback" in result.output, "three dimensions" in result.output) == (False, code == 2)
        assert (tmp_path / made).stat().st_size > 100
