"""The command line: what it prints, writes and returns."""

import errno
import io
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
import xarray as xr
from rich.console import Console
from typer.testing import CliRunner, Result

from sphframe import registry
from sphframe.analysis import plot_run
from sphframe.analysis.progress import ProgressDisplay
from sphframe.cases import load_case
from sphframe.cli.app import app
from sphframe.cli.values import read_assignments
from sphframe.errors import SimulationError
from sphframe.output import open_dataset

SMALL = ["--set", "particle_spacing=0.03", "--set", "tank_length=0.3", "--threads", "1"]


def call(*arguments: str, **environment: str) -> Result:
    return CliRunner().invoke(app, arguments, env={"COLUMNS": "200", "NO_COLOR": "1", **environment})


def test_without_a_command_it_names_the_commands() -> None:
    result = call()
    assert result.exit_code == 0
    assert "sphframe run dam-break" in result.stdout


def test_version() -> None:
    assert call("--version").stdout == "0.1.0\n"


@pytest.mark.parametrize("command", ["run", "list", "show", "doctor"])
def test_every_command_has_help(command: str) -> None:
    result = call(command, "--help")
    assert result.exit_code == 0
    assert f"Usage: sphframe {command}" in result.stdout


def test_help_and_list_load_neither_numba_nor_scipy() -> None:
    for arguments in ("['--help']", "[]", "['list']"):
        code = f"from sphframe.cli.app import app; app({arguments}, standalone_mode=False)"
        check = "; import sys; print([m for m in ('numba', 'scipy', 'xarray') if m in sys.modules])"
        shown = subprocess.run([sys.executable, "-c", code + check], capture_output=True, text=True, check=True).stdout
        assert shown.splitlines()[-1] == "[]"


def test_list_names_kinds_components_and_distributions() -> None:
    listed = call("list").stdout
    for text in ("improved-shepard", "sphframe-shepard", "dam-break", "gaussian", "tait", "rk4"):
        assert text in listed
    assert "gaussian" not in call("list", "interpolators").stdout


def test_list_shows_a_broken_plugin(install) -> None:  # type: ignore[no-untyped-def]
    install("broken", {"broken_method": "import nothing_like_it"}, {"interpolators": {"broken": "broken_method:X"}})
    assert "broken 1.0" in call("list", "interpolators").stdout
    doctor = call("doctor")
    assert doctor.exit_code == 1
    assert "broken: interpolator 'broken' of broken 1.0: ModuleNotFoundError" in doctor.stdout


def test_show_a_case() -> None:
    shown = call("show", "dam-break").stdout
    for text in ("water_height", "2 water_height", "kg m-3", "--preset paper", "particle_spacing = 0.004", "gaussian"):
        assert text in shown
    assert "0.004" in call("show", "dam-break", "--preset", "paper").stdout.partition("--preset")[0]


def test_show_a_shape_lists_its_parts_and_the_other_shapes() -> None:
    shown = call("show", "ellipse").stdout
    for text in ("semi_axes", "angle = 0.0", "polygon", "mesh"):
        assert text in shown


