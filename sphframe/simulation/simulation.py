"""Simulation: from a case to its state, step by step."""

import math
import time as clock
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numba
import numpy as np
import pluggy
from numpy.typing import NDArray

from sphframe.boundary.boundary import Boundary
from sphframe.boundary.operator import compiled_kernel
from sphframe.cases import Case, Fields, Scene
from sphframe.compiled import LANES, compile_part, specialise
from sphframe.errors import InputError, SimulationError
from sphframe.geometry import lattice, lattice_cell, wall_panels
from sphframe.interfaces import EquationOfState, Kernel, Motion, Status
from sphframe.neighbours import NeighbourLists
from sphframe.particles import Columns
from sphframe.physics import invert_pressure, sample_points
from sphframe.registry import COMPONENT_KINDS
from sphframe.simulation.guards import check_promises, check_time_step, naming_component, naming_hook, watch
from sphframe.simulation.interruption import Interruption, deferred_interruption
from sphframe.simulation.probes import Gauges, PressureProbes
from sphframe.simulation.rest_state import rest_pressure
from sphframe.simulation.system import FluidSystem, Parameters

__all__ = ["Simulation"]

Array = NDArray[np.float64]

SKIN = 0.1
"""skin of the neighbour lists over the kernel support"""


class Simulation:
    """A case in motion.

    Parameters
    ----------
    case: what to simulate.
    threads: threads of the compiled loops; by default all cores. The result has the same bits for any number.

    Attributes
    ----------
    case, scene: what is simulated. ``components``: the kernel, equation of state, interpolator and integrator.
    time: s; ``step``: number of steps made; ``time_step``: the last one, s.
    particle_count: fluid particles at the start; ``fluid_count``: those that are left.
    densities_outside: particles whose density lies outside the band of the case's guards.
    samples, frames: how many of each the listeners have been told of.
    between_steps: whether the state is one that :meth:`state` may save; false while a step is under way.
    sound_speed: m/s; ``smoothing_length``, ``support``: m.

    Raises
    ------
    InputError: when the case holds no fluid or no wall, or contradicts itself.
    PluginError: when a component cannot be had.
    """

    def __init__(self, case: Case, *, threads: int | None = None) -> None:
        self.case = case
        self.scene: Scene = case.scene()
        self.threads = _use_threads(threads)
        self.components: dict[str, Any] = {
            field: getattr(case, field).create(kind) for field, kind in COMPONENT_KINDS.items()
        }
        shape, state = self.components["kernel"], self.components["equation_of_state"]
        self.time = self.time_step = self.wall_clock = 0.0
        self.step = 0
        with self._dating_errors(), naming_component(case, running=False):
            self._set_up(shape, state)

    def _set_up(self, shape: Kernel, state: EquationOfState) -> None:
        case, dim, spacing = self.case, self.case.dimension, self.case.particle_spacing
        kernel = compiled_kernel(shape, dim)
        self.sound_speed = case.reference_sound_speed(self.scene.depth)
        self.parameters = Parameters(
            dim=dim,
            kernel=kernel,
            smoothing_length=case.smoothing_length_ratio * spacing,
            reference_density=case.reference_density,
            sound_speed=self.sound_speed,
            gravity=case.gravity,
            density_diffusion=case.density_diffusion,
            artificial_viscosity=case.artificial_viscosity,
        )
        self.smoothing_length, self.support = self.parameters.smoothing_length, self.parameters.support
        self.columns = Columns(dim)

        lattices = [lattice(region, spacing) for region in self.scene.fluid]
        position = np.vstack(lattices)
        volumes = [
            np.full(len(part), np.prod(lattice_cell(region, spacing)))
            for part, region in zip(lattices, self.scene.fluid, strict=True)
        ]
        _check_scene(self.scene, position, dim)
        self.boundary = Boundary(
            self.scene.walls,
            self.scene.bodies,
            self.components["interpolator"],
            kernel,
            state,
            spacing=spacing,
            support=self.support,
            no_slip=case.slip == "no",
            balanced=case.hydrostatic_lift == "balanced",
            corrected=case.ghost_velocity == "corrected",
        )
        self.particle_count = self.fluid_count = len(position)
        self.ghost_count = self.boundary.count
        self.lists = self._new_lists()
        rows = self._initial_rows(position, np.concatenate(volumes), compile_part(state.density_function()))
        self.system = FluidSystem(rows, self.fluid_count, self.boundary, self.lists, kernel, state, self.parameters)
        self._ids = np.arange(self.fluid_count)
        self._reference = np.zeros((self.fluid_count, dim))
        self._speed = self._moved = 0.0
        self._stale = True
        self._lower, self._upper = (np.array(corner, dtype=np.float64) for corner in self.scene.domain)
        sample = specialise(sample_points, {"DIM": dim, "SUPPORT": kernel.support, "VALUE": kernel.value})
        self._probes = PressureProbes(self.scene.probes, dim)
        self._gauges = Gauges(self.scene.gauges, self._lower, self._upper, 0.25 * spacing)
        self._sample = sample
        self._panels = wall_panels(self.scene.walls, spacing)

        self.densities_outside = 0
        self.samples = self.frames = 0
        self.between_steps = True
        self.system.move_walls(0.0)
        self._find_neighbours()
        self.system.evaluate(0.0)
        self.initial_energy = sum(self.energies().values())
        self._watch()

    def _initial_rows(self, position: Array, volumes: Array, density: Any) -> Array:
        case, columns = self.case, self.columns
        if self.scene.initial_pressure is not None:
            pressure = self.scene.initial_pressure(position)
        else:
            surface = max(region.upper[-1] for region in self.scene.fluid)
            pressure = rest_pressure(
                surface - position[:, -1], density, case.reference_density, self.sound_speed, case.gravity
            )
        rows = columns.empty(self.fluid_count + self.ghost_count)
        n, ghost_volume = self.fluid_count, case.particle_spacing**case.dimension
        rows[:n, columns.position] = position
        rows[:n, columns.pressure] = pressure
        invert = specialise(invert_pressure, {"DIM": case.dimension, "DENSITY": density}, parallel=False)
        invert(rows, n, case.reference_density, self.sound_speed)
        rows[:n, columns.volume] = volumes
        rows[:n, columns.mass] = rows[:n, columns.density] * volumes
        rows[n:, columns.density] = case.reference_density
        rows[n:, columns.volume] = ghost_volume
        rows[n:, columns.mass] = case.reference_density * ghost_volume
        rows[n:, columns.position] = self.boundary.position
        return rows

    # one step

    def advance(self) -> None:
        """Make one time step.

        Raises
        ------
        SimulationError: when the guards find something wrong in the new state, or a component fails.
        """
        began = clock.perf_counter()
        with self._dating_errors():
            self.time_step = self._next_time_step(self._speed)
            if not self._lists_last(1.2 * self.time_step):
                self._find_neighbours()
            self.between_steps = False
            with naming_component(self.case, running=True):
                self.components["integrator"].step(self.system, self.time, self.time_step)
            self.system.put_back(self.case.particle_spacing)
            self.time = min(self.time + self.time_step, self.case.until)
            self.step += 1
            self._stale = True
            self._watch()
            self.between_steps = True
        self.wall_clock += clock.perf_counter() - began

    @contextmanager
    def _dating_errors(self) -> Iterator[None]:
        """Tell errors when they happened."""
        try:
            yield
        except SimulationError as error:
            error.time, error.step = self.time, self.step
            raise

    def _watch(self) -> None:
        """Look at the new state; remove the particles that have left the domain, if the case says so."""
        seen = watch(self.system, self._reference, self._ids, self.case, self._lower, self._upper)
        self._speed, self._moved, self.densities_outside = seen.speed, seen.moved, seen.densities
        if seen.outside is not None:
            self._remove(seen.outside)

    def _lists_last(self, interval: float) -> bool:
        """Whether the neighbour lists stay complete if everything keeps its speed for ``interval``, s."""
        walls = self.boundary.displacement + self.boundary.speed * interval
        return self.lists.last(self.system.rows, self._reference, self._moved, walls, self._speed * interval)

    def _next_time_step(self, speed: float) -> float:
        case, integrator = self.case, self.components["integrator"]
        if case.time_step is not None:
            step = case.time_step
        else:
            courant = case.courant_number or integrator.courant_number
            step = courant * self.smoothing_length / (self.sound_speed + speed)
            check_time_step(step, courant * self.smoothing_length / self.sound_speed, speed)
            step = min(step, case.probe_interval)
        left = case.until - self.time
        return left if left < 1.0000001 * step else step

    def _remove(self, gone: NDArray[np.bool_]) -> None:
        """Go on without the particles that are ``gone`` (n,)."""
        if np.all(gone):
            raise SimulationError("all particles have left the domain; draw walls that hold the fluid")
        kept = ~gone
        self._resize(int(kept.sum()))
        self.system.keep(kept, self.lists)
        self._ids = self._ids[kept]
        self._find_neighbours()

    def _resize(self, fluid_count: int) -> None:
        self.fluid_count = fluid_count
        self.lists = self._new_lists()
        self._reference = np.zeros((fluid_count, self.case.dimension))

    def _new_lists(self) -> NeighbourLists:
        dim, spacing = self.case.dimension, self.case.particle_spacing
        return NeighbourLists(
            dim,
            self.fluid_count,
            self.ghost_count,
            self.support,
            SKIN * self.support,
            cluster=LANES,
            width=0.75 * LANES ** (1.0 / dim) * spacing,
        )

    @property
    def removed_count(self) -> int:
        """Number of particles that have left the domain and were removed."""
        return self.particle_count - self.fluid_count

    # what restarts a run

    def state(self) -> dict[str, Array]:
        """Return copies of all that the run depends on from here on, by name.

        A run that is restored from it has the same bits as one that goes on. The neighbour lists are not among it, but
        the positions that they were made for are: so a state can be taken after any step, and taking it changes
        nothing.
        """
        clocks = [self.time, self.time_step, self.wall_clock, self.initial_energy, self._speed, self._moved]
        counters = [self.step, self.samples, self.frames, self.densities_outside]
        parts = {"system": self.system.state(), "boundary": self.boundary.state()}
        return {
            "clocks": np.array(clocks),
            "counters": np.array(counters, np.int64),
            "ids": self._ids.copy(),
            "reference": self._reference.copy(),
            **{f"{part}.{name}": array for part, arrays in parts.items() for name, array in arrays.items()},
        }

    def restore(self, state: Mapping[str, Array]) -> None:
        """Continue from what :meth:`state` of a simulation of the same case returned.

        Raises
        ------
        InputError: when the state belongs to another case.
        """
        count = len(state.get("ids", ()))
        own = {name: array.shape for name, array in self.state().items()}
        wanted = {name: _with_count(shape, name, count, self.ghost_count) for name, shape in own.items()}
        if {name: array.shape for name, array in state.items()} != wanted or not 0 < count <= self.particle_count:
            raise InputError("the saved state belongs to another case: its particles, walls or bodies differ")
        ids, reference = state["ids"], state["reference"]
        finite = all(np.all(np.isfinite(array)) for array in state.values())
        numbered = ids.min() >= 0 and ids.max() < self.particle_count and len(np.unique(ids)) == count
        if not (finite and numbered and np.all((reference >= self._lower) & (reference <= self._upper))):
            raise InputError("the saved state is damaged: its numbers are not those of particles in the domain")
        if count != self.fluid_count:
            kept = np.arange(self.fluid_count) < count
            self._resize(count)
            self.system.keep(kept, self.lists)
        parts: dict[str, dict[str, Array]] = {"system": {}, "boundary": {}}
        for name, array in state.items():
            part, dot, inner = name.partition(".")
            if dot:
                parts[part][inner] = array
        self.boundary.restore(parts["boundary"])
        self._ids = np.array(state["ids"])
        self._reference = np.array(state["reference"])
        rows, n = self.system.rows, self.fluid_count
        ghosts, points = self.boundary.remembered
        rows[:n, self.columns.position] = self._reference
        rows[n:, self.columns.position] = ghosts
        self.lists.sort(rows)  # they are in order, but the grid is wanted
        self.lists.build(rows, points)
        self.system.restore(parts["system"])
        self.time, self.time_step, self.wall_clock, self.initial_energy, self._speed, self._moved = (
            float(value) for value in state["clocks"]
        )
        self.step, self.samples, self.frames, self.densities_outside = (int(value) for value in state["counters"])
        self._stale = True
        self.between_steps = True

    def _find_neighbours(self) -> None:
        """Put the particles in spatial order and list their neighbours."""
        rows, n = self.system.rows, self.fluid_count
        order = self.lists.sort(rows)
        self.system.put_in_order(order)
        self._ids = self._ids[order]
        self.lists.build(rows, self.boundary.points)
        self._reference[:] = rows[:n, self.columns.position]
        self.boundary.remember()

    # what can be looked at

    def _refresh(self) -> None:
        """Pressures of the present state: within a step they belong to a stage of the integrator."""
        if self._stale:
            self.system.update_pressure()
            self._stale = False

    def _fluid(self) -> Fields:
        self._refresh()
        fluid, columns = self.system.rows[: self.fluid_count], self.columns
        return Fields(
            fluid[:, columns.position],
            fluid[:, columns.velocity],
            fluid[:, columns.density],
            fluid[:, columns.pressure],
        )

    def fields(self) -> Fields:
        """Copies of the fluid's fields in the particles' original order; NaN for removed particles."""
        return Fields(*map(self._in_original_order, self._fluid()))

    def masses(self) -> Array:
        """Mass of each particle in the original order, kg (per metre of width in 2-D); NaN for removed particles."""
        return self._in_original_order(self.system.rows[: self.fluid_count, self.columns.mass])

    def _in_original_order(self, values: Array) -> Array:
        ordered = np.full((self.particle_count, *values.shape[1:]), np.nan)
        ordered[self._ids] = values
        return ordered

    @property
    def ghosts(self) -> Boundary:
        """The ghosts: ``position`` and ``mirror`` (g, dim) at present, ``statuses`` (g,)."""
        return self.boundary

    def ghost_fields(self) -> Fields:
        """Copies of the ghosts' fields as last filled."""
        ghosts, columns = self.system.rows[self.fluid_count :], self.columns
        return Fields(
            ghosts[:, columns.position].copy(),
            ghosts[:, columns.velocity].copy(),
            ghosts[:, columns.density].copy(),
            ghosts[:, columns.pressure].copy(),
        )

    def sample(self, points: Array) -> tuple[Array, Array]:
        """Pressure (Pa, 0 where dry) and filling (1 inside the fluid) at ``points`` (k, dim)."""
        self._refresh()
        p = self.parameters
        lists, counts = self.lists.around(points, self.system.rows)
        pressures, fillings = np.zeros(len(points)), np.zeros(len(points))
        self._sample(
            points, self.system.rows, lists, counts, p.support, p.kernel_scale, p.reference_density * p.gravity,
            pressures, fillings,
        )  # fmt: skip
        return pressures, fillings

    def probe_pressures(self) -> Array:
        """Pressure at each probe, Pa."""
        return self._probes.average(self.sample(self._probes.points)[0])

    def gauge_elevations(self) -> Array:
        """Elevation of the free surface at each gauge, m; NaN where dry."""
        return self._gauges.elevations(self.sample(self._gauges.points)[1])

    def energies(self) -> dict[str, float]:
        """Kinetic, potential and internal energy of the fluid, J (per metre of width in 2-D), summed in one thread.

        The potential energy is measured from z = 0; the internal energy is p^2 V / (2 rho c0^2), its leading order.
        """
        fields = self._fluid()
        mass = self.system.rows[: self.fluid_count, self.columns.mass]
        compliance = mass / (fields.density**2 * self.sound_speed**2)
        return {
            "kinetic": 0.5 * float(np.einsum("i,ij,ij->", mass, fields.velocity, fields.velocity)),
            "potential": self.case.gravity * float(np.einsum("i,i->", mass, fields.position[:, -1])),
            "internal": 0.5 * float(np.einsum("i,i,i->", compliance, fields.pressure, fields.pressure)),
        }

    def diagnostics(self) -> dict[str, float]:
        """The case's own diagnostics."""
        fields = self._fluid()
        return {d.name: d.function(self._seen_from(d.body, fields)) for d in self.scene.diagnostics}

    def _seen_from(self, body: str | None, fields: Fields) -> Fields:
        """Put positions into the frame in which ``body`` was drawn."""
        if body is None:
            return fields
        index = list(self.boundary.bodies).index(body)
        position = _in_frame(fields.position, self.system.motions[index], self.boundary.centres[index])
        return fields._replace(position=position)

    def particles_outside(self) -> int:
        """Number of particles behind a wall."""
        position = self.system.rows[: self.fluid_count, self.columns.position]
        outside = np.zeros(self.fluid_count, dtype=np.bool_)
        for wall, body in zip(self.scene.walls, self.boundary.wall_body, strict=True):
            if body >= 0:
                drawn = _in_frame(position, self.system.motions[body], self.boundary.centres[body])
            else:
                drawn = position
            outside |= wall.is_behind(drawn)
        return int(outside.sum())

    def status_counts(self) -> NDArray[np.int64]:
        """Number of ghosts by :class:`Status` at the last evaluation."""
        return np.bincount(self.boundary.statuses, minlength=len(Status))

    def body_motions(self) -> dict[str, Motion]:
        """Motion of each body at present."""
        system = self.system
        motions = {}
        for k, (name, body) in enumerate(self.boundary.bodies.items()):
            motions[name] = system.motions[k]
            if body.needs_load:  # its motion was asked for within the step, before the integrator completed it
                advanced = {"position": system.body_position[k].copy(), "velocity": system.body_velocity[k].copy()}
                motions[name] = motions[name]._replace(**advanced)
        return motions

    def wall_forces(self) -> dict[str, tuple[Array, Array]]:
        """Force on each wall, N (per metre of width in 2-D), by the ghosts' reaction and by integrated pressure.

        Above the water, where the kernel average still reaches it, the lifted pressure is negative: it is left out.
        """
        self._refresh()
        self.system.find_loads()
        centre, area = self._panels.centre.copy(), self._panels.area.copy()
        for index, body in enumerate(self.boundary.wall_body):
            if body >= 0:
                own = self._panels.wall == index
                motion, pivot = self.system.motions[body], self.boundary.centres[body]
                centre[own] = _from_frame(centre[own], motion, pivot)
                area[own] = _from_frame(area[own], motion, None)
        pressure, filling = self.sample(centre)
        pressure[(filling < 0.4) & (pressure < 0.0)] = 0.0  # within the water a wall's filling is one half
        forces = pressure[:, None] * area
        return {
            wall.name: (
                self.system.loads[index, : self.case.dimension].copy(),
                forces[self._panels.wall == index].sum(axis=0),
            )
            for index, wall in enumerate(self.scene.walls)
        }

    # a whole run

    @property
    def frame_count(self) -> int:
        """Number of frames of a whole run."""
        return _samples(self.case.until, self.case.frame_interval)

    @property
    def probe_count(self) -> int:
        """Number of probe samples of a whole run."""
        return _samples(self.case.until, self.case.probe_interval)

    def run(self, manager: pluggy.PluginManager) -> None:
        """Run to the end of the case, telling the events to the listeners of ``manager``.

        Raises
        ------
        SimulationError: when the run goes wrong. Listeners are told of any error before it leaves here.
        """
        hook = manager.hook
        with deferred_interruption() as interruption:
            try:
                with self._dating_errors(), naming_hook():
                    self._run(hook, interruption)
            except BaseException as error:
                hook.sphframe_run_failed(simulation=self, error=error)
                raise
            hook.sphframe_run_finished(simulation=self)

    def _run(self, hook: pluggy.HookRelay, interruption: Interruption) -> None:
        hook.sphframe_run_started(simulation=self)
        while True:
            if self._is_due(self.samples, self.case.probe_interval):
                hook.sphframe_probes_due(simulation=self)
                self.samples += 1
            if self._is_due(self.frames, self.case.frame_interval):
                check_promises(self.system, self.components["interpolator"], self.components["kernel"], self.case)
                hook.sphframe_frame_due(simulation=self)
                self.frames += 1
            if self.time >= self.case.until:
                return
            self.advance()
            hook.sphframe_step_completed(simulation=self)
            interruption.raise_if_asked()

    def _is_due(self, number: int, interval: float) -> bool:
        return self.time >= number * interval - 1e-9 * interval


