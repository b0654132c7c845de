"""Analysis: numbers and pictures from a dataset."""

import errno
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import sphframe
from sphframe.analysis import (
    convergence_order,
    front_arrival,
    plot_run,
    probe_statistics,
    read_reference_series,
    rest_pressure,
    running_mean,
    series_error,
    summary,
)
from sphframe.analysis.drawing import beyond, run_title
from sphframe.analysis.figures import new_figure, save_figure
from sphframe.analysis.work import work_of_bodies
from sphframe.errors import InputError, OutputError


def test_importing_does_not_load_matplotlib() -> None:
    program = "import sys, sphframe.analysis; print('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], capture_output=True, check=True).stdout == b"False\n"


def test_summary_is_plain_data(tank: xr.Dataset) -> None:
    figures = json.loads(json.dumps(summary(tank)))
    assert figures["case"] == "hydrostatic-tank"
    assert figures["wall_treatment"] == "fixed-ghosts"
    assert figures["particles"] == 480
    assert figures["time"] == pytest.approx(0.02)
    assert figures["completed"] == "yes"
    assert sum(figures["statuses"].values()) == pytest.approx(1.0)
    assert figures["peaks"]["P0"]["dimensionless_pressure"] == pytest.approx(1.0, abs=0.05)
    assert figures["mass_drift"] == 0.0
    assert figures["front_arrival"] is None


def test_titles_name_the_wall_treatment_where_no_interpolator_is_used(tank: xr.Dataset) -> None:
    assert "improved-shepard, balanced lift" in run_title(tank)
    parameters = json.loads(tank.attrs["case_parameters"])
    parameters["wall_treatment"]["name"] = "dynamic-2007"
    title = run_title(tank.assign_attrs(case_parameters=json.dumps(parameters)))
    assert "dynamic-2007 walls" in title
    assert "shepard" not in title


def test_summary_of_a_run_that_has_just_begun(tank: xr.Dataset) -> None:
    assert summary(tank.isel(probe_time=slice(0), time=slice(0)))["steps"] == 0


def test_front_arrival_is_interpolated(tank: xr.Dataset) -> None:
    """The far wall is at x = 1 m; a front moving at 100 m/s is within a spacing (0.025 m) of it at 9.75 ms."""
    front = 100.0 * tank["probe_time"]
    arrival = front_arrival(tank.assign(front_position=front))
    assert arrival is not None
    assert arrival["time"] == pytest.approx(0.00975)
    assert arrival["dimensionless"] == pytest.approx(0.00975 * np.sqrt(9.81 / 0.3))
    assert front_arrival(tank.assign(front_position=0.1 * front)) is None


def test_rest_pressure_is_compressible(tank: xr.Dataset) -> None:
    p = rest_pressure(tank, [0.0, 0.1, 0.3, 0.5])
    np.testing.assert_allclose(p, [2943.0 * (1 + 0.5 / 400), 1962.0 * (1 + 0.5 * 2 / 3 / 400), 0.0, 0.0], rtol=2e-6)


def test_probe_statistics(tank: xr.Dataset) -> None:
    t = tank["probe_time"]
    made = tank.assign(probe_pressure=tank["probe_pressure"] * 0 + t)
    statistics = probe_statistics(made, start=0.0049, stop=0.0151, expected=np.zeros(4))
    inside = t.values[(t.values >= 0.0049) & (t.values <= 0.0151)]
    np.testing.assert_allclose(statistics["mean"], inside.mean())
    np.testing.assert_allclose(statistics["error"], inside.mean())
    np.testing.assert_allclose(statistics["std"].sel(probe="P2"), inside.std())
    with pytest.raises(InputError, match="covers 0 to"):
        probe_statistics(made, start=7.0)
    with pytest.raises(InputError, match="no probes"):
        probe_statistics(tank.drop_vars("probe_pressure"))


def test_fields_at_a_time(tank: xr.Dataset) -> None:
    frame = tank.sph.at(0.0101)
    assert float(frame.time) == pytest.approx(0.01, abs=0.001)
    assert frame.speed.shape == (480,)
    table = frame.to_dataframe()
    assert len(table) == 480, "one row a particle"
    np.testing.assert_array_equal(table[["x", "y"]], tank.position.sel(time=frame.time))
    np.testing.assert_allclose(table.velocity_x**2 + table.velocity_y**2, table.speed**2)
    assert float(tank.sph.at().time) == pytest.approx(0.02)
    with pytest.raises(InputError, match="outside the run"):
        tank.sph.at(5.0)
    with pytest.raises(InputError, match="no frame yet"):
        tank.isel(time=slice(0)).sph.at()