def test_show_a_case_file_and_a_component(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text('case = "dam-break"\nwater_height = 0.45\n')
    assert "0.45" in call("show", str(path)).stdout
    shown = call("show", "tait").stdout
    assert re.search(r"^gamma +7\.0 +exponent, at least 1", shown, flags=re.MULTILINE)
    assert "Attributes" not in shown


def test_show_the_walls_of_a_case(tmp_path: Path) -> None:
    picture = tmp_path / "walls.png"
    assert f"wrote {picture}" in call("show", "hydrostatic-tank", "--walls", "--output", str(picture)).stdout
    assert picture.stat().st_size > 10_000


def test_doctor() -> None:
    result = call("doctor")
    assert "threading layer" in result.stdout
    assert "numba" in result.stdout
    assert "no problem found" in result.stdout, result.stdout


def test_values_are_toml_or_text() -> None:
    given = read_assignments(
        ["a=1", "b=0.5", "c=text", 'd="1"', "e=[1, 2]", "f={x = 1}", "g=true", "h=1\nz=2", "i = 3", "j=a=b"],
        {"k": None},
    )
    assert given == {
        "a": 1,
        "b": 0.5,
        "c": "text",
        "d": "1",
        "e": [1, 2],
        "f": {"x": 1},
        "g": True,
        "h": "1\nz=2",
        "i": 3,
        "j": "a=b",
    }


def test_run_writes_what_it_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    result = call("run", "hydrostatic-tank", *SMALL, "--until", "0.02", "--interpolator", "normalized")
    assert result.exit_code == 0, result.output
    assert "normalized interpolation" in result.stderr
    assert "compiling" in result.stderr
    assert "100%" in result.stderr
    for text in ("0.02 s in", "peak at P0", "particle-steps/s", "wrote hydrostatic-tank-normalized.nc"):
        assert text in result.stdout
    with xr.open_dataset(tmp_path / "hydrostatic-tank-normalized.nc") as dataset:
        assert dataset.attrs["case_name"] == "hydrostatic-tank"
    again = call("run", "hydrostatic-tank", *SMALL, "--until", "0.02", "--interpolator", "normalized")
    assert again.exit_code == 2
    assert "hydrostatic-tank-normalized.nc and hydrostatic-tank-normalized.png exist: give --overwrite" in again.stderr
    before = (tmp_path / "hydrostatic-tank-normalized.nc").read_bytes()
    itself = call("run", "hydrostatic-tank-normalized.nc", "--overwrite")
    assert itself.exit_code == 2
    assert "is the run to repeat" in itself.stderr
    assert (tmp_path / "hydrostatic-tank-normalized.nc").read_bytes() == before

    repeated = call(
        "run", "hydrostatic-tank-normalized.nc", "--until", "0.01", "--output", "second.nc", "--threads", "1"
    )
    assert repeated.exit_code == 0, repeated.output
    case = load_case("second.nc")
    assert (case.interpolator.name, case.until, case.particle_spacing) == ("normalized", 0.01, 0.03)


def test_a_case_file_runs_whatever_its_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file:[x]#%d.TOML").write_text(
        """\ufeff
        particle_spacing = 0.03
        until = 0.01
        walls = [{ shape = "polygon", name = "tank", points = [[0, 0.5], [0, 0], [0.3, 0], [0.6, 0.5]] }]
        fluid = [{ shape = "polygon", points = [[0, 0], [0.3, 0], [0.48, 0.3], [0, 0.3]] }]
        probes = [{ name = "[/b]", position = [0, 0] }, { name = "_P [kPa] $x", position = [0, 0.1] }]
        """,
        encoding="utf-8",
    )
    result = call("run", "file:[x]#%d.TOML", "--threads", "1")
    assert result.exit_code == 0, result.output
    assert "peak at [/b]" in result.stdout
    assert "peak at _P [kPa] $x" in result.stdout
    assert (tmp_path / "file:[x]#%d.nc").exists()
    shown = [
        text.get_text() for text in plot_run(open_dataset("file:[x]#%d.nc")).findobj() if hasattr(text, "get_text")
    ]
    assert {"[/b]", r" _P [kPa] \$x"} <= set(shown)
    assert call("animate", "file:[x]#%d.nc", "--output", "a:b.gif").exit_code == 0
    assert (tmp_path / "a:b.gif").exists()


def test_a_case_with_a_warning_runs(tmp_path: Path) -> None:
    output = str(tmp_path / "run.nc")
    result = call(
        "run", "hydrostatic-tank", *SMALL, "--set", "particle_spacing=0.06", "--until", "0.01", "--output", output
    )
    assert result.exit_code == 2  # particle_spacing is given twice
    small = ["--set", "particle_spacing=0.06", "--set", "tank_length=0.3", "--threads", "1"]
    result = call("run", "hydrostatic-tank", *small, "--until", "0.01", "--output", output)
    assert result.exit_code == 0, result.output
    assert "warning: particle_spacing = 0.06 m leaves 5 particles over the depth" in result.stderr


def test_a_failed_run_exits_with_three(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from sphframe.simulation import Simulation

    def fail(self: Simulation) -> None:
        error = SimulationError("the time step has collapsed")
        error.time, error.step = self.time, self.step
        raise error

    monkeypatch.setattr(Simulation, "advance", fail)
    result = call("run", "hydrostatic-tank", *SMALL, "--output", str(tmp_path / "run.nc"))
    assert result.exit_code == 3
    assert "error: the time step has collapsed (t = 0 s, step 0)" in result.stderr


def test_a_defect_has_no_traceback_unless_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from sphframe.simulation import Simulation

    def fail(self: Simulation) -> None:
        raise RuntimeError("plain wrong")

    monkeypatch.setattr(Simulation, "advance", fail)
    arguments = ["run", "hydrostatic-tank", *SMALL, "--output", str(tmp_path / "run.nc"), "--overwrite"]
    result = call(*arguments)
    assert result.exit_code == 1
    assert "RuntimeError: plain wrong" in result.stderr
    assert "Traceback" not in result.stderr
    assert isinstance(call(*arguments, SPHFRAME_DEBUG="1").exception, RuntimeError)


@pytest.mark.parametrize("number", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.long)])
def test_an_interrupted_run_keeps_its_output(tmp_path: Path, number: signal.Signals) -> None:
    command = [sys.executable, "-m", "sphframe", "run", "hydrostatic-tank", *SMALL, "--until", "1000"]
    with subprocess.Popen(
        command,
        cwd=tmp_path,
        env={**os.environ, "NO_COLOR": "1"},
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
    ) as process:
        while not (tmp_path / "hydrostatic-tank.nc").exists():
            assert process.poll() is None
            time.sleep(0.02)
        process.send_signal(number)
        _, errors = process.communicate()
    assert process.returncode == 130
    assert "error: interrupted" in errors
    assert "Traceback" not in errors
    with xr.open_dataset(tmp_path / "hydrostatic-tank.nc") as dataset:
        assert dataset.attrs["case_name"] == "hydrostatic-tank"


