"""Speed of the parts of a step: `pytest tests/benchmark/test_speed.py -n0 --benchmark-enable`.

Without that option each part runs once, untimed.
"""

import pytest

from sphframe.benchmark.flow import dam_break, warm_up
from sphframe.benchmark.reference import BareLoops
from sphframe.simulation import Simulation

PARTICLES = 8000


@pytest.fixture(scope="module", params=[2, 3], ids=["2-D", "3-D"])
def simulation(request: pytest.FixtureRequest) -> Simulation:
    simulation = Simulation(dam_break(PARTICLES, request.param), threads=1)
    warm_up(simulation)
    return simulation


def test_step(benchmark, simulation: Simulation) -> None:  # type: ignore[no-untyped-def]
    benchmark(simulation.advance)


def test_evaluation(benchmark, simulation: Simulation) -> None:  # type: ignore[no-untyped-def]
    benchmark(simulation.system.evaluate, simulation.time)


def test_neighbour_lists(benchmark, simulation: Simulation) -> None:  # type: ignore[no-untyped-def]
    benchmark(simulation.system.find_neighbours)


def test_ghosts(benchmark, simulation: Simulation) -> None:  # type: ignore[no-untyped-def]
    benchmark(simulation.system.fill_ghosts)


def test_bare_reference_loops(benchmark) -> None:  # type: ignore[no-untyped-def]
    loops = BareLoops(Simulation(dam_break(PARTICLES, 2), threads=1))

    def both() -> None:
        loops.find_gradient()
        loops.find_rates()

    benchmark(both)
