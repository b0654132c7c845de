"""Benchmark: cost of each wall treatment, in all rates of the developed dam break."""

import time
from collections.abc import Callable
from dataclasses import dataclass

from sphframe.benchmark.flow import dam_break, run_to_developed_flow, warm_up
from sphframe.benchmark.timing import Spread, loops_for, seconds
from sphframe.registry import check
from sphframe.simulation import Simulation

_OF_FLUID = ("ids", "rates", "gradient", "lists.fluid")
_DEFAULT = "fixed-ghosts"
_SHORTEST = 0.02
"""s: shortest time that is measured at once"""


@dataclass(frozen=True)
class WallCost:
    """Processor times in s of all rates once, walls included, with one thread; ``ratio``: over that of fixed ghosts."""

    treatment: str
    particles: int
    wall_particles: int
    evaluation: Spread
    ratio: Spread


def measure_walls(particles: int, repeats: int, tell: Callable[[str, float | None], None]) -> list[WallCost]:
    """Measure all wall treatments that are installed and load, on the same fluid of the two-dimensional dam break.

    The flow is developed with fixed ghosts. Treatments alternate in each repeat, so that other processes on the machine
    affect all of them equally. The time step is left out: it would be the same, and some treatments do not get far.
    """
    label = f"wall treatments, {particles:,} particles"
    tell(f"{label}: setting up", None)
    flow = Simulation(dam_break(particles, 2), threads=1)
    warm_up(flow)
    run_to_developed_flow(flow, lambda part: tell(f"{label}: running until the flow is developed", part))
    developed, n = flow.system.state(), flow.fluid_count
    simulations = {}
    for entry in check("wall_treatments"):
        if entry.error is None:
            simulation = Simulation(dam_break(particles, 2, wall_treatment=entry.name), threads=1)
            state = {**simulation.system.state(), **{name: developed[name] for name in _OF_FLUID}}
            state["rows"][:n] = developed["rows"][:n]
            simulation.system.restore(state)
            simulation.system.find_neighbours()  # with an order of particles of its own
            simulation.system.evaluate(flow.time)
            simulations[entry.name] = simulation
    rates = {name: lambda system=s.system: system.evaluate(flow.time) for name, s in simulations.items()}
    clock = time.process_time
    loops = {name: loops_for(function, _SHORTEST, clock) for name, function in rates.items()}
    samples: dict[str, list[float]] = {name: [] for name in rates}
    for repeat in range(repeats):
        for name, function in rates.items():
            samples[name].append(seconds(function, loops[name], clock))
        tell(f"{label}: measuring", (repeat + 1) / repeats)
    found = {name: Spread(tuple(values)) for name, values in samples.items()}
    return [
        WallCost(name, n, simulations[name].ghost_count, spread, spread.over(found[_DEFAULT]))
        for name, spread in found.items()
    ]
