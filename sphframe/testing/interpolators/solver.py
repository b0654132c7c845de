"""Testing: the ghosts that the solver fills in a small pool, compared with those of the operator."""

import numpy as np

from sphframe.arrays import Array
from sphframe.boundary.boundary import Boundary
from sphframe.boundary.filling import Filling
from sphframe.boundary.fixed_ghosts import FixedGhosts
from sphframe.boundary.operator import operator
from sphframe.geometry import Box, PolygonWall
from sphframe.interfaces import BoundaryInterpolator, CompiledKernel, Traits, WallContext, WeightsFunction
from sphframe.interfaces.traits import DRY, OK
from sphframe.kernels import compiled_kernel
from sphframe.neighbours import NeighbourLists
from sphframe.particles import Columns
from sphframe.physics import LoopParameters
from sphframe.registry import create
from sphframe.simulation.components import loop_parts
from sphframe.testing.evaluation import extrapolates, title
from sphframe.testing.proof import BrokenPromiseError

_SPACING = 0.01
_HIGHEST_PRESSURE = 6000.0


def check_solver_agrees(method: BoundaryInterpolator, dim: int) -> None:
    """The solver fills ghosts with the values that :func:`sphframe.boundary.operator.operator` gives.

    The pool is two-dimensional: what the solver does with a method does not depend on the dimension. Its walls have no
    slip: a ghost has the pressure that is interpolated to it, and the velocity that is interpolated to its evaluation
    point, reversed. The smoothing length is once that of most runs, and once so large that there are more than 300
    neighbours, in a pool of twice the size.
    """
    if dim != 2:
        return
    for ratio, depth in ((1.3, 7), (4.0, 14)):
        _compare_pool(method, ratio * _SPACING, depth)


def _compare_pool(method: BoundaryInterpolator, smoothing_length: float, depth: int) -> None:
    boundary, rows = _filled_pool(method, smoothing_length, depth)
    n, columns = len(rows) - boundary.count, Columns.of(2)
    fluid, ghosts, lift = rows[:n], rows[n:], boundary.lift_of_weights
    around = fluid[:, columns.position], fluid[:, columns.volume]
    matrix, statuses = operator(method, boundary.points, *around, smoothing_length=smoothing_length, lift=lift)
    for g in np.flatnonzero(statuses != boundary.statuses)[:1]:
        raise BrokenPromiseError(
            f"{title(method)}: in the solver the status of the ghost at {boundary.position[g].tolist()} is"
            f" {boundary.statuses[g]}, in operator() it is {statuses[g]}: weights must depend on their arguments alone"
        )
    by_velocity = FixedGhosts().velocity_interpolator(method) or method
    if extrapolates(method):  # where the pressure takes the fallback, so does the velocity
        at_mirror = operator(method, boundary.points, *around, smoothing_length=smoothing_length)[0]
        fallen = operator(_Fallback(method), boundary.points, *around, smoothing_length=smoothing_length)[0]
        ok = (statuses == OK).astype(np.float64)
        average = at_mirror.multiply(ok[:, None]) + fallen.multiply(1.0 - ok[:, None])
    else:
        average = matrix
        if by_velocity is not method:
            average = operator(by_velocity, boundary.points, *around, smoothing_length=smoothing_length)[0]
    pressure = np.maximum(matrix @ fluid[:, columns.pressure], 0.0)  # negative pressures are clipped to zero
    wet = np.where(statuses == DRY, 0.0, 1.0)[:, None]
    velocity = -(average @ fluid[:, columns.velocity]) * wet
    noise = np.maximum(1.0, np.maximum(np.abs(matrix).sum(axis=1), np.abs(average).sum(axis=1)))
    for what, unit, given, expected, scale in (
        ("pressure", "Pa", ghosts[:, [columns.pressure]], pressure[:, None], _HIGHEST_PRESSURE),
        ("velocity", "m/s", ghosts[:, columns.velocity], velocity, 1.0),
    ):
        wrong = ~(np.abs(given - expected) <= 1e-9 * scale * noise[:, None]).all(axis=1)
        for g in np.flatnonzero(wrong)[:1]:
            raise BrokenPromiseError(
                f"{title(method)}: with {np.diff(matrix.indptr)[g]} neighbours the solver gives the ghost at"
                f" {boundary.position[g].tolist()} the {what} {given[g].tolist()} {unit}, operator()"
                f" {expected[g].tolist()} {unit}: weights must depend on their arguments alone"
            )


