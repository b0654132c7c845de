"""Benchmark: the machine and the software of a measurement, and what other programs did on the machine meanwhile."""

import os
import platform
import time
from pathlib import Path
from typing import final

import psutil

from sphframe.compiled import default_threads
from sphframe.output.provenance import software


def machine() -> dict[str, str]:
    """Return processor, cores, system and versions."""
    return {
        "processor": _processor(),
        "cores": f"{psutil.cpu_count()}, of which this process may use {default_threads()}",
        "system": f"{platform.system()} {platform.machine()}",
        **software(),
    }


@final
class OtherWork:
    """Measures how many processors other programs use, on average, from its making on."""

    def __init__(self) -> None:
        self._began = self._now()

    def processors(self) -> float:
        """Return the mean number of processors that other programs have used."""
        wall, busy, own = (now - then for now, then in zip(self._now(), self._began, strict=True))
        return max((busy - own) / wall, 0.0) if wall > 0.0 else 0.0

    def in_words(self) -> str:
        """Return that number, with what it means for times that were measured meanwhile."""
        number = self.processors()
        return f"{number:.2f}" + ("; the machine was not idle, and the times are longer than alone" * (number > 0.1))

    @staticmethod
    def _now() -> tuple[float, float, float]:
        """Wall-clock time, processor time of all programs, and that of this process and its children, s."""
        times, own = psutil.cpu_times(), os.times()
        busy = times.user + times.system + getattr(times, "nice", 0.0)
        return time.perf_counter(), busy, own.user + own.system + own.children_user + own.children_system


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return " ".join(line.partition(":")[2].split())
    except OSError:
        pass
    return platform.processor() or platform.machine()
