"""Benchmark: memory per particle, of the arrays and of the process."""

import contextlib
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from sphframe.benchmark.flow import dam_break, warm_up
from sphframe.benchmark.fresh import run_fresh
from sphframe.simulation import Simulation

_OWNERS = ("lists", "boundary")
"""parts of the system that are counted separately"""


@dataclass(frozen=True)
class MemoryCost:
    """Bytes per fluid particle.

    Attributes
    ----------
    arrays
        of all arrays of the system, the neighbour lists, the boundary, and the rest of the simulation.
    total
        their sum.
    resident
        growth of the process's peak resident set while it sets up and makes some steps, measured in a new
        process; None where the operating system does not report it. It is inaccurate for small cases, whose memory
        is small compared with that of any process.
    """

    dimension: int
    particles: int
    ghosts: int
    arrays: dict[str, float]
    total: float
    resident: float | None


def array_bytes(owner: object, counted: set[int] | None = None) -> int:
    """Bytes of all arrays that ``owner`` holds, in objects of sphframe and in containers.

    A view counts as the array that it views. ``counted`` holds the identities of the objects that were counted before;
    those counted here are added.
    """
    counted = set() if counted is None else counted
    if isinstance(owner, np.ndarray):
        while isinstance(owner.base, np.ndarray):
            owner = owner.base
    if id(owner) in counted:
        return 0
    counted.add(id(owner))
    if isinstance(owner, np.ndarray):
        return owner.nbytes
    if isinstance(owner, Mapping):
        return sum(array_bytes(value, counted) for value in owner.values())
    if isinstance(owner, list | tuple):
        return sum(array_bytes(value, counted) for value in owner)
    if type(owner).__module__.partition(".")[0] == "sphframe" and not isinstance(owner, type):
        return array_bytes(getattr(owner, "__dict__", {}), counted)
    return 0


def measure_memory(particles: int, dim: int) -> MemoryCost:
    """Measure the dam break of about ``particles`` particles in a new process."""
    code = "import json; from sphframe.benchmark.memory import measure_here"
    found: Any = run_fresh(f"{code}; print(json.dumps(measure_here({particles}, {dim})))").found
    return MemoryCost(**found)


def measure_here(particles: int, dim: int) -> dict[str, Any]:
    """Measure in this process."""
    warm_up(Simulation(dam_break(100, dim), threads=1))  # loads the loops, which take memory themselves
    _forget_peak()
    before = _resident("VmRSS")
    simulation = Simulation(dam_break(particles, dim), threads=1)
    warm_up(simulation)
    peak = _resident("VmHWM")
    n = simulation.fluid_count
    counted: set[int] = set()
    owned = {name: array_bytes(getattr(simulation.system, name), counted) for name in _OWNERS}
    owned["system"] = array_bytes(simulation.system, counted)
    owned["else"] = array_bytes(simulation, counted)
    return {
        "dimension": dim,
        "particles": n,
        "ghosts": simulation.ghost_count,
        "arrays": {name: size / n for name, size in owned.items()},
        "total": sum(owned.values()) / n,
        "resident": None if before is None or peak is None else (peak - before) / n,
    }


def _forget_peak() -> None:
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")  # see proc(5)


def _resident(key: str) -> int | None:
    """Bytes that Linux reports for this process under ``key``; None on other systems."""
    if sys.platform != "linux":
        return None
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith(f"{key}:"):
            return 1024 * int(line.split()[1])
    return None
