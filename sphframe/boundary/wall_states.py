"""Boundary: densities of wall particles that have an equation of their own, advanced together with the fluid."""

import math
from typing import Any

import numba
import numpy as np

from sphframe.arrays import Array
from sphframe.boundary.boundary import Boundary
from sphframe.boundary.ghosts import CHUNKS
from sphframe.boundary.wall_arrays import wall_point
from sphframe.compiled import nearest, specialise
from sphframe.compiled.stand_ins import COLUMNS, DIM, GRADIENT, PERIODIC, RATE, SUPPORT
from sphframe.interfaces import Neighbours, RateFunction
from sphframe.neighbours import NeighbourLists
from sphframe.physics import LoopParameters


class WallStates:
    """The states (g,) of the wall particles of ``boundary``, which the function ``rate`` of a treatment advances.

    Without ``rate`` nothing is done. ``parts``: the compiled parts of the loops, by name.
    """

    def __init__(self, boundary: Boundary, rate: RateFunction | None, parts: dict[str, Any]) -> None:
        self._state = np.zeros(0) if rate is None else boundary.wall_state
        self._boundary = boundary
        self._rates, self._start, self.total = (np.zeros_like(self._state) for _ in range(3))
        self._loop = None if rate is None else specialise(wall_rates, {**parts, "RATE": rate})
        self._scalars, self._vectors = np.empty((CHUNKS, 8, 5)), np.empty((CHUNKS, 2, 8, boundary.dim))

    @property
    def needed(self) -> bool:
        """Whether the treatment advances them."""
        return self._loop is not None

    def evaluate(self, rows: Array, lists: NeighbourLists, parameters: LoopParameters) -> None:
        """Compute the rates from the fluid in ``rows``."""
        if self._loop is not None:
            capacity = lists.points.shape[1]
            if capacity > self._scalars.shape[1]:
                self._scalars = np.empty((CHUNKS, capacity, 5))
                self._vectors = np.empty((CHUNKS, 2, capacity, self._boundary.dim))
            self._rates[:] = 0.0
            self._loop(
                rows, lists.near, lists.points, lists.point_counts, self._boundary.points, self._boundary.lifts,
                self._boundary.arrays, parameters, self._scalars, self._vectors, self._rates,
            )  # fmt: skip

    def hold(self) -> None:
        """Remember the states as the start of the step."""
        self._start[:], self.total[:] = self._state, 0.0

    def advance(self, interval: float) -> None:
        """y = y0 + interval * f."""
        self._state[:] = self._start + interval * self._rates

    def accumulate(self, weight: float) -> None:
        """total = total + weight * f."""
        self.total += weight * self._rates

    def advance_total(self, interval: float) -> None:
        """y = y0 + interval * total."""
        self._state[:] = self._start + interval * self.total

    def update_density(self, interval: float) -> None:
        """y = y + interval * f."""
        self._state += interval * self._rates


def wall_rates(  # type: ignore[no-untyped-def]
    rows, ghosts, lists, counts, points, lifts, walls, parameters, scalars, vectors, rates
):
    """Write the rates of the states of ``ghosts`` (k,), of the wall particles at ``points`` (g, dim), to ``rates``.

    ``walls``: :class:`WallArrays`; ``scalars`` (chunks, capacity, 5) and ``vectors`` (chunks, 2, capacity, dim) are
    scratch.
    """
    limit = parameters.support * parameters.support
    per_h2 = SUPPORT * SUPPORT / limit
    chunks = scalars.shape[0]
    for chunk in numba.prange(chunks):
        distances, slopes, volumes = scalars[chunk, :, 0], scalars[chunk, :, 1], scalars[chunk, :, 2]
        pressures, densities = scalars[chunk, :, 3], scalars[chunk, :, 4]
        offsets, velocities = vectors[chunk, 0], vectors[chunk, 1]
        for place in range(chunk * ghosts.shape[0] // chunks, (chunk + 1) * ghosts.shape[0] // chunks):
            g = ghosts[place]
            n = 0
            for k in range(counts[place]):
                j = lists[place, k]
                r2 = 0.0
                for d in range(DIM):
                    offsets[n, d] = rows[j, d] - points[g, d]
                    if PERIODIC:
                        offsets[n, d] = nearest(offsets[n, d], parameters, d)
                    velocities[n, d] = rows[j, COLUMNS.u + d]
                    r2 += offsets[n, d] * offsets[n, d]
                distances[n] = math.sqrt(r2)
                slopes[n] = parameters.gradient_scale * GRADIENT(r2 * per_h2)
                volumes[n] = rows[j, COLUMNS.volume]
                pressures[n] = rows[j, COLUMNS.pressure]
                densities[n] = rows[j, COLUMNS.density]
                n += 1 if r2 < limit else 0
            if n > 0:
                near = Neighbours(
                    offsets[:n], distances[:n], slopes[:n], volumes[:n], pressures[:n], densities[:n], velocities[:n]
                )
                rates[g] = RATE(near, wall_point(walls, lifts, g), parameters)
