"""A run that is interrupted and resumed ends with the same bits as one that is not."""

import importlib
import json
import os
import pickle
import shutil
import signal
import zipfile
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

import sphframe
from sphframe import InputError, OutputError, Simulation, open_dataset, resume, run
from sphframe.errors import ResumeWarning
from sphframe.output import checkpoint
from sphframe.output.checkpoint import read_checkpoint

pytestmark = pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")

INTEGRATORS = [entry.name for entry in sphframe.available("integrators")]
ADAPTIVE = {"probe_interval": 0.013}
FIXED = {"time_step": 1.5e-3}


def interrupt(simulation: Any) -> None:
    os.kill(os.getpid(), signal.SIGINT)


def terminate(simulation: Any) -> None:
    os.kill(os.getpid(), signal.SIGTERM)


def interrupted(small: ModuleType, path: Path, step: int = 25, **options: Any) -> Path:
    """A run of the flume that was interrupted after a step."""
    with pytest.raises(KeyboardInterrupt):
        run(small.small_case(2), output=path, threads=1, hooks=[small.At(step, interrupt)], **options)
    return path


@pytest.mark.parametrize("stepping", [FIXED, ADAPTIVE], ids=["fixed", "adaptive"])
@pytest.mark.parametrize(("dimension", "threads"), [(2, 2), (3, 1), pytest.param(3, 2, marks=pytest.mark.long)])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_twice_n_steps_are_n_steps_and_n_resumed(
    small: ModuleType, integrator: str, dimension: int, threads: int, stepping: dict[str, float]
) -> None:
    case = small.small_case(dimension, integrator=integrator, **stepping)
    n = 30
    whole = Simulation(case, threads=1)
    for _ in range(n):
        whole.advance()
    saved = whole.state()
    for _ in range(n):
        whole.advance()
    assert max(abs(motion.position[0]) for motion in whole.body_motions().values()) > 1e-5, "no body has moved"

    continued = Simulation(case, threads=threads if os.cpu_count() != 1 else 1)
    continued.restore(saved)
    for _ in range(n):
        continued.advance()

    expected, found = whole.state(), continued.state()
    for state in (expected, found):
        state["clocks"][2:4] = 0.0  # wall-clock and processor time
    assert {name: array.tobytes() for name, array in found.items()} == {
        name: array.tobytes() for name, array in expected.items()
    }
    assert whole.probe_pressures().tobytes() == continued.probe_pressures().tobytes()


@pytest.mark.parametrize("stop", [interrupt, terminate])
def test_interrupted_and_resumed_files_are_the_same(small: ModuleType, tmp_path: Path, stop: Any) -> None:
    undisturbed = run(small.small_case(2), output=tmp_path / "whole.nc", threads=1)
    path = tmp_path / "run.nc"
    with pytest.raises(KeyboardInterrupt):
        run(small.small_case(2), output=path, threads=1, hooks=[small.At(17, stop)])
    with open_dataset(path) as dataset:
        assert (dataset.attrs["run_status"], dataset.attrs["run_message"]) == ("failed", "interrupted")
    with pytest.raises(KeyboardInterrupt):
        resume(path, threads=1, hooks=[small.At(40, stop)])
    resumed = resume(tmp_path / "run.nc.restart", threads=1)
    small.assert_same_bits(undisturbed.dataset, resumed.dataset)
    assert resumed.dataset.attrs["completed"] == "yes"
    assert [file.name for file in sorted(tmp_path.iterdir())] == ["run.nc", "whole.nc"], "the checkpoint is removed"


def test_a_resumed_file_says_that_its_run_is_running(small: ModuleType, tmp_path: Path) -> None:
    path = interrupted(small, tmp_path / "run.nc")
    said = []

    def look(simulation: Any) -> None:
        with open_dataset(path) as dataset:
            said.append((dataset.attrs["run_status"], dataset.attrs["run_message"]))

    resume(path, threads=1, hooks=[small.At(30, look)])
    assert said == [("running", "")]


def test_writing_checkpoints_changes_nothing(small: ModuleType, tmp_path: Path) -> None:
    without = run(small.small_case(2), output=tmp_path / "a.nc", threads=1, checkpoint_every=None)
    often = run(small.small_case(2), output=tmp_path / "b.nc", threads=1, checkpoint_interval=1e-9)
    small.assert_same_bits(without.dataset, often.dataset)


