"""The benchmark: relations between its results that hold for any times, and the results of its reference loops."""

import itertools
import json
import os
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from sphframe import Simulation
from sphframe.benchmark import SECTIONS, BenchmarkReport, bench, check_request, methods, start_up, steps, walls
from sphframe.benchmark import report as report_module
from sphframe.benchmark.flow import DEVELOPED, dam_break, run_to_developed_flow
from sphframe.benchmark.fresh import Fresh, run_fresh
from sphframe.benchmark.memory import array_bytes, measure_here
from sphframe.benchmark.methods import measure_methods
from sphframe.benchmark.peak import _multiply_add, _read, measure_peak
from sphframe.benchmark.reference import BareLoops
from sphframe.benchmark.stopwatch import PARTS, Stopwatch, watch_steps
from sphframe.benchmark.timing import Spread, loops_for, seconds
from sphframe.benchmark.walls import measure_walls
from sphframe.errors import InputError, SimulationError
from sphframe.registry import available

TINY = 300


@pytest.fixture(scope="module")
def report() -> BenchmarkReport:
    return bench([TINY], [1], ["rest"], repeats=3)


# the clock


class Nested:
    """Methods that read a clock, which advances by one tick per reading, and call each other."""

    def __init__(self, clock):  # type: ignore[no-untyped-def]
        self.clock = clock

    def outer(self) -> str:
        self.clock()
        self.inner()
        self.inner()
        return "done"

    def inner(self) -> None:
        self.clock()
        self.clock()

    def fails(self) -> None:
        self.inner()
        raise ValueError


def test_a_stopwatch_gives_each_part_its_own_time() -> None:
    ticks = itertools.count()
    nested = Nested(lambda: next(ticks))
    stopwatch = Stopwatch(lambda: next(ticks))
    stopwatch.watch(nested, "inner", "inside")
    stopwatch.watch(nested, "outer", "around")
    assert nested.outer() == "done"
    # a clock is read at both ends of a watched call: inner takes 3 ticks, outer 2 + 2 (3 + 1)
    assert stopwatch.spent == {"inside": 6, "around": 4}
    assert stopwatch.calls == {"inner": 2, "outer": 1}
    stopwatch.reset()
    assert not stopwatch.spent
    assert not stopwatch.calls


def test_the_time_of_a_call_that_fails_counts_only_for_that_call() -> None:
    ticks = itertools.count()
    nested = Nested(lambda: next(ticks))
    stopwatch = Stopwatch(lambda: next(ticks))
    stopwatch.watch(nested, "inner", "inside")
    stopwatch.watch(nested, "fails", "around")
    with pytest.raises(ValueError):  # noqa: PT011
        nested.fails()
    assert stopwatch.spent == {"inside": 3, "around": 2}


def test_a_watched_step_has_all_parts_and_the_same_bits() -> None:
    plain, watched = (Simulation(dam_break(TINY, 2), threads=1) for _ in range(2))
    stopwatch = watch_steps(watched)
    watched.system.find_neighbours()
    plain.system.find_neighbours()
    for _ in range(3):
        plain.advance()
        watched.advance()
    assert set(stopwatch.spent) == set(PARTS)
    assert all(spent > 0 for spent in stopwatch.spent.values())
    assert stopwatch.calls["advance"] == stopwatch.calls["evaluate_density"] == 3
    assert stopwatch.calls["fill_ghosts"] == 6
    np.testing.assert_array_equal(plain.system.rows, watched.system.rows)


