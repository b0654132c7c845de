"""Runs on a CUDA device, or where there is none on its simulator, are those of the processor."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numba import cuda
from sphframe_cuda.loops import type_of
from typer.testing import CliRunner

from sphframe.cli.app import app

PROGRAM = Path(__file__).parent / "on_device.py"
CHECKS = ["in_the_plane", "resumed"]
LONG = ("in_space", "moving", "with_other_methods", "with_other_treatments", "against_plain_numpy")


@pytest.mark.slow
@pytest.mark.parametrize("checks", [CHECKS, *(pytest.param([check], marks=pytest.mark.long) for check in LONG)])
def test_the_device_computes_what_the_processor_does(checks: list[str]) -> None:
    simulated = {} if cuda.is_available() else {"NUMBA_ENABLE_CUDASIM": "1"}
    done = subprocess.run(
        [sys.executable, str(PROGRAM), *checks], env={**os.environ, **simulated}, capture_output=True, text=True
    )
    assert done.returncode == 0, f"{done.stdout}\n{done.stderr}"


@pytest.mark.skipif(cuda.is_available(), reason="there is a CUDA device")
def test_a_run_without_a_device_is_refused_before_anything_is_compiled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sphframe.simulation.simulation.Components", None)
    result = CliRunner().invoke(app, ["run", "dam-break", "--device", "cuda"])
    assert result.exit_code == 2
    assert "no CUDA device was found" in " ".join(result.output.split())
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("shape", "layout"), [((0, 8), "A"), ((4, 1), "A"), ((4, 8), "C")])
def test_a_loop_assumes_an_order_only_where_it_is_seen(shape: tuple[int, int], layout: str) -> None:
    assert type_of(np.empty(shape)).layout == layout
    assert type_of((np.empty(shape, order="F"),))[0].layout == "A"
