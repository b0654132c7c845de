"""Output: the file holds the results, stays readable however the run ends, and is replaced only on request."""

import gc
import importlib.metadata
import json
import os
import random
import subprocess
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import netCDF4
import numpy as np
import psutil
import pytest
import xarray as xr

from sphframe.errors import InputError, OutputError, SimulationError
from sphframe.output import NetCDFWriter, open_dataset
from sphframe.output.contents import planned_size
from sphframe.output.lock import lock_file
from sphframe.output.run_file import RunFile
from sphframe.output.schema import VARIABLES


@pytest.fixture
def written(tmp_path: Path, fake: ModuleType) -> Path:
    path: Path = fake.write_run(tmp_path / "run.nc")
    return path


def test_a_dataset_that_is_closed_keeps_no_file_open(written: Path) -> None:
    def is_open() -> bool:
        return str(written) in {file.path for file in psutil.Process().open_files()}

    dataset = open_dataset(written)
    assert is_open()
    dataset.close()
    assert not is_open()


def test_values_come_back(written: Path) -> None:
    dataset = open_dataset(written)
    assert dict(dataset.sizes) | {"node": 5, "outline": 2} == dict(dataset.sizes)
    assert dataset.sizes["time"] == 4
    assert dataset.sizes["probe_time"] == 31
    np.testing.assert_allclose(dataset.time, [0.0, 0.1, 0.2, 0.3])
    np.testing.assert_allclose(dataset.position.isel(time=2, space=0), np.arange(50) + 0.2)
    np.testing.assert_allclose(dataset.density.isel(time=3), 1000.3)
    np.testing.assert_allclose(dataset.probe_pressure.sel(probe="Gefäß"), 1.0 + dataset.probe_time * 100.0)
    np.testing.assert_allclose(dataset.total_energy, dataset.kinetic_energy + 3.0)
    np.testing.assert_allclose(dataset.mass, 500.0)
    np.testing.assert_allclose(dataset.front_position, 2.0 + dataset.probe_time)
    np.testing.assert_allclose(dataset.body_position.sel(body="paddle", space="x"), dataset.probe_time)
    np.testing.assert_allclose(dataset.wall_force_by_pressure.sel(wall="tank", space="y"), 2.5)
    assert dataset.interpolation_status.sel(status="OK").values.tolist() == [20] * 31
    assert dataset.wall_body.values.tolist() == [-1, 0]
    assert dataset.probe_y.sel(probe="Gefäß") == 0.1
    assert dataset.gauge_elevation.gauge_x.values.tolist() == [0.5]
    assert dataset.attrs["completed"] == "yes"


def test_everything_has_unit_and_meaning(written: Path) -> None:
    dataset = open_dataset(written)
    for name, variable in dataset.variables.items():
        assert variable.attrs["long_name"], f"{name} has no long_name"
        if variable.dtype.kind in "fi":
            assert "units" in variable.attrs, f"{name} has no units"
    assert dataset.kinetic_energy.units == "J m-1", "energies of a 2-D run are per metre of width"
    assert dataset.Conventions.startswith("CF-1.")


def test_attributes_repeat_the_run(written: Path, fake: ModuleType) -> None:
    attributes = open_dataset(written).attrs
    assert fake.FakeCase(**json.loads(attributes["case_parameters"])) == fake.FakeCase()
    assert attributes["case_name"] == "sphframe_fake_simulation:FakeCase", "an unregistered case is named by its class"
    assert json.loads(attributes["components"])["kernel"] == {"name": "gaussian"}
    versions = {name: importlib.metadata.version(name) for name in ("sphframe", "sphframe-shepard")}
    assert json.loads(attributes["distributions"]) == versions, "of its components alone"


def test_plain_xarray_reads_it(written: Path) -> None:
    with xr.open_dataset(written) as dataset:
        assert dataset.probe.values.tolist() == ["left", "Gefäß"]


