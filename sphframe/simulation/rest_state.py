"""Simulation: the compressible rest state, the default initial state of a case."""

from typing import Any

import numpy as np

from sphframe.arrays import Array


def pressure_at_depth(
    depth: Array, density: Any, reference_density: float, sound_speed: float, gravity: float
) -> Array:
    """Return the pressure (Pa) at ``depth`` (m) below the surface at rest, from dp/ddepth = rho(p) g and p(0) = 0.

    For the linear equation of state this is rho0 c0^2 (exp(g depth / c0^2) - 1). ``density`` is the inverse equation
    of state, rho(p, rho0, c0). Above the surface the pressure is zero.
    """
    deepest = float(np.max(depth, initial=0.0))
    if deepest <= 0.0 or gravity == 0.0:
        return np.zeros_like(depth)
    from scipy.integrate import solve_ivp  # slow to import, and not needed by cases that give their initial pressure

    solution = solve_ivp(
        lambda _, p: [density(p[0], reference_density, sound_speed) * gravity],
        (0.0, deepest),
        [0.0],
        rtol=1e-11,
        atol=1e-9 * reference_density * gravity * deepest,
        dense_output=True,
    )
    return np.where(depth > 0.0, solution.sol(np.maximum(depth, 0.0))[0], 0.0)
