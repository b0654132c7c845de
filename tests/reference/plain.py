"""Delta-SPH with fixed ghosts in plain NumPy, all pairs at once, written from the equations of the documentation.

It shares nothing with the solver but the ghosts as they were drawn, whose places the tests of the geometry check.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import erf, exp, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]
NORMALISATION = {2: 1.0 / (pi * (1.0 - 10.0 * exp(-9.0))), 3: 1.0 / (pi**1.5 * erf(3.0) - 42.0 * pi * exp(-9.0))}
Motion = tuple[Array, Array, Array]
"""displacement and turn, velocity, acceleration of a body: (3,) in 2-D, (6,) in 3-D"""


def improved_shepard(offset: Array, r: Array, inside: Array, values: Array, volumes: Array, support: float) -> Array:
    """phi^4 / sum phi^4 with phi = exp[-s^2 / (1 - s^2)] / s, s = r/R, by logarithms."""
    s = np.where(inside, r / support, 0.5)
    powers = np.where(inside, 4.0 * (-(s**2) / (1.0 - s**2) - np.log(s)), -np.inf)
    highest = np.where(inside.any(axis=1), powers.max(axis=1, initial=-np.inf), 0.0)
    return shared(np.exp(powers - highest[:, None]))


def shepard(offset: Array, r: Array, inside: Array, values: Array, volumes: Array, support: float) -> Array:
    """r^-2 / sum r^-2."""
    return shared(np.where(inside, 1.0 / np.where(inside, r, 1.0) ** 2, 0.0))


def normalised(offset: Array, r: Array, inside: Array, values: Array, volumes: Array, support: float) -> Array:
    """W V / sum W V."""
    return shared(values * volumes)


def moving_least_squares(
    offset: Array, r: Array, inside: Array, values: Array, volumes: Array, support: float
) -> Array:
    """e_1 M^-1 b_j W_j V_j, M = sum b_j b_j W_j V_j; the average where neighbours are few or sum |phi| is above 3."""
    found, part = normalised(offset, r, inside, values, volumes, support), values * volumes
    basis = np.concatenate([np.ones((*r.shape, 1)), 3.0 * offset / support], axis=2)
    for k in np.flatnonzero(inside.sum(axis=1) >= basis.shape[2]):
        moments = (basis[k] * part[k, :, None]).T @ basis[k]
        if np.linalg.cond(moments) < 1e12:
            phi = np.linalg.solve(moments, (basis[k] * part[k, :, None]).T)[0]
            found[k] = phi if np.abs(phi).sum() <= 3.0 else found[k]
    return found


def shared(weights: Array) -> Array:
    """Divide each row by its sum; a row of zeros remains."""
    total = weights.sum(axis=1, keepdims=True)
    return weights / np.where(total > 0.0, total, 1.0)


def turn(motion: Array) -> Array:
    """The rotation matrix of a body."""
    dim = 2 if len(motion) == 3 else 3
    return Rotation.from_rotvec([0.0, 0.0, motion[2]] if dim == 2 else motion[3:]).as_matrix()[:dim, :dim]


def cross(omega: Array, arm: Array) -> Array:
    """Omega x arm, in the plane if omega has one component."""
    return np.cross(omega, arm) if len(omega) == 3 else omega * np.stack([-arm[:, 1], arm[:, 0]], axis=1)


@dataclass
class Plain:
    """The fluid ``x``, ``u``, ``rho``, ``m`` and ghosts; ``case`` gives the parameters, ``drawn`` the ghosts."""

    case: Any
    c0: float
    drawn: Any
    wall_body: Sequence[int]
    centres: Array
    bodies: Sequence[Callable[[float], Motion]]
    force: Callable[[float], tuple[Array, Array]]
    """time -> f at the origin and its gradient"""
    weights: Callable[..., Array]
    at_rest: Array
    """velocity (g, dim) of the surfaces of walls"""
    x: Array = field(default_factory=lambda: np.zeros(0))
    u: Array = field(default_factory=lambda: np.zeros(0))
    rho: Array = field(default_factory=lambda: np.zeros(0))
    m: Array = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        self.dim, self.rho0 = self.drawn.position.shape[1], self.case.reference_density
        self.h = self.case.smoothing_length_ratio * self.case.particle_spacing
        self.support = 3.0 * self.h
        self.body = np.array(self.wall_body)[self.drawn.wall]

    # walls

    def move_walls(self, time: float) -> None:
        """Carry the ghosts; set b = rho0 (f - a_wall) at their feet."""
        d = self.drawn
        self.ghost, self.mirror, self.foot, self.normal = (a.copy() for a in (d.position, d.mirror, d.foot, d.normal))
        no_slip = self.case.slip == "no"
        self.reflection = np.tile(-np.eye(self.dim), (len(d.wall), 1, 1)) if no_slip else d.reflection.copy()
        self.dual, self.other_normal = d.other_dual.copy(), d.other_normal.copy()
        self.wall_u, acceleration = self.at_rest.copy(), np.zeros_like(d.position)
        self.motions = [tuple(map(np.asarray, body(time))) for body in self.bodies]
        for k, (place, velocity, rate) in enumerate(self.motions):
            own, matrix = self.body == k, turn(place)
            for array in (self.ghost, self.mirror, self.foot):
                array[own] = (array[own] - self.centres[k]) @ matrix.T + self.centres[k] + place[: self.dim]
            for array in (self.normal, self.dual, self.other_normal):
                array[own] = array[own] @ matrix.T
            self.reflection[own] = matrix @ self.reflection[own] @ matrix.T
            arm, omega = self.foot[own] - self.centres[k] - place[: self.dim], velocity[self.dim :]
            turning = cross(omega, arm)
            self.wall_u[own] = velocity[: self.dim] + turning
            acceleration[own] = rate[: self.dim] + cross(rate[self.dim :], arm) + cross(omega, turning)
        origin, gradient = self.force(time)
        self.f = origin + self.x @ gradient.T
        self.b = self.rho0 * (origin + self.foot @ gradient.T - acceleration)

    def fill(self) -> None:
        """Interpolate to the mirror points, and assign pressure and velocity of the ghosts."""
        offset = self.x[None] - self.mirror[:, None]
        r = np.linalg.norm(offset, axis=2)
        inside = r < self.support
        values = self.kernel(r)
        phi = self.weights(offset, r, inside, values, self.v, self.support)
        wet = inside.any(axis=1)
        lift = self.ghost - self.mirror
        if self.case.hydrostatic_lift == "balanced":
            higher = np.einsum("gk,gjk->gj", self.b, lift[:, None] - offset)
            pressure = np.einsum("gj,gj->g", phi, self.p + higher)
        else:
            pressure = phi @ self.p + wet * np.einsum("gk,gk->g", self.b, lift)
        s = np.ones(len(wet))
        corrected = self.case.ghost_velocity == "corrected"
        if self.case.hydrostatic_lift == "balanced" and corrected:
            depth = np.einsum("gk,gk->g", self.ghost - self.foot, self.normal)
            height = np.maximum(np.einsum("gk,gk->g", self.foot - self.mirror, self.normal), 0.1 * depth)
            distances = height[:, None] - np.einsum("gjk,gk->gj", offset, self.normal)
            sampled = np.einsum("gj,gj->g", phi, distances)
            s = np.where(wet, depth / np.maximum(sampled, 0.5 * height), 1.0)
        relative = np.where(wet[:, None], phi @ self.u - self.wall_u, 0.0)
        reflected = np.einsum("gkl,gl->gk", self.reflection, relative)
        half = 0.5 * (1.0 - s)[:, None]
        self.ghost_u = self.wall_u + half * relative + (1.0 - half) * reflected
        if self.case.hydrostatic_lift == "mirror" and corrected:
            self._make_conjugate()
        lowest = self.case.lowest_pressure if self.case.tension == "bounded" else -np.inf
        self.ghost_p = np.maximum(pressure, lowest)
        self.ghost_rho = self.rho0 + self.ghost_p / self.c0**2

    def _make_conjugate(self) -> None:
        """Change the reversed velocities so that the ghosts do no work in a uniform pressure."""
        slope = self.grad(self.x[None] - self.ghost[:, None]) * self.v[None, :, None]  # - grad_j W_jG V_j
        across = 0.5 * (slope - np.einsum("gkl,gjl->gjk", self.reflection, slope))
        a = across.sum(axis=1)
        motion = self.u[None] + self.ghost_u[:, None] - 2.0 * self.wall_u[:, None]
        b = np.einsum("gjk,gjk->g", across, motion)
        square = np.sum(a**2, axis=1)
        works = np.sqrt(square) > 0.1 * np.linalg.norm(slope, axis=2).sum(axis=1)
        self.ghost_u -= np.where(works, b / np.where(works, square, 1.0), 0.0)[:, None] * a

    # kernel and sums

    def kernel(self, r: Array) -> Array:
        """W."""
        q2 = (r / self.h) ** 2
        return np.where(
            r < self.support, NORMALISATION[self.dim] / self.h**self.dim * (np.exp(-q2) - np.exp(-9.0)), 0.0
        )

    def grad(self, x_ji: Array) -> Array:
        """grad_i W_ij."""
        q2 = np.sum(x_ji**2, axis=-1, keepdims=True) / self.h**2
        slope = 2.0 * NORMALISATION[self.dim] / self.h ** (self.dim + 2) * np.exp(-q2)
        return np.where(q2 < 9.0, slope, 0.0) * x_ji

    def prepare(self, time: float) -> None:
        """Walls, pressure, ghosts, and the differences of all pairs."""
        self.move_walls(time)
        self.p = self.c0**2 * (self.rho - self.rho0)
        self.v = self.m / self.rho
        self.fill()
        n = len(self.x)
        self.x_ji = np.vstack([self.x, self.ghost])[None] - self.x[:, None]
        self.u_ji = np.vstack([self.u, self.ghost_u])[None] - self.u[:, None]
        self.p_sum = np.append(self.p, self.ghost_p)[None] + self.p[:, None]
        self.rho_ji = self.rho[None] - self.rho[:, None]
        self.slope = self.grad(self.x_ji) * np.append(self.v, self.drawn.volume)[None, :, None]
        r2 = np.sum(self.x_ji**2, axis=2)
        self.r2 = np.where(r2 > 0.0, r2, 1.0)
        self.fluid = slice(0, n)

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
        x, slope = self.x_ji[:, self.fluid], self.slope[:, self.fluid]
        psi = 2.0 * (self.rho_ji / self.r2[:, self.fluid])[:, :, None] * x - gradient[:, None] - gradient[None]
        diffused = np.einsum("ijk,ijk->i", psi, slope)
        return -self.rho * divergence + self.case.density_diffusion * self.h * self.c0 * diffused

    def pair_forces(self) -> Array:
        """Force per volume of i by j, (n, n + g, dim)."""
        viscous, nu = self.case.artificial_viscosity * self.h * self.c0 * self.rho0, self.case.kinematic_viscosity
        morris = self.case.viscosity_model == "morris"
        if not morris:
            viscous += 2.0 * (self.dim + 2) * self.rho0 * nu
        pi = np.einsum("ijk,ijk->ij", self.u_ji, self.x_ji) / self.r2
        forces = (viscous * pi - self.p_sum)[:, :, None] * self.slope
        if morris:
            across = np.einsum("ijk,ijk->ij", self.x_ji, self.slope) / self.r2
            forces += 2.0 * self.rho0 * nu * across[:, :, None] * self.u_ji
        return forces

    def acceleration(self) -> Array:
        """Momentum."""
        return self.pair_forces().sum(axis=1) / self.rho[:, None] + self.f

    def evaluate(self, time: float) -> tuple[Array, Array, Array]:
        """All rates."""
        self.prepare(time)
        self.gradient = self.density_gradient()
        return self.u, self.acceleration(), self.density_rate(self.gradient)

    def loads(self) -> Array:
        """Force and moment on each wall, (walls, 3 or 6); the second wall of a corner takes its part."""
        forces = -self.pair_forces()[:, len(self.x) :] * self.v[:, None, None]
        found = np.zeros((len(self.wall_body), 3 if self.dim == 2 else 6))
        along = np.einsum("igk,gk->ig", forces, self.dual) * (self.drawn.other >= 0)
        second = along[:, :, None] * self.other_normal
        for wall, body in enumerate(self.wall_body):
            centre = self.centres[body] + self.motions[body][0][: self.dim] if body >= 0 else np.zeros(self.dim)
            own = ((self.drawn.wall == wall)[None, :, None] * (forces - second)).sum(axis=1)
            own += ((self.drawn.other == wall)[None, :, None] * second).sum(axis=1)
            arm = self.x - centre
            moment = arm[:, :1] * own[:, 1:2] - arm[:, 1:2] * own[:, :1] if self.dim == 2 else np.cross(arm, own)
            found[wall] = np.hstack([own, moment]).sum(axis=0)
        return found

    # time

    def start(self, time: float) -> None:
        """Compute the rates of the first state."""
        self.time, (_, self.a, _) = time, self.evaluate(time)

    def symplectic(self, dt: float) -> None:
        """Kick, drift, density, drift, kick."""
        self.u = self.u + 0.5 * dt * self.a
        self.x = self.x + 0.5 * dt * self.u
        self.prepare(self.time + 0.5 * dt)
        self.rho = self.rho + dt * self.density_rate(self.gradient)
        self.x = self.x + 0.5 * dt * self.u
        self.time += dt
        self.prepare(self.time)
        self.gradient, self.a = self.density_gradient(), self.acceleration()
        self.u = self.u + 0.5 * dt * self.a

    def rk4(self, dt: float) -> None:
        """The classical scheme."""
        start, total, time = (self.x, self.u, self.rho), [0.0, 0.0, 0.0], self.time
        for weight, before, onward in ((1 / 6, 0.0, 0.5), (1 / 3, 0.5, 0.5), (1 / 3, 0.5, 1.0), (1 / 6, 1.0, 0.0)):
            rates = self.evaluate(time + before * dt)
            self.a = rates[1]
            total = [t + weight * rate for t, rate in zip(total, rates, strict=True)]
            by = total if onward == 0.0 else [onward * rate for rate in rates]
            self.x, self.u, self.rho = (y + dt * rate for y, rate in zip(start, by, strict=True))
        self.time = time + dt

    # observation

    def sample(self, points: Array) -> Array:
        """Pressure at points, lifted from each particle."""
        offset = points[:, None] - self.x[None]
        part = self.kernel(np.linalg.norm(offset, axis=2)) * self.v
        origin, gradient = self.force(self.time)
        b = self.rho0 * (origin + points @ gradient.T)
        return np.einsum("ij,ij->i", shared(part), self.p + np.einsum("ik,ijk->ij", b, offset))

    def energies(self) -> dict[str, float]:
        """Kinetic, potential and internal."""
        origin, gradient = self.force(self.time)
        potential = -self.x @ origin - 0.5 * np.einsum("ik,kl,il->i", self.x, gradient, self.x)
        pressure = self.c0**2 * (self.rho - self.rho0)
        return {
            "kinetic": float(0.5 * self.m @ np.sum(self.u**2, axis=1)),
            "potential": float(self.m @ potential),
            "internal": float(0.5 * self.m @ (pressure / (self.rho * self.c0)) ** 2),
        }
