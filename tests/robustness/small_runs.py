"""Small cases whose runs take about a second, and a comparison of all bits of two runs.

Run as a program, it starts a process for each line ``NAME STEPS DELAY FOLDER`` of its input. The process runs that case
in the folder, or continues it, and is killed DELAY s of processor time after STEPS steps. With STEPS = 0 the delay
counts from the start; with STEPS = -1 the run comes to its end.
"""

import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from sphframe import hookimpl, resume, run
from sphframe.bodies import Prescribed
from sphframe.cases import Custom, Scene
from sphframe.geometry import BoxRegion, BoxWall, PolygonWall

TIMING = {"wall_clock", "processor_time"}


def oscillation(time: float) -> tuple[list[float], list[float], list[float]]:
    """2 cm along x at 1.5 Hz, starting at rest."""
    a, w = 0.01, 3.0 * np.pi
    return (
        [a * (1.0 - np.cos(w * time)), 0.0, 0.0],
        [a * w * np.sin(w * time), 0.0, 0.0],
        [a * w * w * np.cos(w * time), 0.0, 0.0],
    )


class ShakenTank(Custom):
    """A tank in three dimensions whose walls move."""

    def scene(self) -> Scene:
        scene = super().scene()
        return Scene(**{**vars(scene), "bodies": {"tank": Prescribed(oscillation)}})


FLUME: dict[str, Any] = {
    "particle_spacing": 0.03,
    "until": 0.3,
    "frame_interval": 0.04,
    "probe_interval": 0.01,
    "walls": [
        PolygonWall(name="bed", points=[(-0.2, 0.0), (0.8, 0.0)]),
        PolygonWall(name="paddle", points=[(0.0, 0.5), (0.0, 0.0)], body="paddle", one_sided=True),
        PolygonWall(name="seawall", points=[(0.6, 0.0), (0.6, 0.5)], body="seawall", one_sided=True),
    ],
    "fluid": [BoxRegion(lower=(0.0, 0.0), upper=(0.6, 0.3))],
    "bodies": {
        "paddle": {"name": "regular-wave-paddle", "wave_height": 0.1, "period": 0.5, "depth": 0.3, "ramp_periods": 0.5},
        "seawall": {"name": "spring-mass", "mass": 250.0, "stiffness": 5000.0, "threshold": 300.0},
    },
    "probes": [{"name": "toe", "position": (0.3, 0.0)}],
    "gauges": [{"name": "middle", "position": (0.3,)}],
}
"""water between a wave paddle and a seawall that the load moves, as parameters of a custom case"""

SHAKEN: dict[str, Any] = {
    "dimension": 3,
    "particle_spacing": 0.05,
    "until": 0.6,
    "frame_interval": 0.04,
    "probe_interval": 0.01,
    "walls": [BoxWall(name="tank", lower=(0.0, 0.0, 0.0), upper=(0.3, 0.2, 0.4), open_faces=("+z",), body="tank")],
    "fluid": [BoxRegion(lower=(0.0, 0.0, 0.0), upper=(0.3, 0.2, 0.25))],
    "domain": ((-0.2, -0.2, -0.2), (0.6, 0.4, 0.8)),
    "probes": [{"name": "toe", "position": (0.15, 0.1, 0.0)}],
}

CHANNEL: dict[str, Any] = {
    "particle_spacing": 0.1,
    "until": 1.2,
    "time_step": 3e-3,
    "frame_interval": 0.1,
    "probe_interval": 0.02,
    "gravity": 0.0,
    "sound_speed": 10.0,
    "depth": 1.0,
    "kinematic_viscosity": 0.05,
    "slip": "no",
    "tension": "free",
    "open_boundaries": {"velocity": 1.0, "profile": "parabola", "ramp": 0.5},
    "walls": [
        PolygonWall(name="bed", points=[(-0.5, 0.0), (3.0, 0.0)]),
        PolygonWall(name="lid", points=[(-0.5, 1.0), (3.0, 1.0)], one_sided=True),
    ],
    "fluid": [BoxRegion(lower=(0.0, 0.0), upper=(2.5, 1.0))],
    "probes": [{"name": "middle", "position": (1.2, 0.0)}],
}
"""a channel with open ends, through which the fluid flows faster and faster"""
PLANE = {"flume": FLUME, "channel": CHANNEL}
"""cases in two dimensions"""


