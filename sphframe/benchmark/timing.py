"""Benchmark: times of repeated calls and their spread."""

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Spread:
    """The samples of a repeated measurement.

    Examples
    --------
    >>> found = Spread((3.0, 1.0, 2.0))
    >>> found.minimum, found.median, found.maximum
    (1.0, 2.0, 3.0)
    """

    samples: tuple[float, ...]

    @property
    def minimum(self) -> float:
        """The smallest sample."""
        return min(self.samples)

    @property
    def median(self) -> float:
        """The median of the samples."""
        return statistics.median(self.samples)

    @property
    def maximum(self) -> float:
        """The largest sample."""
        return max(self.samples)

    def over(self, other: "Spread") -> "Spread":
        """Return the ratios of samples that were taken together, in which common noise cancels."""
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
    """Return the mean time of one call in s, from ``loops`` calls that are timed together by ``clock``."""
    began = clock()
    for _ in range(loops):
        function()
    return (clock() - began) / loops


def loops_for(function: Callable[[], object], shortest: float, clock: Callable[[], float] = time.perf_counter) -> int:
    """Return a power of two: calls of ``function`` that take ``shortest`` s together by ``clock``, fine or coarse."""
    loops = 1
    while seconds(function, loops, clock) * loops < shortest:
        loops *= 2
    return loops
