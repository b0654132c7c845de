"""Simulation: a running simulation of a case: its steps, its run loop, and the state from which it continues."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pluggy

from sphframe.arrays import Arrays
from sphframe.cases import Case
from sphframe.cases.placement import placed_scene
from sphframe.compiled import use_threads
from sphframe.errors import InputError, SimulationError
from sphframe.neighbours import LargestMotion
from sphframe.registry import load
from sphframe.simulation.components import Components
from sphframe.simulation.guards import check_state, check_time_step, check_traits
from sphframe.simulation.initial_state import initial_system, loop_parameters
from sphframe.simulation.interruption import Interruption, deferred_interruption
from sphframe.simulation.memory import check_memory
from sphframe.simulation.observation import Observation
from sphframe.simulation.plugin_errors import naming_component, naming_hook
from sphframe.simulation.run_clock import RunClock
from sphframe.simulation.saved_state import check_saved_state


class Simulation(Observation):
    """A running simulation of a case.

    Parameters
    ----------
    case
        what to simulate.
    threads
        threads of the compiled loops; by default all cores. The result has the same bits for any number.
    device
        where the steps are computed: ``"cpu"``, or the name of an installed device, such as ``"cuda"``.

    Attributes
    ----------
    time
        s.
    step
        number of steps made.
    time_step
        the last one, s.
    densities_outside
        particles whose density lies outside the band of the case's guards.
    samples, frames
        how many of each have been passed to the hooks.
    between_steps
        whether the state is one that :meth:`state` may save; false while a step is under way.
    initial_energy
        total energy at the start, J.

    Raises
    ------
    InputError
        when the case holds no fluid or no wall, contradicts itself, or holds what the device cannot compute.
    PluginError
        when a component or the device cannot be loaded.
    """

    def __init__(self, case: Case, *, threads: int | None = None, device: str = "cpu") -> None:
        self.threads = use_threads(threads)
        self.time = self.time_step = 0.0
        self.step = self.samples = self.frames = 0
        self.between_steps = True
        self._clock = RunClock()
        scene = placed_scene(case)
        check_memory(case, scene)
        with self._adding_time_and_step(), naming_component(case, running=False):
            kind = load("devices", device)
            kind.check_available()
            components = Components.of_case(case)
            parameters = loop_parameters(case, scene, components)
            system = initial_system(case, scene, components, parameters, kind)
        super().__init__(case, scene, components, system)
        self.initial_energy = sum(self.energies().values())
        self.densities_outside = 0
        self._motion = LargestMotion(0.0, 0.0)
        with self._adding_time_and_step():
            self._check()

    @property
    def wall_clock(self) -> float:
        """Wall-clock time of the run, output included, without the set-up and the time between resumes, s."""
        return self._clock.wall

    @property
    def processor_time(self) -> float:
        """Processor time of all threads in the same time, s."""
        return self._clock.processor

    # one step

    def advance(self) -> None:
        """Make one time step.

        Raises
        ------
        SimulationError
            when the guards find something wrong in the new state, or a component fails.
        """
        self.between_steps = False
        with self._adding_time_and_step():
            self.time_step = self._next_time_step(self._motion.speed)
            ahead = (1.2 + 0.5 * self.case.shifting) * self.time_step
            if not self.system.neighbours_remain_valid(self._motion, ahead):
                self.system.find_neighbours(self._motion.speed * self.time_step)
            with naming_component(self.case, running=True):
                self.components.integrator.step(self.system, self.time, self.time_step)
            self._shift(self._motion.speed, self.time_step)
            self.system.put_back()
            self.time = min(self.time + self.time_step, self.case.until)
            self.step += 1
            self._check()
            self.between_steps = True

    def _shift(self, speed: float, interval: float) -> None:
        """Shift the particles after a step of ``interval``, s, if the case asks for it; ``speed``: the largest, m/s."""
        if self.system.loops.shifting is not None:
            self.system.shift(speed, interval)

    def _next_time_step(self, speed: float) -> float:
        """Return the case's own time step, or that of the Courant number at the largest ``speed``, m/s."""
        case, integrator = self.case, self.components.integrator
        if case.time_step is not None:
            step = case.time_step
        else:
            courant = case.courant_number or integrator.courant_number
            step = courant * self.smoothing_length / (self.sound_speed + speed)
            check_time_step(step, courant * self.smoothing_length / self.sound_speed, speed)
            step = min(step, case.probe_interval)
            if case.kinematic_viscosity > 0.0:
                step = min(step, 0.125 * self.smoothing_length**2 / case.kinematic_viscosity)
        left = case.until - self.time
        return left if left < 1.0000001 * step else step

    def _check(self) -> None:
        """Check the new state, remove particles that have left the domain if the case says so, measure the motion."""
        tolerated = check_state(self.system, self.case, self._lower, self._upper, self.time_step)
        self.densities_outside = tolerated.densities_outside
        if tolerated.outside is not None:
            if np.all(tolerated.outside):
                raise SimulationError("all particles have left the domain; draw walls that hold the fluid")
            self.system.keep(~tolerated.outside)
            self.system.find_neighbours(self._motion.speed * self.time_step)
        self._motion = self.system.largest_motion()

    @contextmanager
    def _adding_time_and_step(self) -> Iterator[None]:
        """Add time and step to errors of the simulation; input that is found wrong in a step is such an error."""
        try:
            yield
        except InputError as error:
            if self.between_steps:
                raise
            failure = SimulationError(str(error))
            failure.time, failure.step = self.time, self.step
            raise failure from error
        except SimulationError as error:
            error.time, error.step = self.time, self.step
            raise

    # a whole run

    def run(self, manager: pluggy.PluginManager) -> None:
        """Run to the end of the case, and call the hooks of ``manager`` at each event.

        Raises
        ------
        SimulationError
            when the run goes wrong. The hooks are called with any error before it is raised here.
        """
        hook = manager.hook
        with deferred_interruption() as interruption:
            try:
                with self._adding_time_and_step(), naming_hook():
                    self._run(hook, interruption)
            except BaseException as error:
                hook.sphframe_run_failed(simulation=self, error=error)
                raise
            hook.sphframe_run_finished(simulation=self)

    def _run(self, hook: pluggy.HookRelay, interruption: Interruption) -> None:
        if self.step == 0:
            self._clock.set(0.0, 0.0)
        hook.sphframe_run_started(simulation=self)
        while True:
            if self._is_due(self.samples, self.case.probe_interval):
                hook.sphframe_probes_due(simulation=self)
                self.samples += 1
            if self._is_due(self.frames, self.case.frame_interval):
                chosen = self.components
                check_traits(self.system, chosen.interpolator, chosen.kernel, self.case, self.frames)
                hook.sphframe_frame_due(simulation=self)
                self.frames += 1
            if self.time >= self.case.until:
                return
            self.advance()
            hook.sphframe_step_completed(simulation=self)
            interruption.raise_if_asked()

    def _is_due(self, number: int, interval: float) -> bool:
        return self.time >= number * interval - 1e-9 * interval

    # what restarts a run

    def state(self) -> Arrays:
        """Return copies of all that the run depends on from here on, by name.

        A run that is restored from it has the same bits as one that continues. It holds the positions from which the
        neighbour lists were built in place of the lists: so a state can be taken after any step, and taking it changes
        nothing.
        """
        return {
            "clocks": np.array([self.time, self.time_step, self.wall_clock, self.processor_time, self.initial_energy]),
            "counters": np.array([self.step, self.samples, self.frames, self.densities_outside], np.int64),
            **self.system.state(),
        }

    def restore(self, state: Arrays) -> None:
        """Continue from what :meth:`state` of a simulation of the same case returned.

        Raises
        ------
        InputError
            when the state belongs to another case, or is damaged.
        """
        check_saved_state(state, self.state(), self.particle_count, self.ghost_count, self._lower, self._upper)
        self.system.restore(state)
        self._motion = self.system.largest_motion()
        self.time, self.time_step, wall, processor, self.initial_energy = map(float, state["clocks"])
        self._clock.set(wall, processor)
        self.step, self.samples, self.frames, self.densities_outside = map(int, state["counters"])
        self.between_steps = True
        self.system.set_body_force(self.time)
