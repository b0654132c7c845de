"""Particle shifting, and the control of the tensile instability, from the equations of P. N. Sun et al."""

from typing import TYPE_CHECKING

import numpy as np

from .kernels import Array

if TYPE_CHECKING:
    from .plain import Plain


def slopes(s: "Plain") -> tuple[Array, Array]:
    """x_ji and grad_i W_ij V_j of fluid and ghosts, from the present positions."""
    x_gi = s.walls.nearest(s.walls.ghost[None] - s.x[:, None])
    x_ji = np.concatenate([s.walls.nearest(s.x[None] - s.x[:, None]), x_gi], axis=1)
    return x_ji, s.kernel.gradient(x_ji) * s.volume[None, :, None]


def eigenvalues_and_normals(s: "Plain") -> tuple[Array, Array]:
    """The smallest eigenvalue e of sum x_ji (x) grad W V, and -grad e / |grad e| near a free surface, e < 0.75."""
    x_ji, slope = slopes(s)
    e = np.linalg.eigvalsh(np.einsum("ijk,ijl->ikl", x_ji, slope))[:, 0]
    steepest = np.einsum("ij,ijk->ik", e[:, None] - e[None], slope[:, s.fluid])
    inside = np.linalg.norm(x_ji[:, s.fluid], axis=2) < s.kernel.support
    surface = np.where(inside, e[None], np.inf).min(axis=1) < 0.75
    size = np.linalg.norm(steepest, axis=1, keepdims=True)
    return e, np.where(surface[:, None] & (size > 0.0), steepest / np.where(size > 0.0, size, 1.0), 0.0)


def control(s: "Plain") -> Array:
    """(2 p_i / rho_i) sum grad W V where p_i < 0 and no free surface is near."""
    _, normals = eigenvalues_and_normals(s)
    pressure = np.where(normals.any(axis=1), 0.0, np.minimum(s.p, 0.0))
    return (2.0 * pressure / s.rho)[:, None] * slopes(s)[1].sum(axis=1)


def velocities(s: "Plain", speed: float) -> Array:
    """-2 h U sum [1 + 0.2 (W / W(dx))^4] grad W V along the free surface, at most U / 2; none in spray, e < 0.4."""
    x_ji, slope = slopes(s)
    crowded = (s.kernel.value(np.linalg.norm(x_ji, axis=2)) / s.kernel.value(s.case.particle_spacing)) ** 4
    e, normals = eigenvalues_and_normals(s)
    du = -2.0 * s.kernel.h * speed * np.einsum("ij,ijk->ik", 1.0 + 0.2 * crowded, slope)
    du = np.where(e >= 0.4, 1.0, 0.0)[:, None] * (du - np.einsum("ik,ik->i", du, normals)[:, None] * normals)
    size = np.linalg.norm(du, axis=1, keepdims=True)
    return du * np.minimum(1.0, 0.5 * speed / np.where(size > 0.0, size, 1.0))


def shift(s: "Plain", speed: float, dt: float) -> None:
    """Move the particles; velocity and density are those of the new place, by their rates half way."""
    du = s.case.shifting * velocities(s, speed)
    s.x = s.x + 0.5 * dt * du
    _, slope = slopes(s)
    moves = np.concatenate([du, np.zeros_like(s.walls.ghost)])
    carried = np.einsum("ijk,ijk->i", moves[None] - du[:, None], slope)
    for name, ghosts in (("u", s.ghost_u), ("rho", s.ghost_density())):
        own = getattr(s, name)
        every = np.concatenate([own, ghosts]).reshape(len(moves), -1)
        flux = every[None, :, :, None] * moves[None, :, None] + every[: len(own), None, :, None] * du[:, None, None]
        rate = np.einsum("ijfk,ijk->if", flux, slope) - every[: len(own)] * carried[:, None]
        setattr(s, name, own + dt * rate.reshape(own.shape))
    s.x = s.x + 0.5 * dt * du
