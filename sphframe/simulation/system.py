"""Simulation: the fluid and its bodies as one system of ordinary differential equations.

The order of things within one evaluation reads from top to bottom in :meth:`FluidSystem.evaluate`.
"""

from collections.abc import Mapping
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from sphframe.boundary.boundary import Boundary
from sphframe.boundary.contact import put_back
from sphframe.compiled import compile_part, specialise
from sphframe.errors import SimulationError
from sphframe.interfaces import CompiledKernel, EquationOfState, Motion, RigidBody, System
from sphframe.neighbours import NeighbourLists, put_in_order
from sphframe.particles import Columns
from sphframe.physics import fluid_sums, update_pressure, wall_reaction

__all__ = ["FluidSystem", "Parameters"]

Array = NDArray[np.float64]


class Parameters:
    """The numbers that the loops need, in SI units."""

    def __init__(
        self,
        *,
        dim: int,
        kernel: CompiledKernel,
        smoothing_length: float,
        reference_density: float,
        sound_speed: float,
        gravity: float,
        density_diffusion: float,
        artificial_viscosity: float,
    ) -> None:
        self.dim = dim
        self.smoothing_length = smoothing_length
        self.support = kernel.support * smoothing_length
        self.kernel_scale = kernel.normalisation / smoothing_length**dim
        self.gradient_scale = kernel.normalisation / smoothing_length ** (dim + 2)
        self.reference_density = reference_density
        self.sound_speed = sound_speed
        self.gravity = gravity
        self.diffusion = density_diffusion * smoothing_length * sound_speed
        self.viscosity = artificial_viscosity * smoothing_length * sound_speed * reference_density


