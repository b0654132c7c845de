"""Delta-SPH in plain NumPy, all pairs at once, written from the equations of the documentation.

It shares nothing with the solver but the ghosts as they were drawn, whose places the tests of the geometry check.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .bodies import FreeBody
from .kernels import Array, Gaussian
from .shifting import control, shift
from .tension import faded, released, released_edges
from .treatments import RUBS_WITHOUT_FRICTION, TREATMENTS
from .walls import Walls
from .weights import Around, shared


@dataclass
class Plain:
    """The fluid ``x``, ``u``, ``rho``, ``m`` within ``walls``, that a ``free`` body may carry; ``case``: parameters."""

    case: Any
    c0: float
    walls: Walls
    force: Callable[[float], tuple[Array, Array]]
    """time -> f at the origin and its gradient"""
    x: Array
    u: Array
    rho: Array
    m: Array
    wall_density: Array
    """of ghosts that have one of their own"""
    free: FreeBody
    condition: float = 1.0
    """the largest of the weights"""

    def __post_init__(self) -> None:
        self.dim, self.rho0 = self.walls.dim, self.case.reference_density
        self.kernel = Gaussian(self.dim, self.case.smoothing_length_ratio * self.case.particle_spacing)
        self.treatment = self.case.wall_treatment.name
        self.background = self.case.equation_of_state.options.get("background_pressure", 0.0)

    def around(self, points: Array) -> Around:
        """The fluid around points of the ghosts."""
        return self.walls.around(self.kernel, points, self.x, self.v)

    def bounded(self, pressure: Array) -> Array:
        """The pressure of a ghost, limited as the case asks for."""
        lowest = {"none": 0.0, "bounded": self.case.lowest_pressure, "free": -np.inf}[self.case.tension]
        return np.maximum(pressure, lowest)

    def strength(self, share: float) -> float:
        """The strength of forces by the depth of the water."""
        return share * self.case.weight * self.case.scene().depth

    # sums

    def prepare(self, time: float) -> None:
        """Walls, pressure, ghosts, and the differences of all pairs."""
        self.origin, self.slope_of_force = self.force(time)
        self.f = self.origin + self.x @ self.slope_of_force.T
        self.walls.move(time, self.rho0, self.origin, self.slope_of_force)
        self.p = self.pressure()
        self.v = self.m / self.rho
        n, walls, nearest = len(self.x), self.walls, self.walls.nearest
        self.x_gi = nearest(walls.ghost[None] - self.x[:, None])
        self.ghosts = given = TREATMENTS[self.treatment](self)
        self.ghost_p, self.ghost_u = self.bounded(given.pressure), given.velocity
        viscous = given.velocity if given.viscous is None else given.viscous
        if given.position is not None:
            self.x_gi = nearest(given.position[None] - self.x[:, None])
        p, u, v = given.pairs or (self.ghost_p[None], given.velocity[None], viscous[None])
        share, pressures, self.surface = given.share, self.p[:, None] + p, given.surface
        if self.case.tension == "none":
            if given.points is not None:
                share = share * faded(self, given.points, given.pressure)
            pressures, u, v = released(self, pressures, u, v)
            self.surface = given.surface and released_edges(self, *given.surface)
        self.x_ji = np.concatenate([nearest(self.x[None] - self.x[:, None]), self.x_gi], axis=1)
        own, wide = self.u[None] - self.u[:, None], self.x_gi.shape
        self.u_ji = np.concatenate([own, u - self.u[:, None]], axis=1)
        rubs = self.case.slip == "no" or self.treatment in RUBS_WITHOUT_FRICTION
        self.v_ji = np.concatenate([own, rubs * (v - self.u[:, None])], axis=1)
        self.p_sum = np.concatenate([self.p[:, None] + self.p, np.broadcast_to(pressures, wide[:2])], axis=1)
        self.rho_ji = self.rho[None] - self.rho[:, None]
        volume = share * (walls.drawn.volume if given.volume is None else given.volume)
        self.volume = np.append(self.v, volume)
        self.slope = self.kernel.gradient(self.x_ji) * self.volume[None, :, None]
        r2 = np.sum(self.x_ji**2, axis=2)
        self.r2 = np.where(r2 > 0.0, r2, 1.0)
        self.fluid = slice(0, n)
        self.gamma = np.ones(n) if given.gamma is None else given.gamma

    def pressure(self) -> Array:
        """The linear equation of state."""
        return self.c0**2 * (self.rho - self.rho0) + self.background

    def ghost_density(self) -> Array:
        """Its inverse at the ghosts."""
        return self.rho0 + (self.ghost_p - self.background) / self.c0**2

    def density_gradient(self) -> Array:
        """Renormalised, or plain where the matrix is ill-conditioned."""
        x, slope, gradients = self.x_ji[:, self.fluid], self.slope[:, self.fluid], []
        plain = np.einsum("ij,ijk->ik", self.rho_ji, slope)
        for right, matrix in zip(plain, np.einsum("ijk,ijl->ikl", x, slope), strict=True):
            size = (np.trace(matrix) / self.dim) ** self.dim
            fine = np.linalg.det(matrix) > 0.02 * size
            gradients.append(np.linalg.solve(matrix, right) if fine else right)
        return np.array(gradients)

    def density_rate(self, gradient: Array) -> Array:
        """Continuity with density diffusion among the fluid."""
        divergence = np.einsum("ijk,ijk->i", self.u_ji, self.slope)
        if self.surface is not None:
            divergence += self.surface[1].sum(axis=1)
        x, slope = self.x_ji[:, self.fluid], self.slope[:, self.fluid]
        psi = 2.0 * (self.rho_ji / self.r2[:, self.fluid])[:, :, None] * x - gradient[:, None] - gradient[None]
        diffused = np.einsum("ijk,ijk->i", psi, slope)
        rate = -self.rho * divergence + self.case.density_diffusion * self.kernel.h * self.c0 * diffused
        return rate / self.gamma

    def pair_forces(self) -> Array:
        """Force per volume of i by j, (n, n + g, dim)."""
        viscous = self.case.artificial_viscosity * self.kernel.h * self.c0 * self.rho0
        nu, morris = self.case.kinematic_viscosity, self.case.viscosity_model == "morris"
        if not morris:
            viscous += 2.0 * (self.dim + 2) * self.rho0 * nu
        pi = np.einsum("ijk,ijk->ij", self.v_ji, self.x_ji) / self.r2
        forces = (viscous * pi - self.p_sum)[:, :, None] * self.slope
        if morris:
            across = np.einsum("ijk,ijk->ij", self.x_ji, self.slope) / self.r2
            forces += 2.0 * self.rho0 * nu * across[:, :, None] * self.v_ji
        if self.ghosts.force is not None:
            forces[:, len(self.x) :] += self.rho[:, None, None] * self.ghosts.force
        if self.surface is not None:
            forces[:, len(self.x) :] += self.surface[0]
        return forces / self.gamma[:, None, None]

    def acceleration(self) -> Array:
        """Momentum."""
        controlled = control(self) if self.case.tensile_control == "on" else 0.0
        return self.pair_forces().sum(axis=1) / self.rho[:, None] + self.f + controlled

    def wall_rate(self) -> Array:
        """Of the walls' own densities."""
        return np.zeros_like(self.wall_density) if self.ghosts.rate is None else self.ghosts.rate

    def accelerate(self) -> None:
        """Compute the accelerations of the fluid and of the free body, and the density gradient."""
        self.gradient, self.a = self.density_gradient(), self.acceleration()
        if np.isfinite(self.free.mass):
            self.free.respond(self.loads().sum(axis=0))

    def evaluate(self, time: float) -> tuple[Array, ...]:
        """All rates."""
        self.prepare(time)
        self.accelerate()
        rates = self.density_rate(self.gradient), self.wall_rate()
        return self.u, self.a, *rates, self.free.acceleration

    def loads(self) -> Array:
        """Force and moment on each wall, (walls, 3 or 6)."""
        forces = -self.pair_forces()[:, len(self.x) :] * self.v[:, None, None]
        return self.walls.loads(self.walls.wrapped(self.x), forces)

    # time

    def advance(self, dt: float) -> None:
        """One step by the integrator of the case, with the shift by the largest speed at its start."""
        speed = float(np.linalg.norm(self.u, axis=1).max())
        (self.rk4 if self.case.integrator.name == "rk4" else self.symplectic)(dt)
        if self.case.shifting > 0.0:
            shift(self, speed, dt)

    def start(self, time: float) -> None:
        """Compute the rates of the first state."""
        self.time = time
        self.evaluate(time)

    def kick(self, dt: float) -> None:
        """Advance velocities."""
        self.u = self.u + dt * self.a
        self.free.kick(dt)

    def drift(self, dt: float) -> None:
        """Advance positions."""
        self.x = self.x + dt * self.u
        self.free.position = self.free.moved(dt * self.free.velocity)

    def symplectic(self, dt: float) -> None:
        """Kick, drift, density, drift, kick."""
        self.kick(0.5 * dt)
        self.drift(0.5 * dt)
        self.prepare(self.time + 0.5 * dt)
        self.rho = self.rho + dt * self.density_rate(self.gradient)
        self.wall_density = self.wall_density + dt * self.wall_rate()
        self.drift(0.5 * dt)
        self.time += dt
        self.prepare(self.time)
        self.accelerate()
        self.kick(0.5 * dt)

    def rk4(self, dt: float) -> None:
        """The classical scheme."""
        free, time, at_first = self.free, self.time, replace(self.free)
        start, total = (self.x, self.u, self.rho, self.wall_density, free.velocity, 0.0), [0.0] * 6
        for weight, before, onward in ((1 / 6, 0.0, 0.5), (1 / 3, 0.5, 0.5), (1 / 3, 0.5, 1.0), (1 / 6, 1.0, 0.0)):
            rates = *self.evaluate(time + before * dt), free.rate_since(at_first)
            total = [t + weight * rate for t, rate in zip(total, rates, strict=True)]
            by = total if onward == 0.0 else [onward * rate for rate in rates]
            state = (y + dt * rate for y, rate in zip(start, by, strict=True))
            self.x, self.u, self.rho, self.wall_density, free.velocity, moved = state
            free.position = at_first.moved(moved)
        self.time = time + dt

    # observation

    def sample(self, points: Array) -> Array:
        """Pressure at points, lifted from each particle, but not along a period."""
        offset = self.walls.nearest(points[:, None] - self.x[None])
        part = self.kernel.value(np.linalg.norm(offset, axis=2)) * self.v
        origin, gradient = self.force(self.time)
        b = self.rho0 * (origin + points @ gradient.T) * (self.walls.period == 0.0)
        return np.einsum("ij,ij->i", shared(part), self.p + np.einsum("ik,ijk->ij", b, offset))

    def energies(self) -> dict[str, float]:
        """Kinetic, potential and internal."""
        origin, gradient = self.force(self.time)
        potential = -self.x @ origin - 0.5 * np.einsum("ik,kl,il->i", self.x, gradient, self.x)
        return {
            "kinetic": float(0.5 * self.m @ np.sum(self.u**2, axis=1)),
            "potential": float(self.m @ potential),
            "internal": float(0.5 * self.m @ (self.pressure() / (self.rho * self.c0)) ** 2),
        }