def small_case(dimension: int, **parameters: Any) -> Custom:
    """Two moving bodies in 2-D, a shaken tank in 3-D."""
    return Custom(**{**FLUME, **parameters}) if dimension == 2 else ShakenTank(**{**SHAKEN, **parameters})


def assert_same_bits(one: xr.Dataset, other: xr.Dataset) -> None:
    """Check that all variables of two runs have the same bits, except the wall-clock time."""
    assert set(one.variables) == set(other.variables)
    for name in set(one.variables) - TIMING:
        a, b = one[name].values, other[name].values
        assert a.dtype == b.dtype, name
        assert a.shape == b.shape, name
        assert a.tobytes() == b.tobytes() or (a.dtype.kind == "O" and (a == b).all()), f"{name} differs"


class At:
    """A hook plugin that calls ``action(simulation)`` once, after the step of a given number."""

    def __init__(self, step: int, action: Callable[[Any], object]) -> None:
        self._step, self._action = step, action

    @hookimpl
    def sphframe_step_completed(self, simulation: Any) -> None:
        """Call it at that step."""
        if simulation.step == self._step:
            self._action(simulation)


class Recorder:
    """A hook plugin that writes the time of each step to a file at once."""

    def __init__(self, path: Path) -> None:
        self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND)

    @hookimpl
    def sphframe_run_started(self, simulation: Any) -> None:
        """Write where the run starts."""
        os.write(self._file, f"start {simulation.time!r}\n".encode())

    @hookimpl
    def sphframe_step_completed(self, simulation: Any) -> None:
        """Write how far the run is."""
        os.write(self._file, f"{simulation.time!r}\n".encode())


class Killer:
    """A hook plugin that kills the process at some moment after a number of steps of this process."""

    def __init__(self, steps: int, delay: float) -> None:
        self._steps, self._delay = steps, delay

    @hookimpl
    def sphframe_step_completed(self, simulation: Any) -> None:
        """Count the step; start the timer after the last one."""
        self._steps -= 1
        if self._steps == 0:
            die_after(self._delay)


def die_after(delay: float) -> None:
    """Let the system kill this process after ``delay`` s of processor time, however busy the machine is."""
    signal.signal(signal.SIGPROF, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_PROF, max(delay, 1e-6))


CHECKPOINT_INTERVAL = 0.02


def run_or_resume(name: str, folder: Path, hooks: list[object]) -> None:
    """Run the case of that name in ``folder``, or continue it there if it has a checkpoint."""
    output = folder / "run.nc"
    options: dict[str, Any] = {
        "threads": 1,
        "checkpoint_every": None,
        "checkpoint_interval": CHECKPOINT_INTERVAL,
        "hooks": [Recorder(folder / "steps.txt"), *hooks],
    }
    if (folder / "run.nc.restart").exists():
        resume(output, **options)
    else:
        run(Custom(**PLANE[name]), output=output, overwrite=True, **options)


if __name__ == "__main__":
    for line in sys.stdin:
        name, steps, delay, folder = line.strip().split(" ", 3)
        child = os.fork()
        if child == 0:
            try:
                if steps == "0":
                    die_after(float(delay))
                run_or_resume(name, Path(folder), [Killer(int(steps), float(delay))])
                os._exit(0)
            finally:
                os._exit(1)
        _, status = os.waitpid(child, 0)
        print("killed" if os.WIFSIGNALED(status) else {0: "complete"}.get(status, "failed"), flush=True)