def test_readable_while_it_is_written(tmp_path: Path, fake: ModuleType) -> None:
    path = tmp_path / "run.nc"
    writer, simulation = NetCDFWriter(path, flush_interval=0.0), fake.FakeSimulation()
    assert not path.exists(), "the file must not appear before the run starts"
    writer.sphframe_run_started(simulation=simulation)
    assert open_dataset(path).sizes["time"] == 0
    for steps in range(1, 25):
        fake.play(writer, simulation, 1)
        dataset = open_dataset(path)
        assert dataset.sizes["probe_time"] == steps
        assert dataset.sizes["time"] == 1 + (steps - 1) // 10
        assert dataset.attrs["run_status"] == "running"
    writer.sphframe_run_failed(simulation=simulation, error=ValueError("too wet"))
    assert open_dataset(path).attrs["run_status"] == "failed"
    assert open_dataset(path).attrs["run_message"] == "ValueError: too wet"


def test_samples_wait_for_the_flush_interval_and_are_missing_until_then(tmp_path: Path, fake: ModuleType) -> None:
    path = tmp_path / "run.nc"
    writer, simulation = NetCDFWriter(path, flush_interval=3600.0), fake.FakeSimulation()
    writer.sphframe_run_started(simulation=simulation)
    fake.play(writer, simulation, 9)  # the first with a frame
    assert open_dataset(path).sizes["probe_time"] == 1
    with xr.open_dataset(path) as plain:
        missing = np.arange(plain.sizes["probe_time"]) > 0
        assert plain.kinetic_energy.isnull().values.tolist() == missing.tolist()
    writer.flush()
    assert open_dataset(path).sizes["probe_time"] == 9
    writer.sphframe_run_failed(simulation=simulation, error=ValueError("too wet"))


def test_the_size_is_known_before(tmp_path: Path, fake: ModuleType) -> None:
    path, simulation = tmp_path / "run.nc", fake.FakeSimulation(fake.FakeCase(until=0.5), 2000)
    writer = NetCDFWriter(path)
    writer.sphframe_run_started(simulation=simulation)
    fake.play(writer, simulation, 51)
    writer.sphframe_run_finished(simulation=simulation)
    size, frames = planned_size(simulation)
    assert frames - 1 == open_dataset(path).sizes["time"] == 6
    assert size == pytest.approx(path.stat().st_size, rel=0.3)


def test_a_removed_particle_has_no_pressure_and_all_others_have_one(tmp_path: Path, fake: ModuleType) -> None:
    simulation, writer = fake.FakeSimulation(), NetCDFWriter(tmp_path / "run.nc")
    fields = simulation.fields()
    for values in fields:
        values[7] = np.nan
    simulation.fields = lambda: fields
    writer.sphframe_run_started(simulation=simulation)
    writer.sphframe_frame_due(simulation=simulation)
    fields.pressure[8] = np.nan
    with pytest.raises(SimulationError, match="pressure is not finite"):
        writer.sphframe_frame_due(simulation=simulation)
    writer.sphframe_run_failed(simulation=simulation, error=ValueError("too wet"))
    assert open_dataset(tmp_path / "run.nc").pressure.isnull().values.nonzero()[1].tolist() == [7]


def test_case_without_probes_gauges_and_bodies(tmp_path: Path, fake: ModuleType) -> None:
    simulation = fake.FakeSimulation(fake.FakeCase(probe_count=0))
    writer = NetCDFWriter(tmp_path / "run.nc")
    writer.sphframe_run_started(simulation=simulation)
    fake.play(writer, simulation, 3)
    writer.sphframe_run_finished(simulation=simulation)
    assert "probe_pressure" not in open_dataset(tmp_path / "run.nc")