@pytest.mark.parametrize("name", ["tank", "tank_3d"])
def test_free_surface_and_grid(name: str, request: pytest.FixtureRequest) -> None:
    dataset = request.getfixturevalue(name)
    surface = dataset.sph.free_surface()
    np.testing.assert_allclose(surface, 0.3, atol=0.005)
    assert surface.units == "m"
    pressure = dataset.sph.to_grid("pressure", resolution=0.05)
    assert pressure.units == "Pa"
    vertical = "y" if name == "tank" else "z"
    assert pressure.dims[0] == vertical
    inside = pressure.where((pressure[vertical] > 0.08) & (pressure[vertical] < 0.22), drop=True)
    expected = xr.DataArray(rest_pressure(dataset, inside[vertical]), dims=(vertical,))
    assert float(np.abs(inside - expected).max()) < 60.0, "a grid value differs from the rest state by over 2 % rho g H"
    assert dataset.sph.to_grid("velocity").dims[-1] == "space"
    with pytest.raises(InputError, match="no field"):
        dataset.sph.to_grid("colour")


def test_dimensionless_series(tank: xr.Dataset) -> None:
    series = tank.sph.dimensionless("probe_pressure").sel(probe="P0")
    assert float(series[0]) == pytest.approx(1.0, abs=0.02)
    assert series.units == "1"
    np.testing.assert_allclose(series.probe_time, tank.probe_time * np.sqrt(9.81 / 0.3))
    reference = xr.DataArray(np.full(3, 0.5), coords={"t": [0.0, 0.05, 0.1]})
    assert tank.sph.error("probe_pressure", reference, probe="P0")["bias"] == pytest.approx(0.5, abs=0.02)


def test_series_that_do_not_overlap() -> None:
    series = xr.DataArray([0.0, 1.0], coords={"t": [0.0, 1.0]})
    with pytest.raises(InputError, match="do not overlap"):
        series_error(series, xr.DataArray([0.0, 1.0], coords={"t": [5.0, 6.0]}))


def test_running_mean_is_the_mean_over_a_window() -> None:
    t = np.linspace(0.0, 4.0, 9)
    np.testing.assert_allclose(running_mean(t, 2.0 * t, window=1.0, step=0.5)[1:-1], np.arange(1.0, 8.0))
    assert float(running_mean(t, 2.0 * t, window=1.0, step=0.5)[0]) == pytest.approx(0.5)  # over the first half only
    assert running_mean([0.0], [1.0], window=1.0, step=0.5).size == 0


def test_convergence_order() -> None:
    spacings = np.array([0.04, 0.02, 0.01])
    assert convergence_order(spacings, 3.0 * spacings**1.5) == pytest.approx(1.5)
    for bad in ([0.1], [0.0, 1.0]):
        with pytest.raises(InputError):
            convergence_order(bad, bad)


def test_reference_series(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("# source: nobody\n# columns: t,p,q\n2,20,\n1,10,5\n")
    series = read_reference_series(tmp_path, "a", "p")
    assert series.t.values.tolist() == [1.0, 2.0]
    assert series.values.tolist() == [10.0, 20.0]
    assert series.long_name == "p"
    assert read_reference_series(tmp_path, "a", "q").values.tolist() == [5.0]


@pytest.mark.parametrize(
    ("name", "column", "text", "message"),
    [
        ("b", 1, "1,2", "holds no b.csv; it holds a"),
        ("a", 1, "one,two", "not a reference series"),
        ("a", 1, "# nothing", "it has no rows"),
        ("a", "z", "# columns: t,p\n1,2", "no column 'z'; it has t, p"),
        ("a", 7, "1,2", "no column 7"),
        ("a", 1, "1,2\n3", "not a reference series"),
    ],
)
def test_bad_reference_series(tmp_path: Path, name: str, column: int | str, text: str, message: str) -> None:
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(InputError, match=message):
        read_reference_series(tmp_path, name, column)


def test_missing_reference_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="does not exist"):
        read_reference_series(tmp_path / "none", "a")


