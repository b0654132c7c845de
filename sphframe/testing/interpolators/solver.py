"""Testing: the solver's own boundary on a small pool, against the operator."""

import numpy as np

from sphframe.boundary.boundary import Boundary
from sphframe.boundary.operator import compiled_kernel, operator
from sphframe.geometry import PolygonWall
from sphframe.interfaces import BoundaryInterpolator, EvaluationPoint
from sphframe.neighbours import NeighbourLists
from sphframe.particles import Columns
from sphframe.registry import create
from sphframe.testing.evaluation import title
from sphframe.testing.proof import BrokenPromiseError

__all__ = ["check_solver_agrees"]


def check_solver_agrees(method: BoundaryInterpolator, dim: int) -> None:
    """The solver fills ghosts with the values that :func:`sphframe.boundary.operator.operator` gives.

    A jittered pool with a free surface, in the corner of two walls, without gravity; what the solver does with a
    method does not depend on the dimension, so that only 2-D is run.
    """
    if dim != 2:
        return
    spacing = 0.01
    h = 1.3 * spacing
    rng = np.random.default_rng(5)
    x, y = np.meshgrid(np.arange(14), np.arange(7), indexing="ij")
    fluid = (np.column_stack([x.ravel(), y.ravel()]) + 0.5 + rng.uniform(-0.2, 0.2, (x.size, 2))) * spacing
    fluid = fluid[rng.permutation(len(fluid))]

    chosen = create("kernels", "gaussian")
    kernel = compiled_kernel(chosen, dim)
    support = chosen.support * h
    boundary = Boundary(
        [PolygonWall(points=((0.0, 0.2), (0.0, 0.0), (0.3, 0.0)))],
        {},
        method,
        kernel,
        create("equations_of_state", "linear"),
        spacing=spacing,
        support=support,
        no_slip=False,
        corrected=True,
        balanced=True,
    )
    columns = Columns(dim)
    n = len(fluid)
    rows = columns.empty(n + boundary.count)
    rows[:n, columns.position] = fluid
    rows[:n, columns.velocity] = rng.normal(size=(n, dim))
    rows[:n, columns.density] = 1000.0
    rows[:n, columns.pressure] = 5000.0 + rng.uniform(0.0, 1000.0, n)
    rows[:n, columns.volume] = spacing**dim * rng.uniform(0.9, 1.1, n)
    lists = NeighbourLists(dim, n, boundary.count, support, 0.1 * support)
    rows[:n] = rows[lists.sort(rows)]
    boundary.move([], rows[n:], np.zeros(dim), 1000.0)
    lists.build(rows, boundary.points)
    boundary.fill(
        rows, lists, kernel_scale=kernel.normalisation / h**dim, reference_density=1000.0, sound_speed=40.0
    )  # fmt: skip

    lift = boundary.lifts if method.traits.evaluation_point is EvaluationPoint.EXTRAPOLATED else None
    matrix, statuses = operator(
        method, boundary.points, rows[:n, columns.position], rows[:n, columns.volume], smoothing_length=h, lift=lift
    )
    expected = np.maximum(matrix @ rows[:n, columns.pressure], 0.0)  # walls do not pull
    ghosts = rows[n:, columns.pressure]
    differing = np.flatnonzero(statuses != boundary.statuses)
    if len(differing):
        g = int(differing[0])
        raise BrokenPromiseError(
            f"{title(method)}: in the solver the status of the ghost at {boundary.position[g].tolist()} is"
            f" {boundary.statuses[g]}, in operator() it is {statuses[g]}: weights must depend on their arguments alone"
        )
    slack = 1e-9 * 6000.0 * np.maximum(1.0, np.abs(matrix).sum(axis=1))
    wrong = np.flatnonzero(~(np.abs(ghosts - expected) <= slack))
    if len(wrong):
        g = int(wrong[0])
        raise BrokenPromiseError(
            f"{title(method)}: the solver gives the ghost at {boundary.position[g].tolist()} a pressure of"
            f" {ghosts[g]:.12g} Pa, operator() {expected[g]:.12g} Pa: weights must depend on their arguments alone"
        )
