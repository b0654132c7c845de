"""Benchmark: time of a right-hand side and of its parts."""

import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numba

from sphframe.benchmark.flow import dam_break, run_to_developed_flow, warm_up
from sphframe.benchmark.reference import BareLoops
from sphframe.benchmark.stopwatch import PARTS, Stopwatch, watch_steps
from sphframe.benchmark.timing import Spread, loops_for, seconds
from sphframe.output import NetCDFWriter
from sphframe.simulation import Simulation
from sphframe.simulation.guards import check_traits

State = Literal["rest", "developed"]

_WINDOW = 0.4
"""s: intended time of a window of steps that are timed together"""
_FEWEST_STEPS, _MOST_STEPS = 12, 50
"""in a window: enough for the average share of neighbour searches, few enough that water at rest remains at rest"""
_SHORTEST = 0.02
"""s: shortest time that is measured at once; the resolution of the clock is much smaller"""


@dataclass(frozen=True)
class StepCost:
    """Times in s on one state with one number of threads; one sample of each per repeat.

    Attributes
    ----------
    evaluations
        of the rates per step.
    steps
        per window.
    builds
        of the neighbour lists per window.
    whole
        one step with its share of neighbour searches and output, the sum of the ``parts``; averages over a
        window of steps.
    rate
        fluid-particle right-hand sides per second, of the whole.
    list_build
        building the lists once.
    sample, frame
        writing one sample, one frame.
    evaluation
        all rates once, ghosts included, with its share of neighbour searches.
    bare_gradient, bare_rates
        the reference loops; None in 3-D.
    ratio
        evaluation over the sum of both; None in 3-D.
    """

    dimension: int
    state: State
    particles: int
    ghosts: int
    particle_spacing: float
    threads: int
    evaluations: int
    steps: int
    builds: int
    whole: Spread
    parts: dict[str, Spread]
    rate: Spread
    list_build: Spread
    sample: Spread
    frame: Spread
    evaluation: Spread
    bare_gradient: Spread | None
    bare_rates: Spread | None
    ratio: Spread | None


def measure_steps(
    particles: int,
    dim: int,
    state: State,
    threads: Sequence[int],
    repeats: int,
    tell: Callable[[str, float | None], None],
) -> list[StepCost]:
    """Measure the dam break of about ``particles`` particles with each number of ``threads``.

    Every window of steps starts from the same state, so all make the same steps and build the same lists. In each
    repeat the numbers of threads and the compared functions alternate, so that other processes on the machine affect
    all of them equally.
    """
    label = f"{dim}-D, {particles:,} particles"
    tell(f"{label}: setting up", None)
    case = dam_break(particles, dim)
    # the file has room for few frames; the cost of one is divided by the frame interval of the paper's preset
    simulation = Simulation(case.model_copy(update={"frame_interval": case.until}), threads=max(threads))
    warm_up(simulation)
    if state == "developed":
        run_to_developed_flow(simulation, lambda part: tell(f"{label}: running until the flow is developed", part))
    tell(f"{label}, {state}: measuring", 0.0)
    with tempfile.TemporaryDirectory(prefix="sphframe-bench-") as folder:
        bench = _Bench(simulation, case.frame_interval, Path(folder))
        for repeat in range(repeats):
            for count in threads:
                numba.set_num_threads(count)
                bench.sample(count)
            tell(f"{label}, {state}: measuring", (repeat + 1) / repeats)
        bench.close()
    return [bench.cost(count, state) for count in threads]


class _Bench:
    """The measurements on one state."""

    def __init__(self, simulation: Simulation, frame_interval: float, folder: Path) -> None:
        self.simulation = simulation
        self.evaluations: int = simulation.components.integrator.evaluations
        self.state = simulation.state()
        self.steps = min(max(round(_WINDOW / seconds(simulation.advance, 3)), _FEWEST_STEPS), _MOST_STEPS)
        self.watch: Stopwatch = watch_steps(simulation)
        self.builds = 0
        self.found: dict[int, dict[str, list[float]]] = {}
        self._frame_interval = frame_interval
        simulation.restore(self.state)
        self._writer = NetCDFWriter(folder / "bench.nc")
        self._writer.sphframe_run_started(simulation)
        bare = BareLoops(simulation) if simulation.case.dimension == 2 else None
        # the evaluation next to the loops with which it is compared; output last, as its libraries may keep threads
        # of their own busy for a while
        self._alone: dict[str, Callable[[], object]] = {
            "evaluation": lambda: simulation.system.evaluate(simulation.time)
        }
        if bare is not None:
            self._alone |= {"bare gradient": bare.find_gradient, "bare rates": bare.find_rates}
        self._alone |= {
            "list build": simulation.system.find_neighbours,
            "sample": lambda: self._writer.sphframe_probes_due(simulation),
            "frame": self._write_frame,
        }
        self._loops = {name: loops_for(function, _SHORTEST) for name, function in self._alone.items()}

    def close(self) -> None:
        self._writer.sphframe_run_finished(self.simulation)

    def sample(self, threads: int) -> None:
        """Take one sample of each measurement with the ``threads`` that are set."""
        found = self.found.setdefault(threads, {})
        self.simulation.restore(self.state)
        self.watch.reset()
        for _ in range(self.steps):
            self.simulation.advance()
        spent = {part: 1e-9 * self.watch.spent[part] / self.steps for part in PARTS}
        self.builds = self.watch.calls["find_neighbours"]
        alone = {name: seconds(function, self._loops[name]) for name, function in self._alone.items()}
        case, step = self.simulation.case, self.simulation.time_step
        output = step * (alone["sample"] / case.probe_interval + alone["frame"] / self._frame_interval)
        alone["evaluation"] += spent["neighbour list"] / self.evaluations
        for name, value in {**spent, "output": output, **alone}.items():
            found.setdefault(name, []).append(value)

    def _write_frame(self) -> None:
        simulation = self.simulation
        chosen = simulation.components
        check_traits(simulation.system, chosen.interpolator, chosen.kernel, simulation.case)
        self._writer.sphframe_frame_due(simulation)

    def cost(self, threads: int, state: State) -> StepCost:
        """Return the times of all samples with ``threads``."""
        simulation = self.simulation
        found = {name: Spread(tuple(values)) for name, values in self.found[threads].items()}
        parts = {part: found[part] for part in (*PARTS, "output")}
        whole = Spread(tuple(map(sum, zip(*(part.samples for part in parts.values()), strict=True))))
        gradient, rates = found.get("bare gradient"), found.get("bare rates")
        return StepCost(
            dimension=simulation.case.dimension,
            state=state,
            particles=simulation.fluid_count,
            ghosts=simulation.ghost_count,
            particle_spacing=simulation.case.particle_spacing,
            threads=threads,
            evaluations=self.evaluations,
            steps=self.steps,
            builds=self.builds,
            whole=whole,
            parts=parts,
            rate=whole.inverse().times(simulation.fluid_count * self.evaluations),
            list_build=found["list build"],
            sample=found["sample"],
            frame=found["frame"],
            evaluation=found["evaluation"],
            bare_gradient=gradient,
            bare_rates=rates,
            ratio=found["evaluation"].over(gradient.plus(rates)) if gradient and rates else None,
        )
