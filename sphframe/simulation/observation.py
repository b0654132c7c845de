"""Simulation: what can be read from a running simulation: fields, probes, forces, energies."""

from collections.abc import Callable

import numpy as np

from sphframe.arrays import AnyArray, Array, IntArray
from sphframe.boundary.boundary import Boundary
from sphframe.cases import Case, Scene
from sphframe.compiled import specialise
from sphframe.geometry import panels_of, to_body_frame
from sphframe.interfaces import Fields, Motion, Status, WallLoad
from sphframe.physics import LoopParameters, sample_points, uniform_and_linear
from sphframe.simulation.components import Components
from sphframe.simulation.filling_check import filling_by
from sphframe.simulation.probes import GaugeReadings, Gauges, PressureProbes, Readings
from sphframe.simulation.system import FluidSystem
from sphframe.simulation.wall_loads import WallLoads


class Observation:
    """Quantities of the present state of a system, in SI units; per metre of width in 2-D.

    Attributes
    ----------
    case, scene
        what is simulated. ``components``: the kernel, equation of state, interpolator and integrator.
    system
        fluid particles, ghosts and bodies; ``boundary`` its ghosts: ``position`` and ``mirror`` (g, dim) at
        present, ``statuses`` (g,).
    particle_count
        fluid particles at the start, with open ends the most there may be.
    ghost_count
        ghosts.
    sound_speed
        reference sound speed c0, m/s; ``smoothing_length`` h, ``support`` radius of the kernel, m.
    """

    def __init__(self, case: Case, scene: Scene, components: Components, system: FluidSystem) -> None:
        self.case, self.scene, self.components, self.system = case, scene, components, system
        self.boundary: Boundary = system.boundary
        self.columns = system.columns
        self.sound_speed, self.support = self.parameters.sound_speed, self.parameters.support
        self.smoothing_length = self.parameters.smoothing_length
        self.particle_count = system.channel.capacity if system.channel is not None else system.fluid_count
        self.ghost_count = self.boundary.count
        self._lower, self._upper = (np.array(corner, dtype=np.float64) for corner in scene.domain)
        self._probes = PressureProbes(scene.probes, case.dimension, list(scene.bodies))
        self._gauges = Gauges(scene.gauges, self._lower, self._upper, 0.25 * case.particle_spacing, list(scene.bodies))
        self._solid = filling_by(  # share of the kernel within walls
            self.boundary.position, self.boundary.volume, self._probes.points, components, self.parameters,
            self.boundary.sight, self.boundary.periods,
        )  # fmt: skip
        self._lower[self.boundary.periods.repeats] = -np.inf
        self._upper[self.boundary.periods.repeats] = np.inf
        panels = panels_of(self.boundary.groups, case.particle_spacing)
        if self.boundary.sides is not None:  # on the wall itself they would see both sides of a thin one
            panels = panels.in_front(1e-3 * case.particle_spacing)
        self._wall_loads = WallLoads(system, scene.walls, scene.wall_parts, panels, self.sample)
        self._sample: Callable[..., None] = specialise(sample_points, components.parts)

    @property
    def parameters(self) -> LoopParameters:
        """Constants of the loops, with the present body force."""
        return self.system.parameters

    @property
    def fluid_count(self) -> int:
        """Number of fluid particles that are left."""
        return self.system.fluid_count

    @property
    def removed_count(self) -> int:
        """Number of particles that have left the domain and were removed; those of an outflow do not count."""
        return self.particle_count - self.fluid_count if self.system.channel is None else 0

    @property
    def ghosts(self) -> Boundary:
        """The ghosts; the same as ``boundary``."""
        return self.boundary

    # fields

    def _fluid(self) -> Fields:
        """Views of the fluid's fields, with pressures of the present densities."""
        self.system.refresh_pressure()
        return self._fields(self.system.host_rows[: self.fluid_count])

    def _fields(self, rows: Array) -> Fields:
        of = self.columns
        return Fields(rows[:, of.position], rows[:, of.velocity], rows[:, of.density], rows[:, of.pressure])

    def fields(self) -> Fields:
        """Return copies of the fluid's fields in the particles' original order; NaN for removed particles."""
        fields = self._fluid()
        fields = fields._replace(position=self.boundary.periods.wrapped(fields.position))
        return Fields(*map(self.in_original_order, fields))

    def turns(self) -> IntArray:
        """Return by how many periods (n, dim) the particles have left the box, in their original order."""
        position = self.system.host_rows[: self.fluid_count, self.columns.position]
        ordered = np.zeros((self.particle_count, self.case.dimension), np.int64)
        ordered[self.system.ids] = self.system.turns + self.boundary.periods.turns(position)
        return ordered

    def ghost_fields(self) -> Fields:
        """Return copies of the ghosts' fields as last filled."""
        return self._fields(self.system.host_rows[self.fluid_count :].copy())

    def masses(self) -> Array:
        """Return the mass of each particle in the original order, kg; NaN for removed particles."""
        return self.in_original_order(self.system.host_rows[: self.fluid_count, self.columns.mass])

    def in_original_order(self, values: AnyArray) -> Array:
        """Return ``values`` (n, ...) of the fluid in the particles' original order; NaN for removed particles."""
        ordered = np.full((self.particle_count, *values.shape[1:]), np.nan)
        ordered[self.system.ids] = values
        return ordered

    # instruments

    def sample(self, points: Array) -> tuple[Array, Array]:
        """Return pressure (Pa, 0 where dry) and filling (1 inside the fluid) at ``points`` (k, dim)."""
        self.system.refresh_pressure()
        lists, counts = self.system.lists.around(points, self.system.host_rows)
        pressures, fillings = np.zeros(len(points)), np.zeros(len(points))
        self._sample(points, self.system.host_rows, lists, counts, self.parameters, pressures, fillings)
        return pressures, fillings

    def probe_readings(self) -> Readings:
        """Return the pressure at each probe, Pa, 0 where it is dry, and whether it is wet."""
        points = self._probes.present_points(self.system.bodies.motions, self.boundary.centres)
        return self._probes.readings(*self.sample(points), self._solid)

    def probe_pressures(self) -> Array:
        """Return the pressure at each probe, Pa; 0 where it is dry."""
        return self.probe_readings().pressure

    def gauge_readings(self) -> GaugeReadings:
        """Return the elevation of the free surface at each gauge, m, NaN where dry, and the depth of water, m."""
        return self._gauges.readings(self.sample(self._gauges.present_points(self.system.bodies.motions))[1])

    def diagnostics(self) -> dict[str, float]:
        """Return the case's own diagnostics; those of a body see positions in the frame in which it was drawn."""
        fields = self._fluid()
        found = {}
        for diagnostic in self.scene.diagnostics:
            seen = fields
            if diagnostic.body is not None:
                body = list(self.boundary.bodies).index(diagnostic.body)
                seen = fields._replace(position=self._in_frame(fields.position, body))
            found[diagnostic.name] = diagnostic.function(seen)
        return found

    # totals

    def energies(self) -> dict[str, float]:
        """Return kinetic, potential and internal energy of the fluid, J, summed in one thread.

        The potential energy -m (f0.x + x.G x / 2) is that in the present force per mass f0 + G x, and zero at the
        origin; the internal energy is p^2 V / (2 rho c0^2), its leading order.
        """
        fields, periods = self._fluid(), self.boundary.periods
        mass = self.system.host_rows[: self.fluid_count, self.columns.mass].copy()
        place = fields.position + self.system.turns * periods.length if periods else fields.position
        speed2 = np.einsum("ij,ij->i", fields.velocity, fields.velocity)
        strain = fields.pressure / (fields.density * self.sound_speed)
        return {
            "kinetic": 0.5 * float(np.einsum("i,i->", mass, speed2)),
            "potential": self._potential_energy(mass, place),
            "internal": 0.5 * float(np.einsum("i,i->", mass, strain**2)),
        }

    def _potential_energy(self, mass: Array, position: Array) -> float:
        force, gradient = uniform_and_linear(self.parameters, self.columns.dim)
        energy = -sum(float(f * np.einsum("i,i->", mass, x)) for f, x in zip(force, position.T, strict=True))
        if gradient is not None:
            energy -= 0.5 * float(np.einsum("i,ij,jk,ik->", mass, position, gradient, position))
        return energy

    def particles_outside(self) -> int:
        """Return the number of particles behind a wall."""
        position = self.system.host_rows[: self.fluid_count, self.columns.position]
        outside = np.zeros(self.fluid_count, dtype=np.bool_)
        for group, body in zip(self.boundary.groups, self.boundary.group_body, strict=True):
            outside |= group.behind(self._in_frame(position, body) if body >= 0 else position)
        return int(outside.sum())

    def status_counts(self) -> IntArray:
        """Return the number of ghosts by :class:`Status` at the last evaluation."""
        return np.bincount(self.system.statuses, minlength=len(Status))

    # walls and bodies

    def _in_frame(self, position: Array, body: int) -> Array:
        """Return present positions in the frame in which the body was drawn."""
        return to_body_frame(position, self.system.bodies.motions[body].position, self.boundary.centres[body])

    def body_motions(self) -> dict[str, Motion]:
        """Return the motion of each body at present."""
        return self.system.bodies.present_motions()

    def wall_loads(self) -> dict[str, WallLoad]:
        """Return force and moment on each wall and named part, see :mod:`sphframe.simulation.wall_loads`."""
        return self._wall_loads()

    def wall_forces(self) -> dict[str, tuple[Array, Array]]:
        """Return the force on each wall and named part, N, by the ghosts' reaction and by integrated pressure."""
        return {name: (load.force, load.force_by_pressure) for name, load in self.wall_loads().items()}