def _samples(until: float, interval: float) -> int:
    return math.floor(until / interval + 1e-9) + 1


def _use_threads(threads: int | None) -> int:
    available = int(numba.config.NUMBA_NUM_THREADS)  # type: ignore[attr-defined]
    if threads is not None and not 1 <= threads <= available:
        raise InputError(f"threads = {threads}, but this machine offers 1 to {available}")
    numba.set_num_threads(threads or available)
    return threads or available


def _check_scene(scene: Scene, position: Array, dim: int) -> None:
    if position.shape[1] != dim or any(wall.dimension != dim for wall in scene.walls):
        raise InputError(f"the case says dimension = {dim}, but its walls or fluid are drawn in another one")
    if len(position) == 0:
        raise InputError("the case holds no fluid particle: make particle_spacing smaller or the fluid larger")
    if not scene.walls:
        raise InputError("the case has no wall; a wall boundary needs at least one")
    unknown = sorted({wall.body for wall in scene.walls if wall.body is not None} - set(scene.bodies))
    if unknown:
        raise InputError(f"walls refer to the bodies {unknown}, but the case has {sorted(scene.bodies) or 'none'}")


def _from_frame(vectors: Array, motion: Motion, centre: Array | None) -> Array:
    """Points (or, with no centre, directions) drawn on a body -> where they are at present."""
    dim = vectors.shape[1]
    pivot = np.zeros(dim) if centre is None else centre
    turned = vectors - pivot
    if dim == 2:
        c, s = math.cos(motion.position[2]), math.sin(motion.position[2])
        turned = turned @ np.array([[c, s], [-s, c]])
    return turned + pivot + (0.0 if centre is None else motion.position[:dim])


def _in_frame(position: Array, motion: Motion, centre: Array) -> Array:
    """Present positions -> the frame in which the body was drawn."""
    dim = position.shape[1]
    turned = position - centre - motion.position[:dim]
    if dim == 2:
        c, s = math.cos(motion.position[2]), math.sin(motion.position[2])
        turned = turned @ np.array([[c, -s], [s, c]])
    return turned + centre


def _with_count(shape: tuple[int, ...], name: str, count: int, ghosts: int) -> tuple[int, ...]:
    """Return the shape that an array of the state has with ``count`` fluid particles."""
    if name == "system.rows":
        return (count + ghosts, *shape[1:])
    return (count, *shape[1:]) if name in ("ids", "reference", "system.rates", "system.gradient") else shape
