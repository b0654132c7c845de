"""Benchmark: cost of each interpolation method, alone and within a step, on the same state."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from sphframe.arrays import Array
from sphframe.benchmark.flow import dam_break, warm_up
from sphframe.benchmark.stopwatch import Stopwatch
from sphframe.benchmark.timing import Spread, loops_for, seconds
from sphframe.cases import Case
from sphframe.interfaces import Status
from sphframe.registry import check
from sphframe.simulation import Simulation

_STEPS = 8
"""steps that are timed together, so that neighbour searches have their average share"""
_SHORTEST = 0.004
"""s: shortest time that is measured at once; the resolution of the clock is much smaller"""


@dataclass(frozen=True)
class Side:
    """Comparison of methods: times (methods, repeats) in s of filling all ghosts once and of one whole step.

    ``busy``: ratio of elapsed time to processor time.
    """

    simulations: Mapping[str, Simulation]
    fill: Array
    step: Array
    busy: float


@dataclass(frozen=True)
class MethodCost:
    """Processor times in s with one thread: ``fill`` all ghosts once, and a whole ``step``.

    ``point``: time of the interpolation to one wet point; ``share``: of the boundary in the time of a step.
    """

    method: str
    dimension: int
    particles: int
    points: int
    neighbours: float
    fill: Spread
    step: Spread
    point: Spread
    share: Spread


def side_by_side(
    cases: Mapping[str, Case], state: Mapping[str, Any], repeats: int, tell: Callable[[float], None]
) -> Side:
    """Time cases that differ in their boundary from the same ``state``, with one thread.

    Compilation and the first steps are not timed. The cases alternate in each repeat, so that other processes on
    the machine affect all of them equally. Times are processor times, which on an idle machine are the elapsed times.
    """
    simulations = {}
    for label, case in cases.items():
        simulation = Simulation(case, threads=1)
        simulation.restore(state)
        warm_up(simulation)
        simulations[label] = simulation
    fill = np.zeros((len(simulations), repeats))
    step = np.zeros((len(simulations), repeats))
    clock = time.process_time
    loops = {label: loops_for(s.system.fill_ghosts, _SHORTEST, clock) for label, s in simulations.items()}
    wall, processor = time.perf_counter(), time.process_time()
    for repeat in range(repeats):
        for k, (label, simulation) in enumerate(simulations.items()):
            fill[k, repeat] = seconds(simulation.system.fill_ghosts, loops[label], clock)
            step[k, repeat] = seconds(simulation.advance, _STEPS, clock)
        tell((repeat + 1) / repeats)
    busy = (time.perf_counter() - wall) / max(time.process_time() - processor, 1e-9)
    return Side(simulations, fill, step, busy)


def wet_points(simulation: Simulation) -> tuple[int, float]:
    """Number of wet ghosts and the mean number of particles within the support of their evaluation points."""
    boundary = simulation.boundary
    wet = boundary.points[boundary.statuses != Status.DRY]
    if not len(wet):
        return 0, 0.0
    tree = cKDTree(simulation.fields().position)
    return len(wet), float(np.mean(tree.query_ball_point(wet, simulation.support, return_length=True)))


def measure_methods(
    particles: int, dim: int, repeats: int, tell: Callable[[str, float | None], None]
) -> list[MethodCost]:
    """Measure all interpolation methods that are installed and load, on the dam break at rest in ``dim`` dimensions."""
    label = f"interpolation methods, {dim}-D, {particles:,} particles"
    tell(f"{label}: setting up", None)
    names = [entry.name for entry in check("interpolators") if entry.error is None]
    state = Simulation(dam_break(particles, dim), threads=1).state()
    cases = {name: dam_break(particles, dim, interpolator=name) for name in names}
    side = side_by_side(cases, state, repeats, lambda part: tell(f"{label}: measuring", part))
    costs = []
    for name, fill, step in zip(names, side.fill, side.step, strict=True):
        simulation = side.simulations[name]
        points, neighbours = wet_points(simulation)
        fills = _fills_of_a_step(simulation)
        filling, whole = Spread(tuple(map(float, fill))), Spread(tuple(map(float, step)))
        costs.append(
            MethodCost(
                name, dim, simulation.fluid_count, points, neighbours, filling, whole,
                filling.times(1.0 / points), filling.times(fills).over(whole),
            )
        )  # fmt: skip
    return costs


def _fills_of_a_step(simulation: Simulation) -> int:
    stopwatch = Stopwatch()
    stopwatch.watch(simulation.system, "fill_ghosts", "boundary")
    simulation.advance()
    return stopwatch.calls["fill_ghosts"]
