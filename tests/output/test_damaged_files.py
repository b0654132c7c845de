"""Damaged and foreign files are refused at the door, and drafts are never links to other files."""

import json
import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType, SimpleNamespace

import netCDF4
import numpy as np
import pytest

from sphframe.analysis import summary
from sphframe.analysis.live import _facts
from sphframe.errors import InputError, OutputError, SimulationError
from sphframe.output import NetCDFWriter, open_dataset
from sphframe.output.files import draft_path, replaced_as_a_whole
from sphframe.output.lock import lock_file

Damage = Callable[[netCDF4.Dataset], object]


@pytest.fixture(scope="module")
def sound(fake: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path: Path = fake.write_run(tmp_path_factory.mktemp("sound") / "run.nc")
    return path


def damages(path: Path) -> dict[str, Damage]:
    """What can be wrong with each part of a file, by a description."""

    def parameters(change: Callable[[dict[str, object]], object]) -> Damage:
        def damage(file: netCDF4.Dataset) -> None:
            found = json.loads(file.case_parameters)
            change(found)
            file.setncattr("case_parameters", json.dumps(found))

        return damage

    def value(name: str, number: float, where: object = 0) -> Damage:
        return lambda file: file[name].__setitem__(where, number)

    made: dict[str, Damage] = {}
    with netCDF4.Dataset(path) as file:
        for name in file.ncattrs():
            made[f"no {name}"] = lambda file, name=name: file.delncattr(name)
            made[f"other {name}"] = lambda file, name=name: file.setncattr(name, np.array([np.nan, 1.0]))
        for name in file.variables:
            made[f"no variable {name}"] = lambda file, name=name: file.renameVariable(name, f"{name}2")
        for name in file.dimensions:
            made[f"no dimension {name}"] = lambda file, name=name: file.renameDimension(name, f"{name}2")
        for name in ("until", "gravity", "wall_treatment", "interpolator", "hydrostatic_lift", "guards"):
            made[f"no parameter {name}"] = parameters(lambda found, name=name: found.pop(name))
            made[f"null {name}"] = parameters(lambda found, name=name: found.update({name: None}))

    def remade(kind: str, *dimensions: str) -> Damage:
        def damage(file: netCDF4.Dataset) -> None:
            file.renameVariable("density", "density2")
            file.createVariable("density", kind, dimensions)

        return damage

    return made | {
        "another type": remade("i4", "time", "particle"),
        "other dimensions": remade("f8", "time", "ghost"),
        "another dimension": lambda file: file.setncattr("dimension", np.int32(3)),
        "equal names": lambda file: file["wall"].__setitem__(1, file["wall"][0]),
        "no UTF-8": lambda file: file["wall"].__setitem__((0, 0), np.array(b"\xff")),
        "an unknown status": value("run_status", 7, ...),
        "no such wall": value("outline_wall", 99),
        "no such body": value("wall_body", -2),
        "too many nodes": value("outline_node_count", 1000),
        "time runs backwards": value("probe_time", 9.0),
        "no time": value("time", np.nan),
    }  # fmt: skip


def test_whatever_is_wrong_with_a_file_is_told_or_does_not_matter(sound: Path, tmp_path: Path) -> None:
    path, wrong = tmp_path / "run.nc", {}
    refused: dict[str, str] = {}
    made = damages(sound)
    for what, damage in made.items():
        shutil.copy(sound, path)
        with netCDF4.Dataset(path, "r+") as file:
            file.set_auto_mask(False)
            damage(file)
        try:
            with open_dataset(path) as dataset:
                summary(dataset)
                _facts(dataset, "running")
                dataset.load()
        except InputError as error:
            refused[what] = str(error)
        except Exception as error:
            wrong[what] = error
    assert not wrong
    assert len(refused) > 100
    assert {
        "equal names",
        "no UTF-8",
        "no such wall",
        "no such body",
        "time runs backwards",
        "no time",
    } <= refused.keys()
    assert {what for what, why in refused.items() if "a variable density of other" in why} == {
        "another type", "other dimensions"
    }  # fmt: skip
    assert {what for what, why in refused.items() if "dimensions that contradict each other" in why} == {
        "no dimension outline"
    }  # fmt: skip
    with open_dataset(sound) as dataset:
        assert dataset.attrs["completed"] == "yes"


def test_no_value_that_is_not_finite_is_written(
    fake: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulation, writer = fake.FakeSimulation(), NetCDFWriter(tmp_path / "run.nc")
    writer.sphframe_run_started(simulation=simulation)
    fake.play(writer, simulation, 3)
    for name, what in (("energies", "kinetic energy"), ("ghost_fields", "ghost pressure")):
        with monkeypatch.context() as patch:
            infinite = {"kinetic": np.inf} if name == "energies" else SimpleNamespace(pressure=np.full(20, np.nan))
            patch.setattr(simulation, name, lambda infinite=infinite: infinite)
            with pytest.raises(SimulationError, match=f"{what} is not finite"):
                fake.play(writer, simulation, 12)


@pytest.mark.skipif(sys.platform == "win32", reason="links are POSIX")
def test_a_draft_is_never_a_link_to_another_file(fake: ModuleType, tmp_path: Path) -> None:
    path, precious = tmp_path / "run.nc", tmp_path / "precious"
    precious.write_text("precious")

    def write(overwrite: bool) -> None:
        writer = NetCDFWriter(path, overwrite=overwrite)
        simulation = fake.FakeSimulation()
        writer.sphframe_run_started(simulation=simulation)
        fake.play(writer, simulation, 3)
        writer.sphframe_run_finished(simulation=simulation)

    draft_path(path).symlink_to(precious)
    write(overwrite=False)
    os.link(path, draft_path(path))  # as a process leaves it that is killed after it has published its file
    write(overwrite=True)
    draft_path(precious).symlink_to(path)
    with replaced_as_a_whole(precious) as draft:
        assert not draft.is_symlink()
        draft.write_text(precious.read_text() + ", too")
    assert precious.read_text() == "precious, too"
    assert open_dataset(path).sizes["probe_time"] == 3
    assert sorted(file.name for file in tmp_path.iterdir()) == ["precious", "run.nc"]


@pytest.mark.skipif(sys.platform == "win32", reason="locks are POSIX")
def test_the_draft_of_a_running_process_is_left_alone(fake: ModuleType, tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    draft_path(path).write_text("another process is writing this")
    held = lock_file(draft_path(path))
    assert held is not None
    with pytest.raises(OutputError, match="another run is writing"):
        NetCDFWriter(path).sphframe_run_started(simulation=fake.FakeSimulation())
    os.close(held)
    assert draft_path(path).read_text() == "another process is writing this"


@pytest.mark.skipif(sys.platform == "win32", reason="links are POSIX")
def test_a_dangling_link_is_named(tmp_path: Path) -> None:
    (tmp_path / "run.nc").symlink_to("nowhere.nc")
    for overwrite in (False, True):
        with pytest.raises(OutputError, match=r"is a link to nowhere\.nc, which does not exist: remove the link"):
            NetCDFWriter(tmp_path / "run.nc", overwrite=overwrite)
