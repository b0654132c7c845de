"""Testing: the ghosts that the solver fills in a small pool, compared with those of the operator."""

import numpy as np

from sphframe.arrays import Array
from sphframe.boundary.boundary import Boundary
from sphframe.boundary.filling import Filling
from sphframe.boundary.fixed_ghosts import FixedGhosts
from sphframe.boundary.operator import operator
from sphframe.geometry import Box, PolygonWall
from sphframe.interfaces import BoundaryInterpolator, WallContext
from sphframe.kernels import compiled_kernel
from sphframe.neighbours import NeighbourLists
from sphframe.particles import Columns
from sphframe.physics import LoopParameters
from sphframe.registry import create
from sphframe.simulation.components import loop_parts
from sphframe.testing.evaluation import title
from sphframe.testing.proof import BrokenPromiseError

_SPACING = 0.01
_SMOOTHING_LENGTH = 1.3 * _SPACING
_HIGHEST_PRESSURE = 6000.0


def check_solver_agrees(method: BoundaryInterpolator, dim: int) -> None:
    """The solver fills ghosts with the values that :func:`sphframe.boundary.operator.operator` gives.

    The pool is two-dimensional: what the solver does with a method does not depend on the dimension.
    """
    if dim != 2:
        return
    boundary, rows = _filled_pool(method)
    n, columns = len(rows) - boundary.count, Columns.of(dim)
    matrix, statuses = operator(
        method,
        boundary.points,
        rows[:n, columns.position],
        rows[:n, columns.volume],
        smoothing_length=_SMOOTHING_LENGTH,
        lift=boundary.lift_of_weights,
    )
    for g in np.flatnonzero(statuses != boundary.statuses)[:1]:
        raise BrokenPromiseError(
            f"{title(method)}: in the solver the status of the ghost at {boundary.position[g].tolist()} is"
            f" {boundary.statuses[g]}, in operator() it is {statuses[g]}: weights must depend on their arguments alone"
        )
    expected = np.maximum(matrix @ rows[:n, columns.pressure], 0.0)  # negative pressures are clipped to zero
    ghosts = rows[n:, columns.pressure]
    slack = 1e-9 * _HIGHEST_PRESSURE * np.maximum(1.0, np.abs(matrix).sum(axis=1))
    for g in np.flatnonzero(~(np.abs(ghosts - expected) <= slack))[:1]:
        raise BrokenPromiseError(
            f"{title(method)}: the solver gives the ghost at {boundary.position[g].tolist()} a pressure of"
            f" {ghosts[g]:.12g} Pa, operator() {expected[g]:.12g} Pa: weights must depend on their arguments alone"
        )


def _filled_pool(method: BoundaryInterpolator) -> tuple[Boundary, Array]:
    """A jittered pool with a free surface in the corner of two walls, without gravity; its ghosts are filled."""
    columns = Columns.of(2)
    chosen = create("kernels", "gaussian")
    kernel = compiled_kernel(chosen, 2)
    support = chosen.support * _SMOOTHING_LENGTH
    boundary = Boundary(
        [PolygonWall(points=((0.0, 0.2), (0.0, 0.0), (0.3, 0.0)))],
        {},
        method.traits.evaluation_point,
        fluid=[Box(lower=(0.0, 0.0), upper=(14 * _SPACING, 7 * _SPACING))],
        spacing=_SPACING,
        support=support,
        no_slip=False,
    )
    parts = loop_parts(kernel, create("equations_of_state", "linear"), 2)
    context = WallContext(kernel, 2, method, no_slip=False, balanced_lift=True, corrected_velocity=True)
    filling = Filling(method, kernel, parts, FixedGhosts().parts(context))
    fluid = _fluid_rows(columns)
    n = len(fluid)
    rows = np.concatenate([fluid, columns.zeros(boundary.count)])
    lists = NeighbourLists(2, n, boundary.count, support, 0.1 * support)
    rows[:n] = rows[lists.sort(rows)]
    boundary.move([], rows[n:], np.zeros(2), 1000.0)
    lists.build(rows, boundary.points)
    parameters = LoopParameters.of(
        kernel, 2, smoothing_length=_SMOOTHING_LENGTH, reference_density=1000.0, sound_speed=40.0
    )
    filling(rows, lists, boundary, parameters)
    return boundary, rows


def _fluid_rows(columns: Columns) -> Array:
    """Rows of 14 by 7 particles in random order, with pressures between 5 and 6 kPa."""
    rng = np.random.default_rng(5)
    x, y = np.meshgrid(np.arange(14), np.arange(7), indexing="ij")
    position = (np.column_stack([x.ravel(), y.ravel()]) + 0.5 + rng.uniform(-0.2, 0.2, (x.size, 2))) * _SPACING
    position = position[rng.permutation(len(position))]
    rows: Array = columns.zeros(len(position))
    rows[:, columns.position] = position
    rows[:, columns.velocity] = rng.normal(size=position.shape)
    rows[:, columns.density] = 1000.0
    rows[:, columns.pressure] = 5000.0 + rng.uniform(0.0, _HIGHEST_PRESSURE - 5000.0, len(position))
    rows[:, columns.volume] = _SPACING**2 * rng.uniform(0.9, 1.1, len(position))
    return rows
