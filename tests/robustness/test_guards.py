"""Guards stop a run that has gone wrong before a wrong state is written; the message says what, when, where and why."""

from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from sphframe import PluginError, SimulationError, open_dataset, run
from sphframe.cli.app import app
from sphframe.output.checkpoint import read_checkpoint

pytestmark = pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")


def put(column: str, value: float) -> Callable[[Any], None]:
    """Give the first particle a value."""

    def change(simulation: Any) -> None:
        place = getattr(simulation.columns, column)
        simulation.system.rows[0, place] = value

    return change


def gather(simulation: Any) -> None:
    """Put five particles in one place, and compress another one beside them."""
    rows, columns = simulation.system.rows, simulation.columns
    middle = rows[: simulation.fluid_count, columns.position].mean(axis=0)
    beside = np.argsort(np.linalg.norm(rows[: simulation.fluid_count, columns.position] - middle, axis=1))[:6]
    rows[beside[:5], columns.position] = middle
    rows[beside[5], columns.density] = 3000.0


def spoil_ghosts(simulation: Any) -> None:
    rows, pressure = simulation.system.rows, simulation.columns.pressure
    near = simulation.system.lists.near
    lowest = near[np.argmin(simulation.boundary.position[near, 1])]  # no particle sees it
    simulation.system.fill_ghosts = lambda: rows.__setitem__((simulation.fluid_count + lowest, pressure), np.nan)


def spoil_body(simulation: Any) -> None:
    object.__setattr__(simulation.boundary.bodies["seawall"], "mass", np.nan)


def fall_back(simulation: Any) -> None:
    fill = simulation.system.fill_ghosts

    def fill_badly() -> None:
        fill()
        simulation.boundary.statuses[:] = 2

    simulation.system.fill_ghosts = fill_badly


def shoot(simulation: Any) -> None:
    simulation.system.rows[0, simulation.columns.velocity.start] = 1e5


STOPS: list[tuple[str, Callable[[Any], None], dict[str, Any], str]] = [
    ("NaN", put("density", np.nan), {}, r"state that is not finite .*causes: a component or a hook that wrote NaN \("),
    ("infinity", put("velocity", np.inf), {}, r"not finite|vanish|collapsed"),
    (
        "density",
        put("density", 3000.0),
        {},
        r"outside the band 500 to 1500 kg/m\^3 .*causes: (walls|two).*guards.density = \"count\"",
    ),
    (
        "gathered",
        gather,
        {},
        r"causes: [5-9] particles in one place, .*tension = \"none\".* courant_number.*guards.density = ",
    ),
    ("narrow band", put("density", 1100.0), {"guards": {"density_band": (0.95, 1.05)}}, r"band 950 to 1050 kg/m\^3"),
    (
        "counted",
        put("density", -5000.0),
        {"guards": {"density": "count"}},
        r"particle \d+ has a density that is not positive",
    ),
    ("domain", put("position", -0.9), {}, r"has left the domain .*walls that leak.*guards.domain = \"remove\""),
    (
        "time step",
        shoot,
        {"domain": ((-200.0, -200.0), (200.0, 200.0))},
        r"time step has collapsed to .*courant_number.*raise sound_speed",
    ),
    ("ghosts", spoil_ghosts, {}, r"ghost \d+ got pressure nan.*interpolator 'improved-shepard' of sphframe-shepard"),
    ("body", spoil_body, {}, r"body 'seawall' failed: SpringMass.motion .* returned Motion\(.*nan"),
    (
        "fallbacks",
        fall_back,
        {"guards": {"fallbacks": "stop", "fallback_limit": 0.9}, "interpolator": "mls-quadratic"},
        r"% of the wet ghosts use the fallback of interpolator 'mls-quadratic'.*lower order.*fallbacks = \"count\"",
    ),
]