@pytest.mark.parametrize("name", ["tank", "tank_3d"])
@pytest.mark.parametrize("field", ["pressure", "speed"])
def test_plot(name: str, field: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    dataset = request.getfixturevalue(name)
    figure = plot_run(dataset, tmp_path / "run.png", field=field)
    assert (tmp_path / "run.png").stat().st_size > 10_000
    shown = " ".join(text.get_text() for text in figure.findobj(lambda artist: hasattr(artist, "get_text")))
    for word in ("Still water", "improved-shepard", "particles", field, "m/s" if field == "speed" else "kPa", "t"):
        assert word in shown, f"the picture does not say {word}"


def test_plot_of_a_run_that_has_just_begun(tank: xr.Dataset, tmp_path: Path) -> None:
    plot_run(tank.isel(time=slice(1), probe_time=slice(1)), tmp_path / "run.png")
    with pytest.raises(InputError, match="no frame yet"):
        plot_run(tank.isel(time=slice(0)))


def test_plot_with_reference_and_without_probes(tank: xr.Dataset) -> None:
    reference = xr.DataArray([0.9, 1.0], coords={"t": [0.0, 0.1]}, name="measured")
    figure = plot_run(tank, reference=reference, times=[0.0])
    assert "measured" in [text.get_text() for text in figure.findobj() if hasattr(text, "get_text")]
    plot_run(tank.drop_vars("probe_pressure"))


def test_picture_that_cannot_be_written(tank: xr.Dataset, tmp_path: Path) -> None:
    with pytest.raises(OutputError, match=r"cannot write the picture .*check its folder"):
        plot_run(tank, tmp_path / "nowhere" / "run.png")
    with pytest.raises(OutputError, match=r"\.png"):
        plot_run(tank, tmp_path / "run.xyz")
    with pytest.raises(InputError, match="pressure, speed"):
        plot_run(tank, field="colour")


def test_a_picture_beyond_the_limit_of_open_files_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise OSError(errno.EMFILE, os.strerror(errno.EMFILE))

    figure = new_figure(1.0, 1.0)
    monkeypatch.setattr(figure, "savefig", refuse)
    with pytest.raises(OutputError, match="ulimit -n"):
        save_figure(figure, tmp_path / "run.png")


def test_plot_of_probes_with_constant_pressure(tank: xr.Dataset) -> None:
    """matplotlib would warn about equal limits, and warnings are errors in tests."""
    for value in (0.0, 5.0e3, -2.0e3):
        made = tank.assign(probe_pressure=tank["probe_pressure"] * 0 + value)
        low, high = next(axes for axes in plot_run(made).axes if "probe" in axes.get_ylabel()).get_ylim()
        assert low <= 1e-3 * value <= high
        assert high > low


def test_dry_gauges_are_drawn_beside_others(tank: xr.Dataset) -> None:
    times = tank["probe_time"].values
    height = np.column_stack([0.3 + times, np.full_like(times, np.nan), np.full_like(times, np.nan)])
    gauges = tank.assign(gauge_elevation=(("probe_time", "gauge"), height), gauge_body=("gauge", np.full(3, -1)))
    gauges = gauges.assign(gauge_x=("gauge", np.full(3, 0.2))).assign_coords(gauge=["A", "B", "C"])
    assert any(axes.get_ylabel() == "surface elevation (m)" for axes in plot_run(gauges).axes)


@pytest.mark.parametrize("name", ["tank", "tank_3d"])
def test_plot_marks_probes_and_the_free_surface(name: str, request: pytest.FixtureRequest) -> None:
    dataset = request.getfixturevalue(name)
    panel = plot_run(dataset, times=[0.0], surface=True).axes[0]
    lines = [np.asarray(line.get_xydata(), dtype=np.float64) for line in panel.get_lines()]
    marks = np.concatenate([line for line in lines if len(line) == 1])
    np.testing.assert_allclose(marks[:, 1], dataset["probe_y" if name == "tank" else "probe_z"])
    surface = [line[np.isfinite(line[:, 1])] for line in lines if len(line) > 10]
    assert surface
    np.testing.assert_allclose(np.concatenate(surface)[:, 1], 0.3, atol=0.01)


def test_a_drop_is_not_joined_to_the_water_by_the_free_surface(tank: xr.Dataset) -> None:
    position = tank["position"].values.copy()
    position[:, 0] = [0.5, 0.5]
    made = tank.assign(position=(tank["position"].dims, position))
    panel = plot_run(made, times=[0.0], surface=True).axes[0]
    heights = np.concatenate([line.get_ydata() for line in panel.get_lines() if len(line.get_ydata()) > 5])
    assert not np.any((heights > 0.33) & (heights < 0.45))


def test_pictures_hide_nothing(tank: xr.Dataset) -> None:
    """A peak of one sample is inside the axes, and values beyond the colour bar are marked at its ends."""
    pressure = tank["probe_pressure"].values.copy()
    pressure[3, 1] = 29.9e3
    made = tank.assign(probe_pressure=(tank["probe_pressure"].dims, pressure), pressure=tank["pressure"] - 1e3)
    figure = plot_run(made)
    probes = next(axes for axes in figure.axes if "probe" in axes.get_ylabel())
    assert probes.get_ylim()[1] > 29.9
    assert beyond((0.0, 3.0), made["pressure"].values / 1e3) == "min"
    assert beyond((0.0, 3.0), np.array([1.0, np.nan])) == "neither"
    assert beyond((0.0, 3.0), np.array([-1.0, 5.0])) == "both"
    colours = {line.get_color() for line in probes.get_lines()}
    marks = {line.get_color() for line in figure.axes[0].get_lines() if len(line.get_xdata()) == 1}
    assert colours == marks


def test_long_flumes_are_drawn_taller_and_slices_are_named(tank: xr.Dataset, tank_3d: xr.Dataset) -> None:
    flume = tank.assign(outline_node=tank["outline_node"] * np.array([30.0, 1.0]))
    figure = plot_run(flume)
    assert figure.axes[0].get_aspect() > 2
    assert "times as large" in figure.get_suptitle()
    assert "times as large" not in plot_run(tank).get_suptitle()
    assert run_title(tank_3d).splitlines()[1] == "slice at y = 0.15 ± 0.025 m"


@pytest.mark.parametrize("reference", [[0.0, 0.0], [1.0, 0.0]])
def test_work_of_bodies(tank: xr.Dataset, reference: list[float]) -> None:
    """F = (-3, 0) N on a wall that moves at 2 m/s along x, and M = -5 N m about a point r from the centre, at 4 rad/s.

    A moment about the point is less by r x F than that about the centre, in which the power is F.v + M.omega.
    """
    n, t = tank.sizes["probe_time"], tank["probe_time"].values
    angle = 4.0 * t
    force = np.tile([[-3.0, 0.0]], (n, 1, 1))
    arm = np.stack([reference[0] * np.cos(angle), reference[0] * np.sin(angle)], axis=1)
    moment = -5.0 - (arm[:, 0] * 0.0 - arm[:, 1] * -3.0)
    zero = np.zeros(n)
    made = tank.assign(
        wall_body=("wall", [0]),
        wall_force=(("probe_time", "wall", "space"), force, {"units": "N m-1"}),
        wall_moment=(("probe_time", "wall"), moment[:, None]),
        wall_reference=(("wall", "space"), [reference]),
        body_centre=(("body", "space"), [[0.0, 0.0]]),
        body_position=(("probe_time", "body", "space"), np.stack([2.0 * t, zero], axis=1)[:, None]),
        body_angle=(("probe_time", "body"), angle[:, None]),
        body_velocity=(("probe_time", "body", "space"), np.tile([[2.0, 0.0]], (n, 1, 1))),
        body_angular_velocity=(("probe_time", "body"), np.full((n, 1), 4.0)),
    )
    work = work_of_bodies(made)
    assert work is not None
    np.testing.assert_allclose(work, (3.0 * 2.0 + 5.0 * 4.0) * t, rtol=1e-12, atol=1e-12)
    assert summary(made)["work_of_bodies"] == pytest.approx(26.0 * 0.02)
    assert summary(tank)["work_of_bodies"] == 0.0
    figure = plot_run(made.assign_coords(body=["float"]))
    labels = [axes.get_ylabel() for axes in figure.axes]
    for text in ("displacement of bodies (m)", "angle of bodies (°)", "force of the fluid (N/m)", "energy (mJ/m)"):
        assert text in labels, labels
    shown = [text.get_text() for text in figure.findobj() if hasattr(text, "get_text")]
    assert {"work of bodies", "float angle", "float x"} <= set(shown)


def test_the_clock_of_a_run_counts_output_and_hooks(tmp_path: Path) -> None:
    class Slow:
        @sphframe.hookimpl
        def sphframe_frame_due(self) -> None:
            time.sleep(0.15)

    case = {"particle_spacing": 0.025, "until": 0.004, "frame_interval": 0.002, "courant_number": 0.3}
    began = time.perf_counter()
    run = sphframe.run("hydrostatic-tank", output=tmp_path / "tank.nc", threads=1, hooks=[Slow()], **case)
    took = time.perf_counter() - began
    figures = summary(run.dataset)
    assert run.dataset.sizes["time"] == 3
    assert 0.3 < figures["wall_clock"] < took, "the last frame is written after the last sample"
    assert figures["processor_time"] < figures["wall_clock"] - 0.25, "sleep is no processor time"
    assert figures["steps_per_second"] == figures["steps"] / figures["wall_clock"]
    assert figures["waited"]