class FluidSystem(System):
    """The state that an integrator advances: rows of the fluid, and generalised coordinates of the bodies.

    Attributes
    ----------
    rows: (n + g, width) packed rows, see :class:`Columns`; the fluid comes first.
    rates: (n, 2 dim + 1) velocity, acceleration and density rate of the last evaluation.
    gradient: (n, dim) renormalised density gradient, kg/m^4.
    body_position, body_velocity: (bodies, 3); ``loads`` (walls, 3) force and moment on each wall.
    """

    def __init__(
        self,
        rows: Array,
        fluid_count: int,
        boundary: Boundary,
        lists: NeighbourLists,
        kernel: CompiledKernel,
        equation_of_state: EquationOfState,
        parameters: Parameters,
    ) -> None:
        dim = parameters.dim
        self.boundary = boundary
        self.parameters = parameters
        self.columns = Columns(dim)
        self._hold_fluid(rows, np.zeros((fluid_count, 2 * dim + 1)), lists)
        bodies = len(boundary.bodies)
        self.body_position = np.zeros((bodies, 3))
        self.body_velocity = np.zeros((bodies, 3))
        self.motions = [Motion(np.zeros(3), np.zeros(3), np.zeros(3)) for _ in range(bodies)]
        self._body_rates = np.zeros((2, bodies, 3))
        self._body_start = np.zeros((2, bodies, 3))
        self._body_total = np.zeros((2, bodies, 3))
        walls = len(boundary.wall_body)
        self.loads = np.zeros((walls, 3))
        self._partial_loads = np.zeros((64, walls, 3))
        self._driving_force = np.zeros(dim)
        self._driving_force[-1] = -parameters.reference_density * parameters.gravity
        parts = {"DIM": dim, "SUPPORT": kernel.support, "GRADIENT": kernel.gradient_of_square}
        self._pressure = specialise(
            update_pressure, {"DIM": dim, "PRESSURE": compile_part(equation_of_state.pressure_function())}
        )
        self._density_rates = specialise(fluid_sums, {**parts, "CONTINUITY": True})
        self._accelerations = specialise(fluid_sums, {**parts, "CONTINUITY": False})
        self._wall_reaction = specialise(wall_reaction, parts)

    def _hold_fluid(self, rows: Array, rates: Array, lists: NeighbourLists) -> None:
        self.rows, self.rates, self.lists = rows, rates, lists
        self.fluid_count = len(rates)
        self.gradient = np.zeros((self.fluid_count, self.parameters.dim))
        self._start = np.zeros_like(rates)
        self._total = np.zeros_like(rates)
        self._spare = np.zeros((self.fluid_count, self.columns.width))

    def keep(self, kept: NDArray[np.bool_], lists: NeighbourLists) -> None:
        """Go on with the fluid particles that are ``kept`` (n,) and with new ``lists`` for that many."""
        n, gradient = self.fluid_count, self.gradient[kept]
        self._hold_fluid(np.vstack([self.rows[:n][kept], self.rows[n:]]), self.rates[kept], lists)
        self.gradient[:] = gradient

    def put_in_order(self, order: NDArray[np.int64]) -> None:
        """Number the fluid particles anew: the k-th is the one that was ``order[k]`` (n,)."""
        put_in_order(self.rows, order, self._spare)
        put_in_order(self.rates, order, self._spare)
        put_in_order(self.gradient, order, self._spare)

    def state(self) -> dict[str, Array]:
        """Return copies of all that the next step depends on, by name."""
        return {
            "rows": self.rows.copy(),
            "rates": self.rates.copy(),
            "gradient": self.gradient.copy(),
            "loads": self.loads.copy(),
            "body_position": self.body_position.copy(),
            "body_velocity": self.body_velocity.copy(),
            "body_rates": self._body_rates.copy(),
            "motions": np.array(self.motions).reshape(-1, 3, 3),
        }

    def restore(self, state: Mapping[str, Array]) -> None:
        """Continue from what :meth:`state` returned, with as many particles as there are now."""
        self.rows[:] = state["rows"]
        self.rates[:] = state["rates"]
        self.gradient[:] = state["gradient"]
        self.loads[:] = state["loads"]
        self.body_position[:] = state["body_position"]
        self.body_velocity[:] = state["body_velocity"]
        self._body_rates[:] = state["body_rates"]
        self.motions[:] = [Motion(*motion.copy()) for motion in state["motions"]]

    def evaluate(self, time: float) -> None:
        """Compute all rates of the present state at ``time``."""
        self.evaluate_acceleration(time)
        self._find(self._density_rates)

    def evaluate_density(self, time: float) -> None:
        """Compute the density rates of the present state at ``time``, with the density gradient last computed."""
        self.move_walls(time)
        self.update_pressure()
        self.fill_ghosts()
        self._find(self._density_rates)

    def evaluate_acceleration(self, time: float) -> None:
        """Compute the accelerations and the density gradient of the present state at ``time``."""
        self.move_walls(time)
        self.update_pressure()
        self.fill_ghosts()
        self._find(self._accelerations)
        self.find_body_rates(time)

    def move_walls(self, time: float) -> None:
        """Carry the ghosts to where the bodies are; a body under load keeps its last acceleration."""
        for k, body in enumerate(self.boundary.bodies.values()):
            motion = self._ask_body(time, k, body)
            kept = self.motions[k].acceleration if body.needs_load else motion.acceleration
            self.motions[k] = motion._replace(acceleration=kept)
        p = self.parameters
        self.boundary.move(self.motions, self.rows[self.fluid_count :], self._driving_force, p.reference_density)

    def update_pressure(self) -> None:
        """Pressure and volume of the fluid from its density."""
        p = self.parameters
        self._pressure(self.rows, self.fluid_count, p.reference_density, p.sound_speed)

    def fill_ghosts(self) -> None:
        """Mirror, interpolate, assign."""
        p = self.parameters
        self.boundary.fill(
            self.rows,
            self.lists,
            kernel_scale=p.kernel_scale,
            reference_density=p.reference_density,
            sound_speed=p.sound_speed,
        )

    def _find(self, sums: Any) -> None:
        p, lists = self.parameters, self.lists
        sums(
            self.rows, lists.fluid, lists.fluid_counts, lists.ghost_counts, p.support, p.gradient_scale,
            p.diffusion, p.viscosity, p.gravity, self.gradient, self.rates,
        )  # fmt: skip

    def find_loads(self) -> None:
        """Force and moment of the fluid on each wall."""
        p, lists, boundary = self.parameters, self.lists, self.boundary
        centres = np.zeros((len(boundary.wall_body), p.dim))
        for wall, body in enumerate(boundary.wall_body):
            if body >= 0:
                centres[wall] = boundary.centres[body] + self.motions[body].position[: p.dim]
        self._wall_reaction(
            self.rows, self.fluid_count, lists.fluid, lists.fluid_counts, lists.ghost_counts, boundary.wall,
            *boundary.corner_shares(self.motions), centres, p.support, p.gradient_scale, p.viscosity,
            self._partial_loads, self.loads,
        )  # fmt: skip

    def find_body_rates(self, time: float) -> None:
        """Velocities and accelerations of the bodies under the present loads."""
        if not self.boundary.bodies:
            return
        if any(body.needs_load for body in self.boundary.bodies.values()):
            self.find_loads()
        for k, body in enumerate(self.boundary.bodies.values()):
            if body.needs_load:
                self.motions[k] = self._ask_body(time, k, body)
        for k, motion in enumerate(self.motions):
            self._body_rates[0, k] = motion.velocity
            self._body_rates[1, k] = motion.acceleration

    def _ask_body(self, time: float, k: int, body: RigidBody) -> Motion:
        load = self.loads[self.boundary.wall_body == k].sum(axis=0)
        try:
            motion = body.motion(time, self.body_position[k], self.body_velocity[k], load)
            self.body_position[k], self.body_velocity[k] = motion.position, motion.velocity
            fault = "" if np.all(np.isfinite(motion)) or not np.all(np.isfinite(load)) else f"returned {motion}"
        except Exception as error:
            fault = f"raised {type(error).__name__}: {error}"
        if fault:
            raise SimulationError(
                f"body {list(self.boundary.bodies)[k]!r} failed: {type(body).__name__}.motion at t = {time:.6g} s with"
                f" load {load} {fault}; mend it: it must return a Motion of three arrays of three finite numbers"
            )
        return motion

    def put_back(self, spacing: float) -> int:
        """Put particles that have come behind a wall back on it; return how many there were."""
        lists, boundary = self.lists, self.boundary
        return int(
            put_back(
                self.rows, self.fluid_count, lists.fluid, lists.fluid_counts, lists.ghost_counts,
                self.parameters.dim, spacing, boundary.mirror, boundary.velocity,
            )
        )  # fmt: skip

    def hold(self) -> None:
        """Remember the state as the start of the step."""
        _copy_state(self.rows, self._start)
        self._total[:] = 0.0
        if len(self.body_position):
            self._body_start[0] = self.body_position
            self._body_start[1] = self.body_velocity
            self._body_total[:] = 0.0

    def advance(self, interval: float) -> None:
        """y = y0 + interval * f."""
        _advance(self.rows, self._start, self.rates, interval)
        if len(self.body_position):
            self._set_bodies(self._body_start + interval * self._body_rates)

    def accumulate(self, weight: float) -> None:
        """total = total + weight * f."""
        _accumulate(self._total, self.rates, weight)
        self._body_total += weight * self._body_rates

    def advance_total(self, interval: float) -> None:
        """y = y0 + interval * total."""
        _advance(self.rows, self._start, self._total, interval)
        if len(self.body_position):
            self._set_bodies(self._body_start + interval * self._body_total)

    def drift(self, interval: float) -> None:
        """x = x + interval * u."""
        _drift(self.rows, self.fluid_count, self.parameters.dim, interval)
        self.body_position += interval * self.body_velocity

    def kick(self, interval: float) -> None:
        """u = u + interval * acceleration."""
        _kick(self.rows, self.rates, self.parameters.dim, interval)
        self.body_velocity += interval * self._body_rates[1]

    def update_density(self, interval: float) -> None:
        """rho = rho + interval * density rate."""
        _update_density(self.rows, self.rates, self.parameters.dim, interval)

    def _set_bodies(self, state: Array) -> None:
        self.body_position[:], self.body_velocity[:] = state