@pytest.mark.parametrize(("what", "action", "parameters", "message"), STOPS, ids=[stop[0] for stop in STOPS])
def test_a_guard_stops_the_run_and_keeps_the_last_good_state(
    small: ModuleType,
    tmp_path: Path,
    what: str,
    action: Callable[[Any], None],
    parameters: dict[str, Any],
    message: str,
) -> None:
    path = tmp_path / "run.nc"
    at = 12
    with pytest.raises(SimulationError, match=message) as caught:
        run(
            small.small_case(2, frame_interval=0.002, probe_interval=0.002, **parameters),
            output=path,
            threads=1,
            checkpoint_interval=0.004,
            hooks=[small.At(at, action)],
        )
    error = caught.value
    assert error.step is not None
    assert error.time is not None
    assert at <= error.step <= at + 1
    assert f"step {error.step}" in str(error)
    assert "t = " in str(error)
    if what not in ("time step", "body"):
        assert error.place is not None
        assert len(error.place) == 2
    with open_dataset(path) as dataset:
        assert dataset.attrs["run_status"] == "failed"
        assert dataset.attrs["run_message"].startswith("SimulationError: ")
        assert np.isfinite(dataset.position.values).all(), "a bad state was written"
        assert (abs(dataset.density.values / 1000.0 - 1.0) < 0.5).all()
    saved = read_checkpoint(tmp_path / "run.nc.restart")
    assert 0.0 < saved.time <= error.time
    assert all(np.isfinite(array).all() for array in saved.state.values())


def test_a_limit_that_is_passed_at_the_start_stops_before_anything_is_written(
    small: ModuleType, tmp_path: Path
) -> None:
    case = small.small_case(2, interpolator="mls-quadratic", guards={"fallbacks": "stop", "fallback_limit": 0.0})
    with pytest.raises(SimulationError, match=r"wet ghosts use the fallback .*\(t = 0 s, step 0, at"):
        run(case, output=tmp_path / "run.nc", threads=1)
    assert not list(tmp_path.iterdir())


def test_densities_are_counted_instead(small: ModuleType, tmp_path: Path) -> None:
    case = small.small_case(2, until=0.02, guards={"density": "count", "density_band": (0.9999, 1.0001)})
    result = run(case, output=tmp_path / "run.nc", threads=1)
    assert result.dataset.densities_outside.values.max() > 10
    assert result.dataset.particles_removed.values.max() == 0


def test_an_unstable_run_ends_with_exit_code_3(here: Path) -> None:
    result = CliRunner().invoke(
        app,
        ["run", "hydrostatic-tank", "--set", "particle_spacing=0.03", "--set", "time_step=0.01", "--threads", "1"],
        env={"COLUMNS": "200", "NO_COLOR": "1"},
    )
    assert result.exit_code == 3, result.output
    assert "warning: time_step = 0.01 s gives c0 dt/h" in result.stderr
    assert "error: particle" in result.stderr
    assert "likely causes: a time step above the stability limit" in result.stderr
    assert "Traceback" not in result.output
    with open_dataset("hydrostatic-tank.nc") as dataset:
        assert dataset.attrs["run_status"] == "failed"
        assert np.isfinite(dataset.position.values).all()


METHOD = """
import math
from dataclasses import dataclass
from sphframe import BoundaryInterpolator, OK, Traits

@dataclass(frozen=True)
class Bad(BoundaryInterpolator):
    traits = Traits(non_negative=True)

    def point_weights(self, kernel, dim):
        {before}
        def weights(offsets, distances, kernel_values, volumes, support, lift, out):
            n = len(distances)
            for j in range(n):
                out[j] = 1.0 / n
            {inside}
            return OK
        return weights
"""

BAD_METHODS: list[tuple[str, str, str, type[Exception], str]] = [
    ("raises when built", "raise RuntimeError('no licence')", "", PluginError, "failed: RuntimeError: no licence"),
    ("raises in the loop", "", "if n > 3: raise ValueError('too many')", Exception, r"'bad' of bad-method 1.0 failed"),
    ("returns NaN", "", "out[0] = math.nan", SimulationError, r"ghost \d+ got pressure nan.*'bad' of bad-method 1.0"),
    (
        "negative weights",
        "",
        "out[0] -= 0.5; out[n - 1] += 0.5",
        SimulationError,
        r"'bad' of bad-method 1.0 returned negative weights, against its traits.*sphframe verify bad",
    ),
    ("no partition of unity", "", "out[0] += 0.1", SimulationError, "weights that do not add up to one"),
    ("does not compile", "", "out[0] = 'a' + n", PluginError, "does not compile: there is no add"),
    ("uses an unknown name", "", "out[0] = alpha", PluginError, r"'bad' of bad-method 1.0 does not compile.*alpha"),
    ("returns no status", "", "return 17", SimulationError, r"status 17 from interpolator 'bad'"),
]