def test_seconds_are_of_one_call_and_loops_fill_the_shortest_time() -> None:
    now = 0.0

    def work() -> None:
        nonlocal now
        now += 0.25

    assert seconds(work, 4, lambda: now) == 0.25
    assert loops_for(work, 1.0, lambda: now) == 4
    assert loops_for(work, 0.01, lambda: now) == 1
    assert loops_for(work, 1.0, lambda: now // 1.0) <= 8, "a clock that stands still for some calls"


def test_a_spread_compares_samples_that_were_taken_together() -> None:
    a, b = Spread((2.0, 4.0, 9.0)), Spread((1.0, 2.0, 3.0))
    assert a.over(b).samples == (2.0, 2.0, 3.0)
    assert (a.minimum, a.median, a.maximum) == (2.0, 4.0, 9.0)


# the flow and the reference loops


@pytest.mark.parametrize(("particles", "dim"), [(300, 2), (12_000, 2), (2000, 3)])
def test_a_dam_break_has_about_the_particles_asked_for(particles: int, dim: int) -> None:
    assert Simulation(dam_break(particles, dim), threads=1).fluid_count == pytest.approx(particles, rel=0.1)


def test_developed_flow_is_reached() -> None:
    simulation = Simulation(dam_break(TINY, 2), threads=1)
    told: list[float] = []
    run_to_developed_flow(simulation, told.append)
    assert simulation.time * np.sqrt(9.81 / 0.6) == pytest.approx(DEVELOPED, rel=1e-2)
    assert told == sorted(told)
    assert simulation.fields().position[:, 0].max() > 3.0  # at the right wall, 3.2 m


def test_the_bare_loops_compute_what_the_solver_computes() -> None:
    simulation = Simulation(dam_break(3000, 2), threads=1)
    while simulation.time < 0.3:
        simulation.advance()
    simulation.system.evaluate(simulation.time)
    loops = BareLoops(simulation)
    loops.find_gradient()
    loops.find_rates()
    solver = simulation.in_original_order(simulation.system.rates)[loops.order][:, 2:]
    np.testing.assert_allclose(loops.rates, solver, rtol=0.0, atol=1e-11 * np.abs(solver).max(axis=0).max())
    gradient = simulation.in_original_order(simulation.system.gradient)[loops.order]
    np.testing.assert_allclose(loops.gradient, gradient, rtol=0.0, atol=1e-11 * np.abs(gradient).max())
    assert 30.0 < loops.neighbours < 50.0


# the measurements


def test_the_parts_of_a_step_add_up(report: BenchmarkReport) -> None:
    (cost,) = report.steps
    assert set(cost.parts) == {*PARTS, "output"}
    for k, whole in enumerate(cost.whole.samples):
        assert sum(part.samples[k] for part in cost.parts.values()) == pytest.approx(whole, rel=1e-12)
        assert cost.rate.samples[k] * whole == pytest.approx(cost.particles * cost.evaluations, rel=1e-12)
        bare = cost.bare_gradient.samples[k] + cost.bare_rates.samples[k]  # type: ignore[union-attr]
        assert cost.ratio.samples[k] == pytest.approx(cost.evaluation.samples[k] / bare)  # type: ignore[union-attr]
    for name, part in cost.parts.items():
        assert len(part.samples) == 3
        assert part.minimum > 0.0 or name == "neighbour list"  # lists may remain valid for a whole window


def test_the_cost_of_output_per_step_follows_from_its_intervals(report: BenchmarkReport) -> None:
    (cost,) = report.steps
    case = dam_break(TINY, 2)
    for k, output in enumerate(cost.parts["output"].samples):
        per_second = cost.sample.samples[k] / 0.001 + cost.frame.samples[k] / 0.02  # intervals of the preset
        assert output == pytest.approx(case.time_step * per_second, rel=1e-9)  # type: ignore[operator]


def test_all_windows_make_the_same_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(steps, "_FEWEST_STEPS", steps._MOST_STEPS)  # for any speed
    first, second = (bench([TINY], [1], ["developed"], repeats=n).steps[0] for n in (1, 2))
    assert first.builds == second.builds > 0
    assert first.parts["neighbour list"].minimum > 0.0


def test_a_report_is_json(report: BenchmarkReport) -> None:
    data = json.loads(json.dumps(report.as_data()))
    assert data["format"] == 1
    parts = {"peak", "steps", "methods", "walls", "memory", "start_up"}
    assert set(data) == {"format", "machine", "particles", "threads", *parts}
    assert {"processor", "cores", "threading layer", "numba", "python"} <= set(data["machine"])
    (cost,) = data["steps"]
    assert (cost["state"], cost["dimension"], cost["threads"]) == ("rest", 2, 1)
    assert cost["particles"] == report.steps[0].particles
    whole = cost["whole"]
    assert whole["min"] <= whole["median"] <= whole["max"]
    assert sorted(whole["samples"]) == [whole["min"], whole["median"], whole["max"]]
    assert cost["rate"]["median"] == pytest.approx(cost["particles"] / whole["median"])
    assert (data["methods"], data["walls"], data["memory"], data["start_up"]) == ([], [], [], None)


def test_all_installed_methods_that_load_are_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    two = [entry for entry in available("interpolators") if entry.name in ("improved-shepard", "mls-linear")]
    broken = SimpleNamespace(name="broken", error="it does not load")
    monkeypatch.setattr(methods, "check", lambda kind: [*two, broken])
    told: list[str] = []
    costs = measure_methods(TINY, 2, 2, lambda text, part: told.append(text))
    assert [cost.method for cost in costs] == [entry.name for entry in two]
    for cost in costs:
        assert cost.dimension == 2
        assert cost.points > 0
        assert 5.0 < cost.neighbours < 40.0
        assert cost.point.median == pytest.approx(cost.fill.median / cost.points)
        assert cost.share.samples == tuple(
            pytest.approx(2.0 * fill / step) for fill, step in zip(cost.fill.samples, cost.step.samples, strict=True)
        )
    assert told


def test_wall_treatments_are_compared_with_fixed_ghosts_on_the_same_fluid(monkeypatch: pytest.MonkeyPatch) -> None:
    two = [entry for entry in available("wall_treatments") if entry.name in ("fixed-ghosts", "monaghan-kajtar-2009")]
    monkeypatch.setattr(walls, "check", lambda kind: two)
    ghosts, row = measure_walls(TINY, 2, lambda text, part: None)
    assert (ghosts.treatment, row.treatment) == tuple(entry.name for entry in two)
    assert ghosts.ratio.samples == (1.0, 1.0)
    assert row.ratio.samples == row.evaluation.over(ghosts.evaluation).samples
    assert row.wall_particles < ghosts.wall_particles


# memory


def test_arrays_are_counted_once() -> None:
    array = np.zeros(100)
    assert array_bytes({"a": array, "again": array, "view": array[:10].reshape(2, 5), "b": [np.zeros(5)]}) == 840
    assert array_bytes({"text": "no array", "number": 3.0}) == 0
    assert array_bytes(array[3:5]) == 800


def test_memory_per_particle() -> None:
    found = measure_here(TINY, 2)
    simulation = Simulation(dam_break(TINY, 2), threads=1)
    n, system, lists = simulation.fluid_count, simulation.system, simulation.system.lists
    assert found["particles"] == n
    assert found["total"] == pytest.approx(sum(found["arrays"].values()))
    assert found["arrays"]["system"] * n >= system.rows.nbytes + system.rates.nbytes + system.gradient.nbytes
    assert found["arrays"]["lists"] * n >= lists.fluid.nbytes + lists.points.nbytes
    assert found["arrays"]["system"] < 1e3  # the lists and the boundary, which it refers to, are not counted again
    assert min(found["arrays"].values()) > 0.0


# start-up


def test_a_new_process_returns_what_it_prints() -> None:
    fresh = run_fresh("import json, os; print('noise'); print(json.dumps([1.5, os.environ['GIVEN']]))", {"GIVEN": "x"})
    assert fresh.found == [1.5, "x"]
    assert fresh.seconds > 0.0
    with pytest.raises(SimulationError, match="no such thing"):
        run_fresh("raise ValueError('no such thing')")


def test_start_up_compiles_into_an_empty_cache_that_is_used_afterwards(monkeypatch: pytest.MonkeyPatch) -> None:
    caches: list[str] = []

    def answer(code: str, environment: dict[str, str] | None = None) -> Fresh:
        if environment is None:
            return Fresh([0.5, 0.1], 1.0)
        cache = environment["NUMBA_CACHE_DIR"]
        caches.append(cache)
        was_empty = not os.listdir(cache)
        (Path(cache) / "loop.nbi").touch()
        return Fresh(20.0 if was_empty else 2.0, 3.0)

    monkeypatch.setattr(start_up, "run_fresh", answer)
    found = start_up.measure_start_up(2, lambda text, part: None)
    assert found.first_compile == 20.0
    assert found.cached.samples == (2.0, 2.0)
    assert found.cached_process.samples == (3.0, 3.0)
    assert (found.libraries.median, found.sphframe.median) == (0.5, 0.1)
    assert len(set(caches)) == 1
    assert not Path(caches[0]).exists()


def test_the_programs_of_start_up_run_in_new_processes() -> None:
    libraries, own = run_fresh(start_up._IMPORTS).found
    assert libraries > 0.0
    assert own > 0.0
    assert run_fresh(start_up._FIRST_STEP, {"NUMBA_NUM_THREADS": "1"}).found > 0.0


# checks of the request


@pytest.mark.parametrize(
    ("particles", "threads", "only", "message"),
    [
        ([10], [1], [], "particles = 10"),
        ([3000, -1], [1], [], "particles = -1"),
        ([3000], [0], [], "threads = 0"),
        ([3000], [100_000], [], "threads = 100000"),
        ([3000], [1], ["rest", "speed"], "'speed'"),
    ],
)
def test_a_request_out_of_bounds_is_refused(
    particles: list[int], threads: list[int], only: list[str], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        check_request(particles, threads, only)


def test_every_section_can_be_asked_for() -> None:
    check_request([3000], [1], SECTIONS)


@pytest.mark.parametrize(
    ("particles", "only", "measured"),
    [
        (3000, (), [(2, "rest"), (2, "developed"), (3, "rest")]),
        (60_000, (), [(2, "rest"), (3, "rest")]),
        (60_000, ("developed", "3d"), [(2, "developed"), (3, "rest")]),
        (60_000, ("developed-3d",), [(3, "developed")]),
    ],
)
def test_developed_flow_of_many_particles_and_in_space_is_measured_if_it_is_asked_for(
    particles: int, only: tuple[str, ...], measured: list[tuple[int, str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    found: list[tuple[int, str]] = []
    monkeypatch.setattr(report_module, "measure_steps", lambda count, *flow: found.append(flow[:2]) or [])
    for name in ("measure_methods", "measure_walls"):
        monkeypatch.setattr(report_module, name, lambda *given: [])
    for name in ("measure_peak", "measure_memory", "measure_start_up"):
        monkeypatch.setattr(report_module, name, lambda *given: None)
    bench([particles], [1], only)
    assert found == measured


# peak


def test_peak_does_the_arithmetic_that_it_times():
    # every chain x -> x/2 + 1 tends to 2, and the sum of what is read is that of the array
    assert _multiply_add(100) == pytest.approx(2.0 * 128)
    assert _read(np.arange(256.0).reshape(2, 128)) == sum(range(256))


def test_peak_has_one_sample_per_repeat():
    peak = measure_peak(2)
    assert len(peak.multiply_adds.samples) == len(peak.bytes_read.samples) == 2
    assert min(*peak.multiply_adds.samples, *peak.bytes_read.samples) > 0.0
