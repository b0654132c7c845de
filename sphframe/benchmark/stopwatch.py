"""Benchmark: times of the parts of a step, measured without changes in the solver."""

import time
from collections import Counter
from collections.abc import Callable
from typing import Any

from sphframe.simulation import Simulation

PARTS = ("neighbour list", "boundary", "continuity", "momentum and gradient", "integration")
"""parts of a step; the density gradient is computed together with the accelerations; integration is all the rest"""


class Stopwatch:
    """Adds up the time of watched methods by named parts.

    The time of a method excludes that of the watched methods that it calls, which counts for their parts. So the sum
    of all parts is exactly the time of the outermost calls.

    Parameters
    ----------
    clock
        returns a time in ns.

    Attributes
    ----------
    spent
        time of each part, ns.
    calls
        number of calls of each watched method, by its name.
    """

    def __init__(self, clock: Callable[[], int] = time.perf_counter_ns) -> None:
        self.spent: Counter[str] = Counter()
        self.calls: Counter[str] = Counter()
        self._clock = clock
        self._within = 0

    def reset(self) -> None:
        """Set all times and counts to zero."""
        self.spent.clear()
        self.calls.clear()

    def watch(self, owner: object, method: str, part: str) -> None:
        """Add the time of ``owner.method`` to ``part``; only the method of this object is replaced."""
        function = getattr(owner, method)

        def timed(*arguments: Any, **named: Any) -> Any:
            before, self._within = self._within, 0
            began = self._clock()
            try:
                return function(*arguments, **named)
            finally:
                whole = self._clock() - began
                self.spent[part] += whole - self._within
                self.calls[method] += 1
                self._within = before + whole

        setattr(owner, method, timed)


def watch_steps(simulation: Simulation) -> Stopwatch:
    """Return a stopwatch on the parts of the steps of ``simulation``."""
    system, stopwatch = simulation.system, Stopwatch()
    stopwatch.watch(simulation, "advance", "integration")
    stopwatch.watch(system, "find_neighbours", "neighbour list")
    stopwatch.watch(system, "move_walls", "boundary")
    stopwatch.watch(system, "update_pressure", "integration")
    stopwatch.watch(system, "fill_ghosts", "boundary")
    stopwatch.watch(system, "evaluate_density", "continuity")
    stopwatch.watch(system, "evaluate_acceleration", "momentum and gradient")
    return stopwatch