@pytest.mark.filterwarnings("ignore::numba.core.errors.NumbaWarning")
@pytest.mark.parametrize(("what", "before", "inside", "error", "message"), BAD_METHODS, ids=[m[0] for m in BAD_METHODS])
def test_a_bad_plugin_ends_with_its_name(
    install: Any, small: ModuleType, tmp_path: Path, what: str, before: str, inside: str, error: Any, message: str
) -> None:
    install("bad-method", {"bad_method": METHOD.format(before=before, inside=inside)},
            {"interpolators": {"bad": "bad_method:Bad"}})  # fmt: skip
    path = tmp_path / "run.nc"
    with pytest.raises((PluginError, SimulationError), match=f"(?s){message}") as caught:
        run(small.small_case(2), interpolator="bad", output=path, threads=1)
    assert isinstance(caught.value, error)
    if path.exists():
        with open_dataset(path) as dataset:
            assert np.isfinite(dataset.position.values).all()


def test_a_method_that_turns_bad_is_caught_at_the_next_frame(install: Any, small: ModuleType, tmp_path: Path) -> None:
    inside = "if distances[0] * 7919.0 % 1.0 < 0.05: out[0] -= 1.0; out[n - 1] += 1.0"
    install("bad-method", {"bad_method": METHOD.format(before="", inside=inside)},
            {"interpolators": {"bad": "bad_method:Bad"}})  # fmt: skip
    with pytest.raises(SimulationError, match="negative weights"):
        run(small.small_case(2), interpolator="bad", output=tmp_path / "run.nc", threads=1)


def test_a_body_and_a_hook_that_raise(small: ModuleType, tmp_path: Path) -> None:
    def fail(simulation: Any) -> None:
        raise ZeroDivisionError("of my own")

    with pytest.raises(ZeroDivisionError, match="of my own"):
        run(small.small_case(2), output=tmp_path / "a.nc", threads=1, hooks=[small.At(3, fail)])
    with open_dataset(tmp_path / "a.nc") as dataset:
        assert dataset.attrs["run_message"] == "ZeroDivisionError: of my own"

    def break_body(simulation: Any) -> None:
        object.__setattr__(simulation.boundary.bodies["seawall"], "mass", 0.0)

    with pytest.raises(SimulationError, match=r"body 'seawall' failed: SpringMass.motion .*ZeroDivisionError"):
        run(small.small_case(2), output=tmp_path / "b.nc", threads=1, hooks=[small.At(3, break_body)])


HOOK = """
from sphframe import hookimpl

class Sensor:
    @hookimpl
    def sphframe_step_completed(self, simulation):
        if simulation.step == 3:
            raise LookupError("no such sensor")
"""


def test_an_installed_hook_that_raises_is_named(install: Any, here: Path) -> None:
    install("bad-hook", {"bad_hook": HOOK}, {"hooks": {"sensor": "bad_hook:Sensor"}})
    arguments = ["run", "hydrostatic-tank", "--set", "particle_spacing=0.05", "--until", "0.1", "--output", "run.nc"]
    result = CliRunner().invoke(app, arguments, env={"COLUMNS": "400", "NO_COLOR": "1"})
    assert result.exit_code == 3, result.output
    assert "'sensor' of bad-hook 1.0 failed: LookupError: no such sensor" in result.stderr
    assert "pip uninstall bad-hook" in result.stderr
    assert "step 3" in result.stderr
    assert "Traceback" not in result.output
    with open_dataset("run.nc") as dataset:
        assert dataset.attrs["run_status"] == "failed"
        assert np.isfinite(dataset.position.values).all()