@numba.njit(parallel=True, cache=True)
def _copy_state(rows, start):  # type: ignore[no-untyped-def]
    for i in numba.prange(start.shape[0]):
        for k in range(start.shape[1]):
            start[i, k] = rows[i, k]


@numba.njit(parallel=True, cache=True)
def _advance(rows, start, rates, interval):  # type: ignore[no-untyped-def]
    for i in numba.prange(start.shape[0]):
        for k in range(start.shape[1]):
            rows[i, k] = start[i, k] + interval * rates[i, k]


@numba.njit(parallel=True, cache=True)
def _accumulate(total, rates, weight):  # type: ignore[no-untyped-def]
    for i in numba.prange(total.shape[0]):
        for k in range(total.shape[1]):
            total[i, k] += weight * rates[i, k]


@numba.njit(parallel=True, cache=True)
def _drift(rows, count, dim, interval):  # type: ignore[no-untyped-def]
    for i in numba.prange(count):
        for k in range(dim):
            rows[i, k] += interval * rows[i, dim + k]


@numba.njit(parallel=True, cache=True)
def _kick(rows, rates, dim, interval):  # type: ignore[no-untyped-def]
    for i in numba.prange(rates.shape[0]):
        for k in range(dim, 2 * dim):
            rows[i, k] += interval * rates[i, k]


@numba.njit(parallel=True, cache=True)
def _update_density(rows, rates, dim, interval):  # type: ignore[no-untyped-def]
    for i in numba.prange(rates.shape[0]):
        rows[i, 2 * dim] += interval * rates[i, 2 * dim]
