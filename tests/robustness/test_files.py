"""The files of a run after a full disk, missing permissions, deleted outputs and truncation."""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import xarray as xr

import sphframe
from sphframe import OutputError, hookimpl, open_dataset, resume, run

pytestmark = pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")

TANK = ["--set", "particle_spacing=0.03", "--set", "tank_length=0.3", "--set", "frame_interval=0.01"]
PARAMETERS = {"particle_spacing": 0.03, "tank_length": 0.3, "frame_interval": 0.01}


def command_line(folder: Path, *arguments: str, before: str = "") -> subprocess.CompletedProcess[str]:
    """Call ``sphframe`` in a process of its own, after the statement ``before``."""
    code = f"{before}\nfrom sphframe.cli import main\nmain()"
    environment = {**os.environ, "NO_COLOR": "1", "COLUMNS": "400", "PYTHONWARNINGS": "ignore"}
    return subprocess.run(
        [sys.executable, "-c", code, *arguments],
        cwd=folder, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip


NO_LARGE_FILES = """
import resource, sys
sys.dont_write_bytecode = True  # it would be truncated, and other processes would read it
resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="file size limits are POSIX")
def test_a_full_disk_stops_the_run_and_it_resumes_when_there_is_space(small: ModuleType, tmp_path: Path) -> None:
    stopped = command_line(
        tmp_path, "run", "hydrostatic-tank", *TANK, "--until", "0.5", "--threads", "1", "--checkpoint-interval", "0.02",
        before=NO_LARGE_FILES,
    )  # fmt: skip
    assert stopped.returncode == 2, stopped.stderr
    assert "the disk is full or the size limit is reached" in stopped.stderr
    assert "are intact" in stopped.stderr
    assert "sphframe resume hydrostatic-tank.nc" in stopped.stderr
    assert "Traceback" not in stopped.stderr
    path = tmp_path / "hydrostatic-tank.nc"
    with open_dataset(path) as dataset:
        frames = dataset.sizes["time"]
        assert frames > 3
        assert np.isfinite(dataset.position.values).all()
    resumed = resume(path, threads=1)
    whole = run("hydrostatic-tank", output=tmp_path / "whole.nc", threads=1, until=0.5, **PARAMETERS)
    assert resumed.dataset.sizes["time"] > frames
    small.assert_same_bits(whole.dataset, resumed.dataset)


OBEY_PERMISSIONS = """
import ctypes, os, sys
if os.geteuid() == 0 and (sys.platform != "linux" or ctypes.CDLL(None).prctl(24, 1, 0, 0, 0)):  # CAP_DAC_OVERRIDE
    sys.exit(77)
os.execv(sys.executable, [sys.executable, "-m", "sphframe", *sys.argv[1:]])
"""
"""calls ``sphframe``; the superuser gives up the capability to write to read-only folders"""


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="users are POSIX")
def test_a_read_only_folder_is_refused_before_anything_runs(tmp_path: Path) -> None:
    tmp_path.chmod(0o555)
    command = [sys.executable, "-c", OBEY_PERMISSIONS, "run", "hydrostatic-tank", *TANK]
    refused = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    tmp_path.chmod(0o755)
    if refused.returncode == 77:
        pytest.skip("the superuser may write to any folder here")
    assert refused.returncode == 2, refused.stderr
    assert "cannot be written to: change its permissions or choose another --output" in refused.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("deed", ["deleted", "replaced"])
def test_an_output_that_is_deleted_or_replaced_stops_the_run(small: ModuleType, tmp_path: Path, deed: str) -> None:
    path = tmp_path / "run.nc"

    def take_away(simulation: Any) -> None:
        path.unlink()
        if deed == "replaced":
            path.write_text("something else")

    with pytest.raises(OutputError, match=r"deleted or replaced while the run was writing it.*another --output"):
        run("hydrostatic-tank", output=path, threads=1, hooks=[small.At(30, take_away)], **PARAMETERS)
    if deed == "replaced":
        assert path.read_text() == "something else"
    with pytest.raises(sphframe.InputError):
        resume(path, threads=1)


def test_too_little_disk_space_is_refused_before_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda path: usage._replace(free=100_000))
    with pytest.raises(OutputError, match=r"would need about .* but only .* are free: choose another --output"):
        run("hydrostatic-tank", output=tmp_path / "run.nc", threads=1, **PARAMETERS)
    assert not list(tmp_path.iterdir())


def test_readable_by_xarray_after_every_step(tmp_path: Path) -> None:
    path = tmp_path / "run.nc"

    class Reader:
        opened = 0

        @hookimpl
        def sphframe_step_completed(self, simulation: Any) -> None:
            if simulation.step % 5 == 0:
                with xr.open_dataset(path) as dataset:
                    assert dataset.sizes["time"] == simulation.frames
                    dataset.load()
                with open_dataset(path) as dataset:
                    assert dataset.attrs["run_status"] == "running"
                self.opened += 1

    reader = Reader()
    run("hydrostatic-tank", output=path, threads=1, until=0.1, hooks=[reader], **PARAMETERS)
    assert reader.opened > 5


@pytest.mark.parametrize("part", [0, 3, 100, 0.3, 0.7, 0.99])
def test_truncated_outputs_are_refused(tmp_path: Path, part: float) -> None:
    path = tmp_path / "run.nc"
    run("hydrostatic-tank", output=path, threads=1, until=0.03, **PARAMETERS).dataset.close()
    content = path.read_bytes()
    path.write_bytes(content[: int(part * len(content)) if isinstance(part, float) else part])
    for reads in (open_dataset, resume):
        with pytest.raises(sphframe.InputError, match=r"run\.nc .*(truncated|not a readable NetCDF|is damaged)"):
            reads(path)


def test_nothing_in_sphframe_unpickles_or_evaluates() -> None:
    import ast

    forbidden = {"pickle", "dill", "cloudpickle", "marshal", "shelve", "joblib"}
    for path in Path(sphframe.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                names.append(node.module or "")
            assert not forbidden & {name.partition(".")[0] for name in names}, f"{path} imports {names}"
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                assert node.func.id not in {"eval", "exec"}, f"{path}:{node.lineno} calls {node.func.id}"
            if isinstance(node, ast.keyword):
                assert not (node.arg == "allow_pickle" and getattr(node.value, "value", True)), f"{path} allows pickle"
