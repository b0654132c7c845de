"""Testing: what a method makes of errors of the particles, at ghosts of each depth behind a wall."""

from typing import NamedTuple

import numpy as np

from sphframe.boundary.operator import operator
from sphframe.interfaces import BoundaryInterpolator, EvaluationPoint, Kernel, Status

DEPTHS = (0.5, 1.5, 2.5)
"""of the layers of ghosts, over the particle spacing"""
_DISORDER = 0.1
"""largest displacement of the particles from their lattice, over the spacing"""


class GhostResponse(NamedTuple):
    """Means over the ghosts of one layer behind a flat bed, below a disturbed lattice in 2-D.

    Attributes
    ----------
    depth
        of the layer, over the particle spacing dx.
    error
        of the pressure of water at rest without hydrostatic lift, (sum_j Phi_j p_j - p)/(rho g dx).
    noise
        (sum_j Phi_j^2)^(1/2), the factor by which independent errors of the particles are transferred to the ghost.
    outlier
        the largest absolute weight, the part of the error of a single particle that reaches the ghost.
    fallback
        share of ghosts with the fallback, status TOO_FEW or SINGULAR.
    """

    depth: float
    error: float
    noise: float
    outlier: float
    fallback: float


def ghost_responses(
    method: BoundaryInterpolator, kernel: str | Kernel = "gaussian", smoothing_length_ratio: float = 1.3
) -> tuple[GhostResponse, ...]:
    """Return the response of the ghosts of each layer to errors of the particles.

    Parameters
    ----------
    method
        the interpolation method.
    kernel, smoothing_length_ratio
        the kernel, and h over the particle spacing.

    Raises
    ------
    BrokenPluginError
        the method violates its contract.
    """
    x, y = np.meshgrid(np.arange(80) + 0.5, np.arange(8) + 0.5)
    disorder = np.random.default_rng(1).uniform(-_DISORDER, _DISORDER, (x.size, 2))
    water = np.column_stack([x.ravel(), y.ravel()]) + disorder
    where = method.traits.evaluation_point
    responses = []
    for depth in DEPTHS:
        mirror = np.column_stack([np.linspace(20.0, 60.0, 401), np.full(401, depth)])
        ghost = mirror * [1.0, -1.0]
        points = ghost if where is EvaluationPoint.GHOST else mirror
        lift = ghost - mirror if where is EvaluationPoint.EXTRAPOLATED else None
        matrix, status = operator(
            method, points, water, 1.0, smoothing_length=smoothing_length_ratio, kernel=kernel, lift=lift
        )
        height = ghost[:, 1] if where is EvaluationPoint.EXTRAPOLATED else points[:, 1]
        weights = abs(matrix)
        responses.append(
            GhostResponse(
                depth,
                float(np.mean(height - matrix @ water[:, 1])),
                float(np.mean(np.sqrt(weights.power(2).sum(axis=1)))),
                float(np.mean(weights.max(axis=1).toarray())),
                float(np.mean((status == Status.TOO_FEW) | (status == Status.SINGULAR))),
            )
        )
    return tuple(responses)