def test_particles_that_were_removed_stay_removed(small: ModuleType, tmp_path: Path) -> None:
    case = small.small_case(
        2, domain=((-0.2, -0.2), (0.8, 0.29)), guards={"domain": "remove"}, bodies=small.FLUME["bodies"]
    )

    def splash(simulation: Any) -> None:
        rows, columns = simulation.system.rows, simulation.columns
        top = np.argsort(rows[: simulation.fluid_count, columns.position.start + 1])[-3:]
        rows[top, columns.velocity.start + 1] = 3.0

    whole = run(case, output=tmp_path / "a.nc", threads=1, hooks=[small.At(10, splash)])
    with pytest.raises(KeyboardInterrupt):
        run(case, output=tmp_path / "b.nc", threads=1, hooks=[small.At(10, splash), small.At(30, interrupt)])
    resumed = resume(tmp_path / "b.nc", threads=1)
    assert whole.dataset.particles_removed.values[-1] >= 3
    assert int(np.isnan(whole.dataset.density.values[-1]).sum()) == whole.dataset.particles_removed.values[-1]
    small.assert_same_bits(whole.dataset, resumed.dataset)


def test_a_second_signal_interrupts_within_the_step(small: ModuleType, tmp_path: Path) -> None:
    def twice(simulation: Any) -> None:
        interrupt(simulation)
        interrupt(simulation)

    with pytest.raises(KeyboardInterrupt):
        run(small.small_case(2), output=tmp_path / "run.nc", threads=1, hooks=[small.At(5, twice)])


def test_signal_handlers_are_put_back(small: ModuleType, tmp_path: Path) -> None:
    before = signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)
    interrupted(small, tmp_path / "run.nc", 2)
    assert (signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)) == before