@pytest.mark.skipif(sys.platform == "win32", reason="fork and timers are POSIX")
def test_killed_at_random_moments(tmp_path: Path) -> None:
    generator = random.Random(20190511)
    program = Path(__file__).with_name("fake_simulation.py")
    frames = []
    command = [sys.executable, str(program)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        for attempt in range(12):
            path = tmp_path / f"run{attempt}.nc"
            print(generator.uniform(1e-6, 0.3), path, file=process.stdin, flush=True)
            assert process.stdout.readline() == "killed\n"
            frames.append(check_whole(path))
            NetCDFWriter(path, overwrite=True)  # the lock of a killed run is released
        process.stdin.close()
    assert max(frames) > 1, "no run got as far as its second frame: the test shows nothing"


def check_whole(path: Path) -> int:
    """Check that all samples and frames in ``path`` are complete; return the number of frames."""
    dataset = open_dataset(path)
    times = dataset.probe_time.values
    np.testing.assert_allclose(times, 0.01 * np.arange(len(times)), err_msg="samples have gaps")
    np.testing.assert_allclose(dataset.probe_pressure[:, 0], 100.0 * times, err_msg="a sample is half written")
    np.testing.assert_allclose(dataset.kinetic_energy, times, err_msg="a sample is half written")
    expected = np.broadcast_to(1000.0 + dataset.time.values[:, None], dataset.density.shape)
    np.testing.assert_allclose(dataset.density, expected, err_msg="a frame is half written")
    np.testing.assert_allclose(dataset.pressure, expected - 1000.0, err_msg="a frame is half written")
    return int(dataset.sizes["time"])


def test_existing_file_is_kept(written: Path) -> None:
    before = written.read_bytes()
    with pytest.raises(OutputError, match="--overwrite"):
        NetCDFWriter(written)
    assert written.read_bytes() == before


def test_overwriting_replaces_only_when_the_run_starts(written: Path, fake: ModuleType) -> None:
    before = written.read_bytes()
    writer = NetCDFWriter(written, overwrite=True)
    assert written.read_bytes() == before
    writer.sphframe_run_started(simulation=fake.FakeSimulation())
    assert open_dataset(written).sizes["time"] == 0
    assert [p.name for p in written.parent.iterdir()] == ["run.nc"], "nothing is left beside the output"


def test_two_runs_cannot_write_one_file(tmp_path: Path, fake: ModuleType) -> None:
    path = tmp_path / "run.nc"
    first, second = NetCDFWriter(path), NetCDFWriter(path)
    simulation = fake.FakeSimulation()
    first.sphframe_run_started(simulation=simulation)
    with pytest.raises(OutputError, match="overwrite"):
        second.sphframe_run_started(simulation=simulation)
    with pytest.raises(OutputError, match="another run is writing"):
        NetCDFWriter(path, overwrite=True)
    fake.play(first, simulation, 1)
    first.sphframe_run_finished(simulation=simulation)
    assert open_dataset(path).sizes["time"] == 1
    NetCDFWriter(path, overwrite=True)


def test_folder_missing_or_not_writable(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="mkdir -p"):
        NetCDFWriter(tmp_path / "nowhere" / "run.nc")
    with pytest.raises(OutputError, match="is a folder"):
        NetCDFWriter(tmp_path)
    closed = tmp_path / "closed"
    closed.mkdir(mode=0o500)
    if not os.access(closed, os.W_OK):  # the superuser may write anywhere
        with pytest.raises(OutputError, match="cannot be written"):
            NetCDFWriter(closed / "run.nc")


def test_output_deleted_during_the_run(written: Path, fake: ModuleType) -> None:
    simulation = fake.FakeSimulation()
    writer = NetCDFWriter(written, overwrite=True)
    writer.sphframe_run_started(simulation=simulation)
    written.unlink()
    with pytest.raises(OutputError, match="deleted or replaced"):
        fake.play(writer, simulation, 1)


def test_too_little_disk(tmp_path: Path, fake: ModuleType) -> None:
    case = fake.FakeCase(until=1e9, probe_interval=1e9)
    with pytest.raises(OutputError, match="frame_interval"):
        NetCDFWriter(tmp_path / "run.nc").sphframe_run_started(simulation=fake.FakeSimulation(case, 10_000))
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform == "win32", reason="file size limits are POSIX")
def test_disk_full_keeps_what_was_written(tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    program = f"""
import resource, runpy, sys
fake = runpy.run_path({str(Path(__file__).with_name("fake_simulation.py"))!r})
from sphframe.errors import OutputError
sys.dont_write_bytecode = True  # it would be truncated, and other processes would read it
resource.setrlimit(resource.RLIMIT_FSIZE, (1_000_000, 1_000_000))
simulation = fake["FakeSimulation"](particles=2000)
writer = fake["NetCDFWriter"]({str(path)!r})
writer.sphframe_run_started(simulation=simulation)
try:
    fake["play"](writer, simulation, 1000)
except OutputError as error:
    writer.sphframe_run_failed(simulation=simulation, error=error)
    print(error)
"""
    said = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert "frames and" in said, said
    assert "intact" in said, said
    dataset = open_dataset(path)
    assert dataset.sizes["time"] > 2
    np.testing.assert_allclose(dataset.density[-1], 1000.0 + float(dataset.time[-1]))
    assert f"{dataset.sizes['time']} frames" in said, said


def test_missing_foreign_and_truncated_files(tmp_path: Path, written: Path) -> None:
    with pytest.raises(InputError, match="does not exist"):
        open_dataset(tmp_path / "none.nc")
    with pytest.raises(InputError, match="not a file"):
        open_dataset(tmp_path)
    foreign = tmp_path / "foreign.nc"
    foreign.write_text("hello")
    with pytest.raises(InputError, match="not a readable NetCDF"):
        open_dataset(foreign)
    with netCDF4.Dataset(tmp_path / "other.nc", "w") as other:
        other.createDimension("x", 3)
    with pytest.raises(InputError, match="not the output of a sphframe run"):
        open_dataset(tmp_path / "other.nc")
    whole = written.read_bytes()
    for length in (0, 3, 100, 1000, len(whole) // 4, len(whole) // 2, len(whole) - 1000, len(whole) - 8):
        (tmp_path / "cut.nc").write_bytes(whole[:length])
        with pytest.raises(InputError, match="truncated"):
            open_dataset(tmp_path / "cut.nc")


def test_clashing_diagnostic(tmp_path: Path, fake: ModuleType) -> None:
    simulation = fake.FakeSimulation()
    object.__setattr__(simulation.scene.diagnostics[0], "name", "mass")
    gc.collect()
    before = psutil.Process().num_fds() if os.name == "posix" else 0
    writer = NetCDFWriter(tmp_path / "run.nc")
    with pytest.raises(OutputError, match="rename"):
        writer.sphframe_run_started(simulation=simulation)
    assert not list(tmp_path.iterdir())
    gc.collect()  # of the error, whose traceback has the file
    assert os.name != "posix" or psutil.Process().num_fds() <= before, "what was deleted is still open"


def test_a_failure_that_has_nothing_to_do_with_space_is_told_as_it_is(tmp_path: Path) -> None:
    def fail(file: netCDF4.Dataset) -> None:
        raise RuntimeError("NetCDF: HDF error")

    with pytest.raises(OutputError, match=r"NetCDF: HDF error; nothing was written\. To fix it: check the folder"):
        RunFile(tmp_path / "run.nc").create(fail, overwrite=False)


def test_a_file_of_another_run_is_not_kept_locked(written: Path) -> None:
    file = RunFile(written)
    with pytest.raises(OutputError, match="of another run"):
        file.reopen(SimpleNamespace(run_id="another", frames=0, samples=0))
    assert not file.is_open
    lock = lock_file(written)
    assert lock is not None
    os.close(lock)


def test_last_values_of_the_file_are_never_zero() -> None:
    """The reader recognises a truncated file by a zero as last value."""
    assert list(VARIABLES)[-1] == "density"
