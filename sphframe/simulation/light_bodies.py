"""Simulation: bodies that are too light for the scheme are refused before the run.

The pressure at a wall follows the wall's acceleration within one evaluation, dp = -rho0 d a.n over a depth d of a share
of the particle spacing, and the acceleration of a body follows the pressure at the next. With the generalised normal
N = (n, r x n) at its wetted panels, and the acceleration C Q of the body under a load Q, a change of the acceleration
is multiplied from one evaluation to the next by

::

    -C K,    K = rho0 d int N N^T dA

The iteration converges if the largest eigenvalue of C K is below 1. With its masses multiplied by this eigenvalue, a
body is at the limit.
"""

import numpy as np

from sphframe.arrays import Array
from sphframe.boundary.boundary import Boundary
from sphframe.errors import InputError
from sphframe.geometry import Panels, moments
from sphframe.interfaces import RigidBody

DEPTH = 0.6
"""depth d over the particle spacing, measured with floating boxes that move in one direction"""
_LARGE = 1e6  # N, N m: at this load a body with a threshold moves


def check_weights(boundary: Boundary, panels: Panels, position: Array, spacing: float, density: float) -> None:
    """Check all bodies that move under their load.

    Parameters
    ----------
    panels
        of all walls, as drawn; ``position`` (n, dim) of the fluid particles, m; ``density`` rho0, kg/m^3.

    Raises
    ------
    InputError
        when a body is too light; the message has the least mass.
    """
    from scipy.spatial import cKDTree

    wet = cKDTree(position).query(panels.centre, distance_upper_bound=spacing)[0] < np.inf
    for k, (name, body) in enumerate(boundary.bodies.items()):
        own = wet & (boundary.wall_body[panels.wall] == k)
        if not body.needs_load or not np.any(own):
            continue
        area = panels.area[own]
        normals = np.column_stack([area, moments(panels.centre[own] - boundary.centres[k], area)])
        response = density * DEPTH * spacing * (normals.T / np.linalg.norm(area, axis=1)) @ normals
        factor = float(np.abs(np.linalg.eigvals(_compliance(body, len(response)) @ response)).max())
        if factor >= 1.0:
            mass = getattr(body, "mass", None)
            least = f"its mass is {mass:.3g}, and the least is {factor * mass:.3g}; " if mass else ""
            raise InputError(
                f"body {name!r} is too light for particle_spacing = {spacing:g} m, and would be thrown about by its own"
                f" acceleration: {least}multiply mass and inertia by {factor:.3g}, or choose a smaller spacing"
            )


def _compliance(body: RigidBody, size: int) -> Array:
    """Return the change (size, size) of the acceleration with each component of the load."""
    known = size if body.rotates_in_3d else 3
    rest, compliance = np.zeros(known), np.zeros((size, size))
    for k in range(known):
        loads = np.zeros((2, known))
        loads[:, k] = _LARGE, _LARGE + 1.0
        low, high = (body.motion(0.0, rest, rest, load).acceleration[:known] for load in loads)
        compliance[:known, k] = high - low
    return compliance