def test_a_crash_while_writing_leaves_the_checkpoint_before(
    small: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def break_it(simulation: Any) -> None:
        monkeypatch.setattr(checkpoint.zipfile.ZipFile, "writestr", broken)

    def broken(*arguments: Any) -> None:
        raise OSError(28, "No space left on device")

    path = tmp_path / "run.nc"
    with pytest.raises(
        OutputError, match=r"cannot write the checkpoint .*No space left on device.* are intact.*resume"
    ):
        run(small.small_case(2), output=path, threads=1, checkpoint_every=None, checkpoint_interval=0.01,
            hooks=[small.At(30, break_it)])  # fmt: skip
    monkeypatch.undo()
    before = read_checkpoint(tmp_path / "run.nc.restart")
    assert 0.01 <= before.time < 0.03
    assert not list(tmp_path.glob(".*")), "no draft is left behind"
    whole = run(small.small_case(2), output=tmp_path / "whole.nc", threads=1)
    small.assert_same_bits(whole.dataset, resume(path, threads=1).dataset)


def test_other_versions_are_named(small: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = interrupted(small, tmp_path / "run.nc")
    known = checkpoint._versions

    def newer(case: Any) -> dict[str, str]:
        return {**known(case), "sphframe-shepard": "9.9", "numba": "0.99.0"}

    monkeypatch.setattr(checkpoint, "_versions", newer)
    with pytest.warns(ResumeWarning, match=r"numba .*, now 0.99.0; sphframe-shepard .*, now 9.9"):
        resume(path, threads=1)


def test_what_cannot_be_resumed_is_refused_with_a_reason(small: ModuleType, tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    with pytest.raises(InputError, match="does not exist"):
        resume(path)
    interrupted(small, path)
    with pytest.raises(InputError, match="other parameters"):
        resume(path, case=small.small_case(2, until=1.0))

    saved = tmp_path / "run.nc.restart"
    kept = saved.read_bytes()
    saved.unlink()
    with pytest.raises(InputError, match="there is no checkpoint"):
        resume(path)

    other = interrupted(small, tmp_path / "other.nc")
    shutil.copy(tmp_path / "other.nc.restart", saved)
    with pytest.raises(OutputError, match="of another run than its checkpoint"):
        resume(path, threads=1)
    assert other.exists()

    saved.write_bytes(kept)
    content = path.read_bytes()
    resume(path, threads=1)
    with pytest.raises(InputError, match="complete run"):
        resume(path)

    path.write_bytes(content)
    header = json.loads(zipfile.ZipFile(tmp_path / "other.nc.restart").read("checkpoint.json"))
    assert header["format"] == 6


def test_an_older_copy_of_the_output_is_refused(small: ModuleType, tmp_path: Path) -> None:
    path = interrupted(small, tmp_path / "run.nc", 5)
    early = path.read_bytes()
    with pytest.raises(KeyboardInterrupt):
        resume(path, threads=1, hooks=[small.At(60, interrupt)])
    path.write_bytes(early)
    with pytest.raises(OutputError, match="holds less than its checkpoint counts"):
        resume(path, threads=1)


def test_a_running_output_cannot_be_resumed(small: ModuleType, tmp_path: Path) -> None:
    path = interrupted(small, tmp_path / "run.nc")
    errors = []

    def resume_too(simulation: Any) -> None:
        with pytest.raises(OutputError, match="another run is writing") as caught:
            resume(path, threads=1)
        errors.append(caught.value)

    resume(path, threads=1, checkpoint_interval=1e-9, hooks=[small.At(40, resume_too)])
    assert errors


def damaged_checkpoints(kept: bytes, path: Path) -> dict[str, bytes]:
    """Damaged or foreign checkpoints, by what is wrong with them."""
    flipped = bytearray(kept)
    flipped[len(kept) // 2] ^= 0xFF
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}

    def packed(changes: dict[str, bytes | None], method: int = zipfile.ZIP_STORED) -> bytes:
        target = path.with_name("packed")
        with zipfile.ZipFile(target, "w", method) as archive:
            for name, content in {**members, **changes}.items():
                if content is not None:
                    archive.writestr(name, content)
        content = target.read_bytes()
        target.unlink()
        return content

    header = json.loads(members["checkpoint.json"])
    objects = {**header, "arrays": {**header["arrays"], "ids": ["|O", [3]]}}
    twice = np.full(len(members["ids"]) // 8, 3).astype("<i8").tobytes()
    far = np.frombuffer(members["lists.fluid"]).copy()
    far[0] = 1e12
    longer = {**header, "arrays": {**header["arrays"], "ids": ["<i8", [10**15]]}}
    other = {**header, "arrays": {name: value for name, value in header["arrays"].items() if name != "ids"}}
    return {
        "empty": b"",
        "half": kept[: len(kept) // 2],
        "flipped bit": bytes(flipped),
        "pickle": pickle.dumps({"state": 1}),
        "text": b"no checkpoint",
        "member missing": packed({"ids": None}),
        "header is a list": packed({"checkpoint.json": b"[]"}),
        "header is no JSON": packed({"checkpoint.json": b"{"}),
        "nested header": packed({"checkpoint.json": b"[" * 100_000}),
        "other format": packed({"checkpoint.json": json.dumps({**header, "format": 99}).encode()}),
        "objects": packed({"checkpoint.json": json.dumps(objects).encode()}),
        "impossible length": packed({"checkpoint.json": json.dumps(longer).encode()}),
        "array missing": packed({"checkpoint.json": json.dumps(other).encode()}),
        "numbers twice": packed({"ids": twice}),
        "far away": packed({"lists.fluid": far.tobytes()}),
        "not finite": packed({"rows": np.full(len(members["rows"]) // 8, np.nan).tobytes()}),
        "compressed": packed({}, zipfile.ZIP_DEFLATED),
    }


def test_damaged_and_foreign_checkpoints_are_refused(small: ModuleType, tmp_path: Path) -> None:
    path = interrupted(small, tmp_path / "run.nc")
    saved = tmp_path / "run.nc.restart"
    output = path.read_bytes()
    for what, content in damaged_checkpoints(saved.read_bytes(), saved).items():
        saved.write_bytes(content)
        with pytest.raises(InputError, match=r"run\.nc\.restart|saved state") as caught:
            resume(path, threads=1)
        assert "checkpoint" in str(caught.value) or "state" in str(caught.value), what
        assert path.read_bytes() == output, f"{what}: the output was touched"


def test_code_named_by_address_needs_trust(small: ModuleType, tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    address = "sphframe.kernels.wendland:WendlandC2"
    with pytest.raises(KeyboardInterrupt):
        run("hydrostatic-tank", output=path, threads=1, particle_spacing=0.03, tank_length=0.3, kernel=address,
            hooks=[small.At(5, interrupt)])  # fmt: skip
    with pytest.raises(InputError, match="is the address of code"):
        resume(path, threads=1)
    with pytest.raises(KeyboardInterrupt):
        resume(path, threads=1, trusted=True, hooks=[small.At(10, interrupt)])


def test_a_run_that_has_not_begun_claims_no_file(
    small: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Refused(SimpleNamespace):
        def run(self, hooks: object) -> None:
            raise RuntimeError("not yet")

    (tmp_path / "old.nc").write_bytes(b"another run")
    module = importlib.import_module("sphframe.simulation.run")
    monkeypatch.setattr(module, "Simulation", lambda *_, **__: Refused(time=0.0))
    with pytest.raises(RuntimeError, match="not yet") as error:
        run(small.small_case(2), output=tmp_path / "old.nc", overwrite=True, progress=False)
    assert not getattr(error.value, "__notes__", [])
    assert (tmp_path / "old.nc").read_bytes() == b"another run"
