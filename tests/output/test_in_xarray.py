"""The file of a run at home in xarray: plain, by its own backend, in pieces, saved and opened, and under CF."""

import subprocess
import sys
import warnings
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import xarray as xr

from sphframe.analysis import export_run
from sphframe.output import NetCDFWriter, open_dataset


@pytest.fixture(params=["complete", "stopped"])
def path(request: pytest.FixtureRequest, tmp_path: Path, fake: ModuleType) -> Path:
    """A file, by the stand-in for a simulation; a stopped run leaves room for samples in its file."""
    path = tmp_path / "run.nc"
    writer, simulation = NetCDFWriter(path), fake.FakeSimulation(fake.FakeCase(until=0.3))
    writer.sphframe_run_started(simulation=simulation)
    if request.param == "complete":
        fake.play(writer, simulation, 31)
        writer.sphframe_run_finished(simulation=simulation)
    else:
        fake.play(writer, simulation, 21)
        writer.sphframe_run_failed(simulation=simulation, error=ValueError("too wet"))
    return path


def check(dataset: xr.Dataset, count: int) -> None:
    assert dataset.sizes["probe_time"] == count
    assert float(dataset.probe_pressure.sel(probe="left").sel(probe_time=0.104, method="nearest")) == pytest.approx(
        10.0
    )
    assert float(dataset.probe_pressure.interp(probe_time=0.105).sel(probe="left")) == pytest.approx(10.5)
    assert dataset.sph.summary()["steps"] == count - 1


def test_every_way_leads_to_the_same(path: Path, tmp_path: Path) -> None:
    count = open_dataset(path).sizes["probe_time"]
    check(open_dataset(path), count)
    check(xr.open_dataset(path, engine="sphframe"), count)
    fewer = xr.open_dataset(path, engine="sphframe", drop_variables=["density", "absent"])
    assert open_dataset(path).variables.keys() - fewer.variables.keys() == {"density"}
    with xr.open_dataset(path) as plain:
        assert plain.sph.summary()["steps"] == count - 1
        if count == 31:
            check(plain, count)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        open_dataset(path).to_netcdf(tmp_path / "saved.nc")
    check(xr.open_dataset(tmp_path / "saved.nc"), count)
    saved = open_dataset(tmp_path / "saved.nc")
    check(saved, count)
    assert saved.attrs["completed"] == ("yes" if count == 31 else "no")


def test_in_pieces(path: Path) -> None:
    pytest.importorskip("dask")
    dataset = xr.open_dataset(path, engine="sphframe", chunks={"time": 1})
    assert dataset.position.chunks[0] == (1,) * dataset.sizes["time"]
    assert float(dataset.density.mean()) == pytest.approx(float(open_dataset(path).density.mean()))


def test_zarr(path: Path, tmp_path: Path) -> None:
    pytest.importorskip("zarr")
    original = open_dataset(path)
    (store,) = export_run(original, tmp_path / "zarr", "zarr")
    found = open_dataset(store)
    check(found, original.sizes["probe_time"])
    xr.testing.assert_equal(found.load(), original.load())
    assert xr.open_zarr(store).sph.summary() == original.sph.summary()


@pytest.mark.parametrize("path", ["complete"], indirect=True)
@pytest.mark.parametrize("module", ["xarray", "sphframe"])
def test_the_accessor_needs_no_further_import(path: Path, module: str) -> None:
    program = f"import {module}; d = {module}.open_dataset({str(path)!r}); print(d.sph.summary()['steps'])"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert int(done.stdout) > 1


def test_coordinates_and_units_follow_cf(path: Path) -> None:
    cf = pytest.importorskip("cf_xarray")
    assert cf
    dataset = open_dataset(path)
    plain = xr.open_dataset(path)
    assert not [name for name in plain.coords if "_FillValue" in plain[name].encoding]
    assert plain.history
    assert {name: dataset[name].units for name in ("body_position", "body_angle", "body_angular_velocity")} == {
        "body_position": "m", "body_angle": "rad", "body_angular_velocity": "rad s-1"
    }  # fmt: skip
    np.testing.assert_array_equal(dataset.probe_pressure.cf["X"], dataset.probe_x)
    np.testing.assert_array_equal(dataset.probe_pressure.cf["vertical"], dataset.probe_y)


@pytest.mark.parametrize("path", ["complete"], indirect=True)
def test_the_compliance_checker_finds_no_other_error_than_that_time_is_no_date(path: Path) -> None:
    """Simulated time has no date: CF asks for one, and with it xarray would turn all times into dates."""
    pytest.importorskip("compliance_checker")
    command = [sys.executable, "-W", "ignore", "-c", CHECK, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert [line for line in done.stdout.splitlines() if "should have standard_name='time'" not in line] == []


CHECK = """
import sys
from compliance_checker.runner import CheckSuite
CheckSuite.load_all_available_checkers()
suite = CheckSuite()
found = suite.run_all(suite.load_dataset(sys.argv[1]), ["cf:1.11"], [])
for results, errors in found.values():
    for error in errors:
        print("raised", error)
    for result in results:
        if result.weight == 3 and result.value[0] < result.value[1]:
            for message in result.msgs:
                print(message)
"""
