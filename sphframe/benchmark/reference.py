"""Benchmark: two simple loops, whose time on a machine is the reference for that of the solver.

The loops go over one list of neighbours per particle, with rows of eight numbers (64 bytes), in two dimensions. One
computes the density gradient, the other the rates of continuity, with diffusion, and of momentum. They contain no
neighbour search, no skin, no boundary and no equation of state. They compute the same numbers as the solver.
"""

from functools import cached_property

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from sphframe.arrays import Array
from sphframe.compiled import fast_exp
from sphframe.simulation import Simulation


class BareLoops:
    """The reference loops on the present state of a two-dimensional simulation with the Gaussian kernel.

    Attributes
    ----------
    order
        (n,) numbers of the fluid particles in spatial order; row i holds the particle ``order[i]``.
    gradient
        (n, 2) density gradient, kg/m^4; ``rates`` (n, 3) accelerations, m/s^2, and density rate, kg/(m^3 s).
    """

    def __init__(self, simulation: Simulation) -> None:
        fluid, ghosts, p = simulation.fields(), simulation.ghost_fields(), simulation.parameters
        n, reach = len(fluid.density), p.support
        cell = np.floor(fluid.position / reach)
        self.order = np.lexsort((fluid.position[:, 1], cell[:, 0]))
        self.rows = np.zeros((n + len(ghosts.density), 8))
        for rows, part, volume in (
            (self.rows[:n], [field[self.order] for field in fluid], (simulation.masses() / fluid.density)[self.order]),
            (self.rows[n:], list(ghosts), simulation.boundary.volume),
        ):
            rows[:, 0:2], rows[:, 2:4], rows[:, 4], rows[:, 5] = part
            rows[:, 6] = volume
        self.lists, self.fluid_counts, self.counts = _neighbours(self.rows[:, :2], n, reach)
        self.gradient, self.rates = np.zeros((n, 2)), np.zeros((n, 3))
        self._per_h2, self._scale = 1.0 / p.smoothing_length**2, p.gradient_scale
        self._numbers = (p.diffusion, p.viscosity, p.gravity)

    def find_gradient(self) -> None:
        """Renormalised density gradient."""
        _gradient(self.rows, self.lists, self.fluid_counts, self._per_h2, self._scale, self.gradient)

    def find_rates(self) -> None:
        """Accelerations and density rates."""
        _rates(
            self.rows, self.gradient, self.lists, self.fluid_counts, self.counts, self._per_h2, self._scale,
            *self._numbers, self.rates,
        )  # fmt: skip

    @cached_property
    def neighbours(self) -> float:
        """Mean number of neighbours within the kernel support, ghosts included."""
        return float(self.counts.mean())


def _neighbours(
    position: Array, fluid_count: int, reach: float
) -> tuple[NDArray[np.uint32], NDArray[np.uint32], NDArray[np.uint32]]:
    """Lists (n, most) of rows within ``reach``, fluid first, and the numbers (n,) of fluid and of all in them."""
    pairs = cKDTree(position).query_pairs(reach, output_type="ndarray")
    i, j = np.concatenate([pairs, pairs[:, ::-1]]).T
    i, j = i[i < fluid_count], j[i < fluid_count]
    sequence = np.lexsort((j, i))
    i, j = i[sequence], j[sequence]
    counts = np.bincount(i, minlength=fluid_count)
    starts = np.cumsum(counts) - counts
    lists = np.zeros((fluid_count, counts.max()), np.uint32)
    lists[i, np.arange(len(i)) - starts[i]] = j
    fluid = np.bincount(i[j < fluid_count], minlength=fluid_count)
    return lists, fluid.astype(np.uint32), counts.astype(np.uint32)


_FREE_SUMS = {"contract", "reassoc", "nsz"}
"""the compiler may choose the order of sums; otherwise it does not vectorise the loops"""


@numba.njit(parallel=True, cache=True, error_model="numpy", fastmath=_FREE_SUMS)
def _gradient(rows, lists, counts, per_h2, scale, gradient):  # type: ignore[no-untyped-def]
    for i in numba.prange(gradient.shape[0]):
        bx = by = xx = xy = yy = 0.0
        for k in range(counts[i]):
            j = lists[i, k]
            dx = rows[j, 0] - rows[i, 0]
            dy = rows[j, 1] - rows[i, 1]
            weight = 2.0 * scale * fast_exp(-(dx * dx + dy * dy) * per_h2) * rows[j, 6]
            rise = weight * (rows[j, 4] - rows[i, 4])
            bx += rise * dx
            by += rise * dy
            xx += weight * dx * dx
            xy += weight * dx * dy
            yy += weight * dy * dy
        determinant = xx * yy - xy * xy
        if determinant > 0.02 * (0.5 * (xx + yy)) ** 2:
            gradient[i, 0] = (yy * bx - xy * by) / determinant
            gradient[i, 1] = (xx * by - xy * bx) / determinant
        else:
            gradient[i, 0] = bx
            gradient[i, 1] = by


@numba.njit(error_model="numpy", forceinline=True)
def _pair(rows, i, j, per_h2, scale, viscosity):  # type: ignore[no-untyped-def]
    """Offset, weight, weight times approach, and weight times stress."""
    dx = rows[j, 0] - rows[i, 0]
    dy = rows[j, 1] - rows[i, 1]
    r2 = dx * dx + dy * dy
    weight = 2.0 * scale * fast_exp(-r2 * per_h2) * rows[j, 6]
    approach = (rows[j, 2] - rows[i, 2]) * dx + (rows[j, 3] - rows[i, 3]) * dy
    stress = viscosity * approach / r2 - rows[i, 5] - rows[j, 5]
    return dx, dy, weight, weight * approach, weight * stress


@numba.njit(parallel=True, cache=True, error_model="numpy", fastmath=_FREE_SUMS)
def _rates(rows, gradient, lists, fluid_counts, counts, per_h2, scale, diffusion, viscosity, gravity, rates):  # type: ignore[no-untyped-def]
    for i in numba.prange(rates.shape[0]):
        fx = fy = compression = diffused = 0.0
        for k in range(fluid_counts[i]):
            j = lists[i, k]
            dx, dy, weight, approach, stress = _pair(rows, i, j, per_h2, scale, viscosity)
            sloped = (gradient[i, 0] + gradient[j, 0]) * dx + (gradient[i, 1] + gradient[j, 1]) * dy
            diffused += weight * (2.0 * (rows[j, 4] - rows[i, 4]) - sloped)
            compression += approach
            fx += stress * dx
            fy += stress * dy
        for k in range(fluid_counts[i], counts[i]):  # ghosts: no diffusion through walls
            dx, dy, weight, approach, stress = _pair(rows, i, lists[i, k], per_h2, scale, viscosity)
            compression += approach
            fx += stress * dx
            fy += stress * dy
        rates[i, 0] = fx / rows[i, 4]
        rates[i, 1] = fy / rows[i, 4] - gravity
        rates[i, 2] = diffusion * diffused - rows[i, 4] * compression
