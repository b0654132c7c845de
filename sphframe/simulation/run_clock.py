"""Simulation: the time that a run has taken."""

import time
from typing import final


@final
class RunClock:
    """The wall-clock time and the processor time of all threads that a run has taken so far, s.

    Steps, samples, frames, checkpoints and hooks count; the set-up before the first step does not.
    """

    def __init__(self) -> None:
        self.set(0.0, 0.0)

    def set(self, wall: float, processor: float) -> None:
        """Go on from these times, s."""
        self._wall, self._processor = time.perf_counter() - wall, time.process_time() - processor

    @property
    def wall(self) -> float:
        """Wall-clock time, s."""
        return time.perf_counter() - self._wall

    @property
    def processor(self) -> float:
        """Processor time of all threads of this process, s."""
        return time.process_time() - self._processor
