"""Small cases whose runs take a second, and comparison to the bit.

Run as a program, it starts a process for each folder named on its input, which runs a case there, or continues it,
until it is killed.
"""

import os
import sys
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from sphframe import hookimpl, resume, run
from sphframe.bodies import Prescribed
from sphframe.cases import Custom, Scene
from sphframe.geometry import BoxRegion, BoxWall, PolygonWall

TIMING = {"wall_clock"}


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
    "until": 0.6,
    "frame_interval": 0.04,
    "probe_interval": 0.01,
    "walls": [
        PolygonWall(name="bed", points=[(-0.2, 0.0), (0.8, 0.0)]),
        PolygonWall(name="paddle", points=[(0.0, 0.5), (0.0, 0.0)], body="paddle"),
        PolygonWall(name="seawall", points=[(0.6, 0.0), (0.6, 0.5)], body="seawall"),
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


def small_case(dimension: int, **parameters: Any) -> Custom:
    """Two moving bodies in 2-D, a shaken tank in 3-D."""
    return Custom(**{**FLUME, **parameters}) if dimension == 2 else ShakenTank(**{**SHAKEN, **parameters})


def assert_same_bits(one: xr.Dataset, other: xr.Dataset) -> None:
    """Every variable of two runs has the same bits, but for those that measure the computer."""
    assert set(one.variables) == set(other.variables)
    for name in set(one.variables) - TIMING:
        a, b = one[name].values, other[name].values
        assert a.dtype == b.dtype, name
        assert a.shape == b.shape, name
        assert a.tobytes() == b.tobytes() or (a.dtype.kind == "O" and (a == b).all()), f"{name} differs"


class Recorder:
    """A hook plugin that writes the time of each step to a file at once."""

    def __init__(self, path: Path) -> None:
        self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND)

    @hookimpl
    def sphframe_run_started(self, simulation: Any) -> None:
        """Say where the run starts."""
        os.write(self._file, f"start {simulation.time!r}\n".encode())

    @hookimpl
    def sphframe_step_completed(self, simulation: Any) -> None:
        """Say how far it is."""
        os.write(self._file, f"{simulation.time!r}\n".encode())


CHECKPOINT_INTERVAL = 0.02


def run_or_resume(folder: Path) -> None:
    """Run the flume in ``folder``, or continue it there if it has a checkpoint."""
    output = folder / "run.nc"
    options: dict[str, Any] = {
        "threads": 1,
        "checkpoint_interval": CHECKPOINT_INTERVAL,
        "hooks": [Recorder(folder / "steps.txt")],
    }
    if (folder / "run.nc.restart").exists():
        resume(output, **options)
    else:
        run(small_case(2), output=output, overwrite=True, **options)


if __name__ == "__main__":
    for line in sys.stdin:
        child = os.fork()
        if child == 0:
            print(os.getpid(), flush=True)
            run_or_resume(Path(line.strip()))
            os._exit(0)
        _, status = os.waitpid(child, 0)
        print("complete" if status == 0 else "killed", flush=True)
