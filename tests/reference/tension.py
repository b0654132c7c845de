"""Walls that do not attract: ghosts fade where no fluid is, and no pair pulls."""

from typing import TYPE_CHECKING

import numpy as np

from .kernels import Array

if TYPE_CHECKING:
    from .plain import Plain

AT_THE_GHOST = ("adami-2012", "band-2018", "hashemi-2012", "usaw-2013")
"""treatments that interpolate to the ghost; those below to its mirror point"""
AT_THE_MIRROR = ("fixed-ghosts", "mdbc-2022", "mdbc-2025", "distance-ratio")


def smooth_step(t: Array) -> Array:
    """3 t^2 - 2 t^3, 0 <= t <= 1."""
    t = np.clip(t, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def faded(s: "Plain", pressure: Array) -> Array | float:
    """Max(S[(phi - 0.35)/0.3], S[p_G/p_1]), of ghosts that are filled from the fluid."""
    drawn, at_ghost = s.walls.drawn, s.treatment in AT_THE_GHOST or s.case.interpolator.name == "adami"
    if s.treatment not in AT_THE_GHOST + AT_THE_MIRROR:
        return 1.0
    offset = s.walls.nearest(drawn.position[None] - (drawn.position if at_ghost else drawn.mirror)[:, None])
    full = 1.0 - s.kernel.value(np.linalg.norm(offset, axis=2)) @ drawn.volume
    filled = s.around(s.walls.ghost if at_ghost else s.walls.mirror).parts.sum(axis=1)
    by_pressure = smooth_step(pressure / (0.01 * s.rho0 * s.c0**2))
    told = full > 0.05
    by_filling = smooth_step((filled / np.where(told, full, 1.0) - 0.35) / 0.3)
    return np.where(told, np.maximum(by_filling, by_pressure), 1.0)


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
