"""The name of a task, its result, and the files that an interruption leaves."""

from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
import xarray as xr

from sphframe import hookimpl, open_dataset, run
from sphframe.cases import Custom
from sphframe.errors import InputError
from sphframe.geometry import BoxRegion, BoxWall
from sphframe.output.checkpoint import checkpoint_path
from sphframe.studies import tasks
from sphframe.studies.measurement import CostTask
from sphframe.studies.tasks import UNFINISHED, RunTask, work


def quiet(part: float) -> None:
    """Ignore progress."""


def unfinished(folder: Path, task: RunTask) -> Path:
    (folder / UNFINISHED).mkdir(exist_ok=True)
    return folder / UNFINISHED / task.name


def test_the_name_depends_on_the_case_and_nothing_else(tiny: ModuleType) -> None:
    names = {
        RunTask.of("a", tiny.tank(**parameters)).name
        for parameters in (
            {},
            {"until": 0.5},
            {"interpolator": "shepard"},
            {"interpolator": {"name": "improved-shepard", "mu": 3.0}},
            {"hydrostatic_lift": "mirror"},
            {"kernel": "wendland-c2"},
        )
    }
    assert len(names) == 6
    assert RunTask.of("a", tiny.tank()).name == RunTask.of("a", tiny.tank()).name
    assert RunTask.of("a b/../c", tiny.tank()).name.startswith("a-b-..-c-")


def test_the_name_changes_with_the_code_of_the_method(tiny: ModuleType, install: Any) -> None:
    source = """
        from sphframe import OK, BoundaryInterpolator, Traits
        class Method(BoundaryInterpolator):
            traits = Traits()
            def point_weights(self, kernel, dim):
                def weights(offsets, distances, kernel_values, volumes, support, lift, out):
                    out[:] = {value}
                    return OK
                return weights
    """
    names = set()
    for value in ("0.0", "1.0"):
        module = f"method_{value[0]}"
        install(
            f"edited-{value[0]}",
            {module: source.format(value=value)},
            {"interpolators": {f"edited-{value[0]}": f"{module}:Method"}},
        )
        names.add(tasks.made_with(tiny.tank(interpolator=f"edited-{value[0]}"))["method"])
    assert len(names) == 2


def test_a_result_is_complete_and_made_once(tiny: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    task = RunTask.of("one", tiny.tank(until=0.1))
    parts: list[float] = []
    work(task, str(tmp_path), task.name, 1, parts.append)
    result = tmp_path / task.name
    with open_dataset(result) as dataset:
        assert dataset.attrs["completed"] == "yes"
    made = (result.stat().st_ino, result.stat().st_mtime_ns)

    def never(*_: object) -> None:
        raise AssertionError("a finished task is performed again")

    monkeypatch.setattr(RunTask, "perform", never)
    work(task, str(tmp_path), task.name, 1, parts.append)
    assert (result.stat().st_ino, result.stat().st_mtime_ns) == made
    assert {path.suffix for path in (tmp_path / UNFINISHED).iterdir()} == {".lock"}


def test_an_interrupted_run_goes_on_from_its_checkpoint(tiny: ModuleType, tmp_path: Path) -> None:
    class Stop:
        @hookimpl
        def sphframe_step_completed(self, simulation: Any) -> None:
            if simulation.time > 0.15:
                raise KeyboardInterrupt

    task = RunTask.of("one", tiny.tank(until=0.3))
    path = unfinished(tmp_path, task)
    with pytest.raises(KeyboardInterrupt):
        run(task.case(), output=path, threads=1, hooks=[Stop()])
    assert checkpoint_path(path).exists()
    with xr.open_dataset(path) as dataset:
        begun = dataset.attrs["run_id"]
    work(task, str(tmp_path), task.name, 1, quiet)
    with open_dataset(tmp_path / task.name) as dataset:
        assert dataset.attrs["run_id"] == begun
        assert dataset.attrs["completed"] == "yes"
        with run(task.case(), output=tmp_path / "whole.nc", threads=1).dataset as whole:
            assert (dataset["position"].values == whole["position"].values).all()


def test_a_finished_run_is_only_moved(tiny: ModuleType, tmp_path: Path) -> None:
    task = RunTask.of("one", tiny.tank(until=0.05))
    path = unfinished(tmp_path, task)
    run(task.case(), output=path, threads=1).dataset.close()
    before = path.stat().st_ino
    work(task, str(tmp_path), task.name, 1, quiet)
    assert (tmp_path / task.name).stat().st_ino == before


@pytest.mark.parametrize("content", [b"", b"CDF\x05 no more", b"\x89HDF"])
def test_damaged_files_are_replaced_by_a_new_run(tiny: ModuleType, tmp_path: Path, content: bytes) -> None:
    task = RunTask.of("one", tiny.tank(until=0.05))
    path = unfinished(tmp_path, task)
    path.write_bytes(content)
    checkpoint_path(path).write_bytes(b"damaged")
    work(task, str(tmp_path), task.name, 1, quiet)
    with open_dataset(tmp_path / task.name) as dataset:
        assert dataset.attrs["completed"] == "yes"


def test_a_run_that_goes_wrong_is_a_result(tmp_path: Path) -> None:
    case = Custom(
        particle_spacing=0.05,
        until=1.0,
        frame_interval=0.1,
        probe_interval=0.01,
        walls=[BoxWall(name="ground", lower=(0.0, 0.0), upper=(0.5, 0.5), open_faces=("+x", "+y"))],
        fluid=[BoxRegion(lower=(0.0, 0.0), upper=(0.3, 0.3))],
        domain=((-0.1, -0.1), (0.5, 0.6)),
    )
    task = RunTask.of("runs out", case)
    work(task, str(tmp_path), task.name, 1, quiet)
    with open_dataset(tmp_path / task.name) as dataset:
        assert dataset.attrs["run_status"] == "failed"
        assert "domain" in dataset.attrs["run_message"]


def test_a_worker_of_another_version_refuses(tiny: ModuleType, tmp_path: Path) -> None:
    task = RunTask.of("one", tiny.tank())
    with pytest.raises(InputError, match="other versions"):
        work(task, str(tmp_path), "one-0123456789ab.nc", 1, quiet)
    assert not (tmp_path / UNFINISHED).exists()


def test_costs_are_measured_for_each_method_on_the_same_state(tiny: ModuleType, tmp_path: Path) -> None:
    methods: dict[str, Any] = {"a": ({"name": "improved-shepard"}, "mirror"), "b": ({"name": "adami"}, "balanced")}
    own = RunTask.of("x", tiny.tank())
    task = CostTask("cost", own.case_name, own.parameters, methods=methods, after=0.02, repeats=3)
    work(task, str(tmp_path), task.name, 1, quiet)
    with xr.open_dataset(tmp_path / task.name) as measured:
        assert dict(measured.sizes) == {"interpolator": 2, "repeat": 3}
        assert (measured["fill"] > 0).all()
        assert (measured["step"] > measured["fill"]).all()
        assert measured["neighbours"].sel(interpolator="a") > measured["neighbours"].sel(interpolator="b") > 5
        assert measured.attrs["machine: processor"]
