"""Integrators of several steps, as authors of plugins write them: the system keeps what they need of earlier ones."""

import inspect
import math
import re
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

import sphframe
from sphframe import Integrator, Simulation
from sphframe.cases import Custom
from sphframe.testing import parametrize_with_checks
from sphframe.testing.integrators import Oscillator

TEXT = (Path(__file__).parents[2] / "docs" / "components.md").read_text(encoding="utf-8")
ON_PAGE = next(block for block in re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL) if "(Integrator)" in block)
page: dict[str, Any] = {}
exec(compile(ON_PAGE, "components.md", "exec"), page)
AdamsBashforth2: type[Integrator] = page["AdamsBashforth2"]


class LeapFrog(Integrator):
    """y1 = y0 + dt [(1 + r) f(t) - r (y0 - y(-1))/dt0], r = dt/dt0: the total of the step before is stored.

    It amplifies whatever is damped, such as the flow of a viscous fluid.
    """

    order: ClassVar[int] = 2
    evaluations: ClassVar[int] = 1
    stability_limit: ClassVar[float] = 1.1
    courant_number: ClassVar[float] = 0.5
    memory: ClassVar[int] = 1

    def step(self, system: Any, time: float, time_step: float) -> None:
        system.hold()
        system.evaluate(time)
        system.accumulate(1.0)
        before = system.stored_time(0)
        if before is not None:
            ratio = time_step / (time - before)
            system.accumulate(ratio)
            system.accumulate_stored(0, -ratio)
        system.advance_total(time_step)
        system.store(0, time)


@parametrize_with_checks(
    [AdamsBashforth2(), LeapFrog()],
    expected_failed_checks=lambda integrator: (
        {} if isinstance(integrator, LeapFrog) else {"energy": "the scheme amplifies sound, by (omega dt)^4/4 a step"}
    ),
)
def test_the_kit_takes_integrators_with_memory(integrator, check):
    check(integrator)


@pytest.mark.parametrize("integrator", [AdamsBashforth2(), LeapFrog()])
def test_steps_of_different_length_keep_the_order(integrator):
    errors = []
    for steps in (80, 160):
        system, time = Oscillator(forcing=0.5, push=0.5), 0.0
        for k in range(steps):
            later = 3.0 * (k + 1) / steps + 0.4 * math.sin(math.pi * (k + 1) / steps) ** 2
            integrator.step(system, time, later - time)
            time = later
        errors.append(np.abs(np.subtract((system.x, system.u, system.rho), system.exact(3.0))).max())
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.2)


NAMES = ["AdamsBashforth2", "LeapFrog"]
BASIN: dict[str, Any] = {
    "particle_spacing": 0.05,
    "until": 0.12,
    "frame_interval": 0.04,
    "probe_interval": 0.04,
    "walls": [{"shape": "polygon", "name": "tank", "points": [(0.0, 0.5), (0.0, 0.0), (0.6, 0.0), (0.6, 0.5)]}],
    "fluid": [{"shape": "polygon", "points": [(0.0, 0.0), (0.6, 0.0), (0.6, 0.3), (0.0, 0.15)]}],
    "tension": "free",
    "wall_treatment": "dynamic-2007",
}
"""water that runs down a slope in a basin whose walls have densities of their own"""
FALLING: dict[str, Any] = {
    **BASIN,
    "walls": [{**BASIN["walls"][0], "body": "tank"}],
    "bodies": {"tank": {"name": "free", "mass": 1e9, "inertia": 1e9, "centre": (0.3, 0.2)}},
    "wall_treatment": "fixed-ghosts",
    "domain": ((-0.5, -0.5), (1.1, 1.0)),
    "guards": {"filling": "report"},
}
"""the same in a tank that falls freely, too heavy for the water to matter"""


