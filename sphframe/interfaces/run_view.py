"""Interfaces: what hooks, the output and the progress display may see of a running simulation.

Every listener to the events of a run (:mod:`sphframe.hooks`) receives the simulation as a :class:`RunView`. A listener
only reads its members and never changes the run. Only the checkpoint writer needs :class:`ResumableRun`.
"""

from typing import TYPE_CHECKING, NamedTuple, Protocol, runtime_checkable

from sphframe.arrays import Array, Arrays, BoolArray, IntArray
from sphframe.interfaces.rigid_body import Motion

if TYPE_CHECKING:  # the types alone: at run time the interfaces import no other room
    from sphframe.cases import Case, Scene


class Fields(NamedTuple):
    """The fluid at one instant: position and velocity (n, dim), density and pressure (n,), in SI units."""

    position: Array
    velocity: Array
    density: Array
    pressure: Array


class WallLoad(NamedTuple):
    """Force (dim,), N, and moment, N m, of the fluid on a wall, by reaction and by pressure; in 2-D per metre of width.

    Moments have shape (1,) in 2-D and (3,) in 3-D. They refer to the present centre of the body that carries the wall,
    or to the origin.
    """

    force: Array
    force_by_pressure: Array
    moment: Array
    moment_by_pressure: Array


class GhostView(Protocol):
    """The ghost particles of all walls."""

    @property
    def position(self) -> Array:
        """Present positions (g, dim), m."""

    @property
    def mirror(self) -> Array:
        """Present mirror points (g, dim), m."""

    @property
    def body(self) -> IntArray:
        """Index (g,) of the body that carries each ghost, -1 for a ghost at rest."""


@runtime_checkable
class RunView(Protocol):
    """A running simulation of a case, as a listener to its events sees it."""

    case: "Case"
    """The case that runs."""
    scene: "Scene"
    """Its geometry and measuring points."""
    time: float
    """Simulated time, s."""
    step: int
    """Number of time steps made."""
    time_step: float
    """Length of the last time step, s; 0 before the first."""
    particle_count: int
    """Number of fluid particles at the start of the run; with open ends the most there may be."""

    @property
    def wall_clock(self) -> float:
        """Wall-clock time of the run, output included, without the set-up and the time between resumes, s."""

    @property
    def processor_time(self) -> float:
        """Processor time of all threads in the same time, s."""

    @property
    def fluid_count(self) -> int:
        """Number of fluid particles now."""

    ghost_count: int
    """Number of ghost particles."""

    @property
    def removed_count(self) -> int:
        """Number of particles that have left the domain and were removed."""

    densities_outside: int
    """Number of particles whose density is outside the band of the case's guards."""
    sound_speed: float
    """Reference sound speed, m/s."""
    smoothing_length: float
    """Smoothing length, m."""

    @property
    def ghosts(self) -> GhostView:
        """The ghost particles."""

    def fields(self) -> Fields:
        """Return copies of the fluid's fields in the particles' original order; NaN for removed particles."""

    def masses(self) -> Array:
        """Return the mass of each particle (n,) in the original order, kg (2-D: per metre of width); NaN if removed."""

    def turns(self) -> IntArray:
        """Return by how many periods (n, dim) the particles have left the box, in their original order."""

    def ghost_fields(self) -> Fields:
        """Return copies of the ghost particles' fields as last filled."""

    def sample(self, points: Array) -> tuple[Array, Array]:
        """Return the pressure (Pa, 0 where dry) and the filling (1 inside the fluid) at ``points`` (k, dim)."""

    def probe_pressures(self) -> Array:
        """Return the pressure at each probe (p,), Pa."""

    def gauge_readings(self) -> tuple[Array, Array]:
        """Return the free-surface elevation at each gauge, m, NaN where dry, and the depth of water, m."""

    def energies(self) -> dict[str, float]:
        """Return the ``kinetic``, ``potential`` and ``internal`` energy, J (2-D: per metre of width)."""

    def diagnostics(self) -> dict[str, float]:
        """Return the case's own diagnostics by name."""

    def particles_outside(self) -> int:
        """Return the number of fluid particles behind a wall."""

    def status_counts(self) -> IntArray:
        """Return the number of ghosts by :class:`~sphframe.interfaces.Status` at the last evaluation."""

    def body_motions(self) -> dict[str, Motion]:
        """Return the present motion of each body."""

    def probe_readings(self) -> tuple[Array, BoolArray]:
        """Return the pressure at each probe (p,), Pa, 0 where it is dry, and whether it is wet (p,)."""

    def wall_loads(self) -> dict[str, WallLoad]:
        """Return force and moment on each wall and each named part of a wall."""

    def wall_forces(self) -> dict[str, tuple[Array, Array]]:
        """Return the force on each wall, N (2-D: per metre of width): reaction of the ghosts, integrated pressure."""


@runtime_checkable
class ResumableRun(RunView, Protocol):
    """A running simulation whose state can be saved, so that the run can be resumed from it."""

    samples: int
    """Number of samples taken."""
    frames: int
    """Number of frames stored."""
    between_steps: bool
    """Whether no time step is under way: only then may the state be saved."""

    def state(self) -> Arrays:
        """Return copies of all that the rest of the run depends on, by name."""
