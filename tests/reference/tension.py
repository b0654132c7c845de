"""Walls that do not attract: ghosts fade where no fluid is, and no pair pulls."""

from typing import TYPE_CHECKING

import numpy as np

from .kernels import Array

if TYPE_CHECKING:
    from .plain import Plain


def smooth_step(t: Array) -> Array:
    """3 t^2 - 2 t^3, 0 <= t <= 1."""
    t = np.clip(t, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def faded(s: "Plain", points: Array, pressure: Array) -> Array:
    """Max(S[(phi - 0.35)/0.3], S[p_G/p_1]) of ghosts to whose ``points`` the fluid is interpolated."""
    distance = np.linalg.norm(s.walls.nearest(s.walls.ghost[None] - points[:, None]), axis=2)
    full = 1.0 - s.kernel.value(distance) @ s.walls.drawn.volume
    told = full > 0.05
    filled = s.around(points).parts.sum(axis=1) / np.where(told, full, 1.0)
    by_pressure = smooth_step(pressure / (0.01 * s.rho0 * s.c0**2))
    return np.where(told, np.maximum(smooth_step((filled - 0.35) / 0.3), by_pressure), 1.0)


def released(s: "Plain", pressures: Array, velocity: Array, viscous: Array) -> tuple[Array, Array, Array]:
    """Sums p_i + p_G and velocities of the ghosts (n, g, ..) as fluid sees them that may leave the wall freely."""
    acts = np.minimum(s.p[:, None], pressures) > 0.0
    own = s.u[:, None]
    opens = np.einsum("igk,igk->ig", velocity - own, s.x_gi) > 0.0
    return (
        np.where(acts, pressures, 0.0),
        np.where((~acts & opens)[:, :, None], own, velocity),
        np.where(acts[:, :, None], viscous, own),
    )


def released_edges(s: "Plain", force: Array, divergence: Array) -> tuple[Array, Array]:
    """The same of edges: forces (n, g, dim) and divergences (n, g)."""
    pulls = (np.einsum("igk,gk->ig", force, s.walls.normal) > 0.0) | (s.p <= 0.0)[:, None]
    return np.where(pulls[:, :, None], 0.0, force), np.where(pulls, np.minimum(divergence, 0.0), divergence)