@pytest.fixture
def my_steps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a module with both integrators, which is the working folder."""
    (tmp_path / "my_steps.py").write_text(f"from typing import Any\n{ON_PAGE}\n\n{inspect.getsource(LeapFrog)}")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "my_steps", raising=False)
    return tmp_path


def simulated(case: dict[str, Any], **changes: Any) -> Simulation:
    return Simulation(Custom(**{**case, **changes}), threads=1)


@pytest.mark.parametrize(("treatment", "until"), [("fixed-ghosts", 0.16), ("dynamic-2007", 0.02)])
def test_positions_converge_with_the_order(treatment, until, my_steps):
    """Until 0.16 s particles are put in another order; with densities of its own the wall is smooth only before."""

    def end(integrator: str, time_step: float) -> np.ndarray:
        changes = {"integrator": integrator, "time_step": time_step, "wall_treatment": treatment, "until": until}
        simulation = simulated(BASIN, **changes)
        order = simulation.system.ids.copy()
        while simulation.time < until - 1e-9:
            simulation.advance()
        assert until < 0.1 or np.any(simulation.system.ids != order), "no particle has changed its place"
        return simulation.fields().position

    exact = end("rk4", 2.5e-4)
    errors = [np.abs(end("my_steps:AdamsBashforth2", step) - exact).max() for step in (1e-3, 5e-4)]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.15, abs=0.15)


@pytest.mark.parametrize("name", NAMES)
def test_a_tank_falls(name, my_steps):
    """Both schemes are exact for y = -g t^2/2 but for the first step, which is Euler's: y(dt) = 0, u(dt) = -g dt."""
    step = 1e-3
    simulation = simulated(FALLING, integrator=f"my_steps:{name}", time_step=step)
    for _ in range(20):
        simulation.advance()
    motion, time = simulation.body_motions()["tank"], simulation.time
    fallen = 0.5 * 9.81 * (time**2 - (step**2 if name == "AdamsBashforth2" or round(time / step) % 2 else 0.0))
    assert motion.velocity[1] == pytest.approx(-9.81 * time, rel=1e-6)
    assert motion.position[1] == pytest.approx(-fallen, rel=1e-6)


@pytest.mark.parametrize("case", [BASIN, FALLING], ids=["basin", "falling"])
@pytest.mark.parametrize("name", NAMES)
def test_a_restored_simulation_continues_with_the_same_bits(name, case, my_steps):
    whole = simulated(case, integrator=f"my_steps:{name}")
    for _ in range(30):
        whole.advance()
    saved = whole.state()
    again = simulated(case, integrator=f"my_steps:{name}")
    again.restore(saved)
    for simulation in (whole, again):
        for _ in range(40):
            simulation.advance()
    for key, value in whole.state().items():
        if key != "clocks":
            np.testing.assert_array_equal(again.state()[key], value, err_msg=key)


KILLED = """
import os, signal, sys
import sphframe
class Kill:
    @sphframe.hookimpl
    def sphframe_step_completed(self, simulation):
        if simulation.step == 60:
            os.kill(os.getpid(), signal.SIGKILL)
sphframe.run("basin.toml", output="killed.nc", threads=1, integrator="my_steps:AdamsBashforth2", hooks=[Kill()],
             checkpoint_interval=0.02)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL is POSIX")
@pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
def test_a_killed_run_is_resumed_to_the_bit(my_steps):
    (my_steps / "basin.toml").write_text(
        """particle_spacing = 0.05
until = 0.12
frame_interval = 0.04
probe_interval = 0.02
wall_treatment = "dynamic-2007"
walls = [{shape = "polygon", name = "tank", points = [[0.0, 0.5], [0.0, 0.0], [0.6, 0.0], [0.6, 0.5]]}]
fluid = [{shape = "polygon", points = [[0.0, 0.0], [0.6, 0.0], [0.6, 0.3], [0.0, 0.15]]}]
"""
    )
    address = "my_steps:AdamsBashforth2"
    whole = sphframe.run("basin.toml", output="whole.nc", threads=1, integrator=address)
    ended = subprocess.run([sys.executable, "-c", KILLED], check=False)
    assert ended.returncode == -signal.SIGKILL
    resumed = sphframe.resume("killed.nc", threads=1, trusted=True)
    for name in set(whole.dataset.variables) - {"wall_clock", "processor_time"}:
        np.testing.assert_array_equal(resumed.dataset[name].values, whole.dataset[name].values, err_msg=name)