class FakeSimulation:
    """What the progress display uses of a running simulation."""

    step, time, time_step = 500, 0.45, 1e-3
    removed_count, densities_outside, behind_walls = 0, 0, 0
    statuses = (20, 10, 0, 0)

    class case:  # noqa: N801
        until = 1.0

    def advance(self, steps: int) -> None:
        self.step, self.time = self.step + steps, self.time + 1e-3 * steps

    def particles_outside(self) -> int:
        return self.behind_walls

    def status_counts(self) -> tuple[int, ...]:
        return self.statuses


@pytest.mark.parametrize("terminal", [False, True])
def test_progress_shows_the_present_rate_and_warnings(terminal: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter([10.0, 12.0])  # the first step includes the compilation
    monkeypatch.setattr("sphframe.analysis.progress.time", SimpleNamespace(monotonic=lambda: next(clock)))
    console = Console(force_terminal=terminal, file=io.StringIO(), record=True, width=200)
    display, simulation = ProgressDisplay(console), FakeSimulation()
    display.sphframe_run_started(simulation)  # resumed: 500 steps were made before
    simulation.advance(1)
    display.sphframe_step_completed(simulation)
    simulation.removed_count, simulation.behind_walls, simulation.statuses = 2, 1, (15, 10, 5, 0)
    display.sphframe_frame_due(simulation)
    simulation.advance(100)
    display.sphframe_step_completed(simulation)
    display.sphframe_run_failed(simulation, KeyboardInterrupt())
    text = " ".join(console.export_text().split())
    assert "step 601, t = 0.551 of 1 s, dt = 1.00e-03 s, 50 steps/s, 0:00:09 left" in text
    for wrong in ("1 particle behind walls", "2 particles removed", "25 % of wet ghosts by fallback"):
        assert wrong in text


def test_without_its_widgets_a_notebook_has_no_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    display = ProgressDisplay(Console(force_jupyter=True, file=io.StringIO()))
    live = []
    for found in (None, "a module"):
        monkeypatch.setattr("sphframe.analysis.progress.find_spec", lambda _, found=found: found)
        live.append(display.is_live)
    assert live == [False, True]


def test_doctor_fails_where_nothing_can_run(monkeypatch: pytest.MonkeyPatch) -> None:
    from sphframe.cli import doctor

    healthy = call("doctor")
    assert healthy.exit_code == 0, healthy.output
    monkeypatch.setattr(doctor, "check", lambda kind: [] if kind == "interpolators" else registry.check(kind))
    found = call("doctor")
    assert found.exit_code == 1
    assert "no interpolators: nothing can run; pip install sphframe-shepard" in found.stdout


def test_doctor_finds_a_cache_that_cannot_be_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from sphframe.cli import doctor

    def full(**_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    assert doctor._fault(tmp_path, []) == ""
    (tmp_path / "loop.nbi").touch()
    assert "loop.nbi: remove them" in doctor._fault(tmp_path, [tmp_path / "loop.nbi"])
    assert "cannot be kept" in doctor._fault(tmp_path / "nowhere", [])
    monkeypatch.setattr(tempfile, "TemporaryFile", full)
    assert "(No space left on device): make room there, or set NUMBA_CACHE_DIR" in doctor._fault(tmp_path, [])


def test_errors_in_python_name_the_files_that_remain_and_nothing_else_stays(tmp_path: Path) -> None:
    program = (
        "import sphframe\n"
        "class Stop:\n"
        "    @sphframe.hookimpl\n"
        "    def sphframe_step_completed(self, simulation):\n"
        "        if simulation.step == 2 and self.stops: raise KeyboardInterrupt\n"
        "    stops = False\n"
        "stop = Stop()\n"
        "case = sphframe.HydrostaticTank(particle_spacing=0.03, tank_length=0.3, until=0.01)\n"
        "sphframe.run(case, threads=1, hooks=[stop]).dataset.close()\n"
        "stop.stops = True\n"
        "sphframe.run(case, threads=1, hooks=[stop], output='kept.nc')\n"
    )
    environment = {**os.environ, "TMPDIR": str(tmp_path / "temporary")}
    (tmp_path / "temporary").mkdir()
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert "KeyboardInterrupt" in done.stderr
    assert "kept.nc holds the run up to t = " in done.stderr
    assert "sphframe.resume('kept.nc') continues it" in done.stderr
    assert not [file.name for file in (tmp_path / "temporary").iterdir() if file.name.startswith("sphframe")]