class _Fallback(BoundaryInterpolator):
    """The fallback of a method as a method."""

    traits = Traits()

    def __init__(self, method: BoundaryInterpolator) -> None:
        self._method = method

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        return self._method.fallback_weights(kernel, dim)


def check_shear(method: BoundaryInterpolator, dim: int) -> None:
    """A shear flow u = y above a wall without slip gives all ghosts behind it a velocity against the flow."""
    if dim != 2:
        return
    boundary, rows = _filled_pool(method, 1.3 * _SPACING, shear=True)
    n, columns = len(rows) - boundary.count, Columns.of(2)
    ghosts, wet = rows[n:], boundary.statuses != DRY
    below = wet & (ghosts[:, 1] < 0.0) & (np.abs(ghosts[:, 0] - 7 * _SPACING) < 4 * _SPACING)
    for g in np.flatnonzero(below & (ghosts[:, columns.u] > 1e-12)):
        raise BrokenPromiseError(
            f"{title(method)}: in a shear flow u = y above a wall without slip the ghost at"
            f" {boundary.position[g].tolist()} gets the velocity u = {ghosts[g, columns.u]:.6g}, along with the flow:"
            " weights at the ghost that continue linear fields must declare reproduces_degree = 1"
        )


def _filled_pool(
    method: BoundaryInterpolator, smoothing_length: float, depth: int = 7, *, shear: bool = False
) -> tuple[Boundary, Array]:
    """A jittered pool with a free surface in the corner of two walls, without gravity; its ghosts are filled.

    It is ``depth`` particles deep and twice as long.
    """
    columns = Columns.of(2)
    chosen = create("kernels", "gaussian")
    kernel = compiled_kernel(chosen, 2)
    support = chosen.support * smoothing_length
    boundary = Boundary(
        [PolygonWall(points=((0.0, 0.2), (0.0, 0.0), (0.3, 0.0)))],
        {},
        method.traits.evaluation_point,
        fluid=[Box(lower=(0.0, 0.0), upper=(2 * depth * _SPACING, depth * _SPACING))],
        spacing=_SPACING,
        support=support,
        no_slip=True,
    )
    parts = loop_parts(kernel, create("equations_of_state", "linear"), 2)
    other = FixedGhosts().velocity_interpolator(method)
    context = WallContext(kernel, 2, method, no_slip=True, corrected_velocity=False, velocity_interpolator=other)
    filling = Filling(method, kernel, parts, FixedGhosts().parts(context), velocity_interpolator=other)
    fluid = _fluid_rows(columns, depth)
    if shear:
        fluid[:, columns.velocity] = fluid[:, [1]] * [1.0, 0.0]
    n = len(fluid)
    rows = np.concatenate([fluid, columns.zeros(boundary.count)])
    lists = NeighbourLists(2, n, boundary.count, support, 0.1 * support)
    rows[:n] = rows[lists.sort(rows)]
    boundary.move([], rows[n:], np.zeros(2), 1000.0)
    lists.build(rows, boundary.points)
    parameters = LoopParameters.of(
        kernel, 2, smoothing_length=smoothing_length, reference_density=1000.0, sound_speed=40.0
    )
    filling(rows, lists, boundary, parameters)
    return boundary, rows


def _fluid_rows(columns: Columns, depth: int) -> Array:
    """Rows of 2 ``depth`` by ``depth`` particles in random order, with pressures between 5 and 6 kPa."""
    rng = np.random.default_rng(5)
    x, y = np.meshgrid(np.arange(2 * depth), np.arange(depth), indexing="ij")
    position = (np.column_stack([x.ravel(), y.ravel()]) + 0.5 + rng.uniform(-0.2, 0.2, (x.size, 2))) * _SPACING
    position = position[rng.permutation(len(position))]
    rows: Array = columns.zeros(len(position))
    rows[:, columns.position] = position
    rows[:, columns.velocity] = rng.normal(size=position.shape)
    rows[:, columns.density] = 1000.0
    rows[:, columns.pressure] = 5000.0 + rng.uniform(0.0, _HIGHEST_PRESSURE - 5000.0, len(position))
    rows[:, columns.volume] = _SPACING**2 * rng.uniform(0.9, 1.1, len(position))
    return rows
