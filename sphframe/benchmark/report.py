"""Benchmark: all measurements in one report, from which tables and JSON are made."""

import contextlib
import dataclasses
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from typing import Any

import numba as typed_numba

from sphframe.benchmark.machine import OtherWork, machine
from sphframe.benchmark.memory import MemoryCost, measure_memory
from sphframe.benchmark.methods import MethodCost, measure_methods
from sphframe.benchmark.peak import Peak, measure_peak
from sphframe.benchmark.start_up import StartUp, measure_start_up
from sphframe.benchmark.steps import State, StepCost, measure_steps
from sphframe.benchmark.timing import Spread
from sphframe.benchmark.walls import WallCost, measure_walls
from sphframe.errors import InputError

numba: Any = typed_numba  # its settings have no types

SECTIONS = ("peak", "rest", "developed", "3d", "developed-3d", "methods", "walls", "memory", "start-up")
"""sections that can be chosen"""
_FLOWS: tuple[tuple[str, int, State], ...] = (
    ("rest", 2, "rest"), ("developed", 2, "developed"), ("3d", 3, "rest"), ("developed-3d", 3, "developed"),
)  # fmt: skip
_LONG = "developed-3d"
"""the section that is measured only if it is asked for"""
FORMAT = 1
_FEWEST, _MOST_DEVELOPED = 100, 50_000
_REPEATS = 7


@dataclass(frozen=True)
class BenchmarkReport:
    """All measurements, with the machine and the request."""

    machine: dict[str, str]
    particles: tuple[int, ...]
    threads: tuple[int, ...]
    peak: Peak | None = None
    steps: list[StepCost] = field(default_factory=list)
    methods: list[MethodCost] = field(default_factory=list)
    walls: list[WallCost] = field(default_factory=list)
    memory: list[MemoryCost] = field(default_factory=list)
    start_up: StartUp | None = None

    def as_data(self) -> dict[str, Any]:
        """Return all data for JSON: times in s, memory in bytes; each :class:`Spread` with its samples."""
        return {"format": FORMAT, **{f.name: _data(getattr(self, f.name)) for f in dataclasses.fields(self)}}


def _data(value: Any) -> Any:
    if isinstance(value, Spread):
        found = {"median": value.median, "min": value.minimum, "max": value.maximum}
        return {**found, "samples": list(value.samples)}
    if dataclasses.is_dataclass(value):
        return {f.name: _data(getattr(value, f.name)) for f in dataclasses.fields(value)}
    if isinstance(value, dict):
        return {name: _data(one) for name, one in value.items()}
    return [_data(one) for one in value] if isinstance(value, list | tuple) else value


def _machine() -> dict[str, str]:
    """The machine, and after a parallel loop has run also the threading layer."""
    found = {**machine(), "threads at most": str(numba.config.NUMBA_NUM_THREADS)}
    with contextlib.suppress(ValueError):
        found["threading layer"] = numba.threading_layer()
    return found


def check_request(particles: Sequence[int], threads: Sequence[int], only: Collection[str]) -> None:
    """Check the request before anything is measured.

    Raises
    ------
    InputError
        a number is out of bounds or a section is unknown.
    """
    for count in particles:
        if count < _FEWEST:
            raise InputError(f"particles = {count}: give at least {_FEWEST}, such as 45000")
    available = numba.config.NUMBA_NUM_THREADS
    for count in threads:
        if not 1 <= count <= available:
            raise InputError(f"threads = {count}, but this machine offers 1 to {available}")
    for name in only:
        if name not in SECTIONS:
            raise InputError(f"there is no section {name!r} to measure; the sections are {', '.join(SECTIONS)}")


def bench(
    particles: Sequence[int] = (45_000,),
    threads: Sequence[int] = (),
    only: Collection[str] = (),
    *,
    repeats: int = _REPEATS,
    tell: Callable[[str, float | None], None] = lambda text, part: None,
) -> BenchmarkReport:
    """Measure the speed, memory and start-up of sphframe on this machine.

    Parameters
    ----------
    particles
        numbers of fluid particles of the dam break, roughly.
    threads
        numbers of threads; by default 1 and, where there are as many, 2.
    only
        some of :data:`SECTIONS`; by default all but developed flow in 3-D, and developed flow up to 50,000 particles.
    repeats
        samples of each time.
    tell
        called with the name of the present measurement and the part of it that is done, if known.

    Raises
    ------
    InputError
        as :func:`check_request` does.
    """
    check_request(particles, threads, only)
    before, other = numba.get_num_threads(), OtherWork()
    counts = sorted(set(threads)) or [n for n in (1, 2) if n <= numba.config.NUMBA_NUM_THREADS]
    wanted = set(only) or {name for name in SECTIONS if name != _LONG}
    flows = [flow for flow in _FLOWS if flow[0] in wanted]
    try:
        tell("peak", None)
        peak = measure_peak(repeats) if "peak" in wanted else None
        steps = [
            cost
            for count in particles
            for name, dim, state in flows
            if state != "developed" or count <= _MOST_DEVELOPED or name in only
            for cost in measure_steps(count, dim, state, counts, repeats, tell)
        ]
        methods = [
            cost
            for count in particles
            for dim in (2, 3)
            if "methods" in wanted
            for cost in measure_methods(count, dim, repeats, tell)
        ]
        walls = [
            cost
            for count in particles
            if "walls" in wanted and (count <= _MOST_DEVELOPED or "walls" in only)
            for cost in measure_walls(count, repeats, tell)
        ]
        memory = []
        for count in particles if "memory" in wanted else ():
            for dim in (2, 3):
                tell(f"memory, {dim}-D, {count:,} particles", None)
                memory.append(measure_memory(count, dim))
        start_up = measure_start_up(repeats, tell) if "start-up" in wanted else None
    finally:
        numba.set_num_threads(before)
    found = {**_machine(), "processors that other programs used": other.in_words()}
    return BenchmarkReport(found, tuple(particles), tuple(counts), peak, steps, methods, walls, memory, start_up)
