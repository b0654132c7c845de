"""Benchmark: times of repeated calls, with their scatter."""

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass

__all__ = ["Spread", "loops_for", "seconds"]


@dataclass(frozen=True)
class Spread:
    """Repeats of one measurement.

    Examples
    --------
    >>> found = Spread((3.0, 1.0, 2.0))
    >>> found.minimum, found.median, found.maximum
    (1.0, 2.0, 3.0)
    """

    samples: tuple[float, ...]

    @property
    def minimum(self) -> float:
        """The lowest."""
        return min(self.samples)

    @property
    def median(self) -> float:
        """The middle one."""
        return statistics.median(self.samples)

    @property
    def maximum(self) -> float:
        """The highest."""
        return max(self.samples)

    def over(self, other: "Spread") -> "Spread":
        """Return the ratios of samples that were taken together, on which noise cancels."""
        return Spread(tuple(a / b for a, b in zip(self.samples, other.samples, strict=True)))

    def plus(self, other: "Spread") -> "Spread":
        """Return the sums of samples that were taken together."""
        return Spread(tuple(a + b for a, b in zip(self.samples, other.samples, strict=True)))

    def times(self, factor: float) -> "Spread":
        """Return all samples times ``factor``."""
        return Spread(tuple(factor * a for a in self.samples))

    def inverse(self) -> "Spread":
        """Return one over each sample."""
        return Spread(tuple(1.0 / a for a in self.samples))


def seconds(function: Callable[[], object], loops: int = 1, clock: Callable[[], float] = time.perf_counter) -> float:
    """Time of one call by ``clock``, s, from ``loops`` calls at once."""
    began = clock()
    for _ in range(loops):
        function()
    return (clock() - began) / loops


def loops_for(function: Callable[[], object], shortest: float, clock: Callable[[], float] = time.perf_counter) -> int:
    """How often to call ``function`` at once, so that it takes at least about ``shortest`` s."""
    once = statistics.median(seconds(function, 1, clock) for _ in range(3))
    return max(1, round(shortest / max(once, 1e-7)))
