"""Reproduction: measures what boundary methods cost, interpolation alone and whole step, on the same state."""

import os
import platform
import statistics
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from scipy.spatial import cKDTree

from sphframe.interfaces import Status
from sphframe.output.provenance import software
from sphframe.reproduction.tasks import Task, Tell, made_with, wall_boundary
from sphframe.simulation import Simulation

__all__ = ["CostTask", "machine"]

_WARM_UP = 3
_STEPS = 8
"""steps timed at once: among them is the share of those that search for neighbours anew"""
_SHORTEST = 0.004
"""s: what is timed at once, so that the clock's resolution does not matter"""


@dataclass(frozen=True)
class CostTask(Task):
    """Time several methods on one state of a case.

    The case runs to ``after`` (s) with its own method; every method then starts from that state. Compilation and the
    first steps are not timed. The methods take turns in each of ``repeats``, so that whatever else the machine does
    falls on all alike; what is said of a method are medians. All with one thread; the time is that of the processor,
    which on a quiet machine is the time on the wall. How much longer the wall's was is in the attribute ``busy``.

    Attributes
    ----------
    methods: the components that choose the methods, and their lifts, by the name under which they are reported.
    """

    methods: Mapping[str, tuple[Mapping[str, Any], str]]
    after: float = 0.0
    repeats: int = 25

    alone: ClassVar[bool] = True

    @property
    def weight(self) -> float:
        """Expected work: particles times steps."""
        case = self.case()
        steps = self.after / case.until + len(self.methods) * self.repeats * 2e-4
        return super().weight * steps

    def recipe(self) -> dict[str, Any]:
        """Return all that the measurement depends on, but for the machine."""
        made = {label: made_with(self._case_of(label)) for label in self.methods}
        own = {
            "clock": "processor",
            "methods": self.methods,
            "after": self.after,
            "repeats": self.repeats,
            "made_with": made,
        }
        return {**super().recipe(), **own}

    def _case_of(self, label: str) -> Any:
        return type(self.case())(**{**self.parameters, **wall_boundary(*self.methods[label])})

    def perform(self, path: Path, threads: int, tell: Tell) -> None:
        """Measure, and write the times."""
        first = Simulation(self.case(), threads=1)
        for _ in range(_WARM_UP):
            first.advance()
        while first.time < self.after:
            first.advance()
            tell(0.5 * first.time / self.after)
        state = first.state()
        simulations = {}
        for label in self.methods:
            simulation = Simulation(self._case_of(label), threads=1)
            simulation.restore(state)
            for _ in range(_WARM_UP):
                simulation.advance()
            simulations[label] = simulation
        fill = np.zeros((len(simulations), self.repeats))
        step = np.zeros((len(simulations), self.repeats))
        loops = {label: _loops(s.system.fill_ghosts) for label, s in simulations.items()}
        wall, processor = time.perf_counter(), time.process_time()
        for repeat in range(self.repeats):
            for k, (label, simulation) in enumerate(simulations.items()):
                fill[k, repeat] = _seconds(simulation.system.fill_ghosts, loops[label])
                step[k, repeat] = _seconds(simulation.advance, _STEPS)
            tell(0.5 + 0.5 * (repeat + 1) / self.repeats)
        busy = (time.perf_counter() - wall) / max(time.process_time() - processor, 1e-9)
        _dataset(simulations, fill, step).assign_attrs(busy=busy).to_netcdf(path, engine="netcdf4")


def _dataset(simulations: Mapping[str, Simulation], fill: Any, step: Any) -> xr.Dataset:
    counted = [_neighbours(simulation) for simulation in simulations.values()]
    one = next(iter(simulations.values()))
    return xr.Dataset(
        {
            "fill": (("interpolator", "repeat"), fill, {"units": "s", "long_name": "filling all ghosts once"}),
            "step": (("interpolator", "repeat"), step, {"units": "s", "long_name": "one whole time step"}),
            "points": ("interpolator", [points for points, _ in counted], {"units": "1", "long_name": "wet ghosts"}),
            "neighbours": (
                "interpolator",
                [n for _, n in counted],
                {"units": "1", "long_name": "mean within the support"},
            ),
        },
        coords={"interpolator": list(simulations)},
        attrs={
            "particles": one.fluid_count,
            "ghosts": one.ghost_count,
            "particle_spacing": one.case.particle_spacing,
            "smoothing_length_ratio": one.case.smoothing_length_ratio,
            "time": one.time,
            **{f"machine: {name}": value for name, value in machine().items()},
        },
    )


def _neighbours(simulation: Simulation) -> tuple[int, float]:
    """Number of wet ghosts and the mean number of particles within the support of their evaluation points."""
    boundary = simulation.boundary
    wet = boundary.points[boundary.statuses != Status.DRY]
    if not len(wet):
        return 0, 0.0
    tree = cKDTree(simulation.fields().position)
    return len(wet), float(np.mean(tree.query_ball_point(wet, simulation.support, return_length=True)))


def _loops(function: Callable[[], object]) -> int:
    """How often to call ``function`` for one sample."""
    once = statistics.median(_seconds(function, 1) for _ in range(3))
    return max(1, round(_SHORTEST / max(once, 1e-7)))


def _seconds(function: Callable[[], object], loops: int) -> float:
    began = time.process_time()
    for _ in range(loops):
        function()
    return (time.process_time() - began) / loops


def machine() -> dict[str, str]:
    """Return what times were measured on."""
    return {
        "processor": _processor(),
        "cores": str(os.cpu_count()),
        "system": f"{platform.system()} {platform.machine()}",
        **software(),
    }


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return " ".join(line.partition(":")[2].split())
    except OSError:
        pass
    return platform.processor() or platform.machine()
