"""Simulation: pressure probes and free-surface gauges, and the points at which they sample the fluid."""

from collections.abc import Sequence

import numpy as np

from sphframe.arrays import Array
from sphframe.cases import Gauge, Probe
from sphframe.errors import InputError

_NODES, _NODE_WEIGHTS = np.polynomial.legendre.leggauss(9)


class PressureProbes:
    """Pressure sensors: points, and discs that average over the chord at each height.

    A disc of radius a centred on a wall averages max(p(s), 0) over its diameter with the chord length as weight,
    (2 / (pi a^2)) int max(p(s), 0) sqrt(a^2 - s^2) ds, s along the wall. Negative pressures are clipped to zero, as
    those of the ghosts are: water separates from an instrument in the wall. At a point, they are not clipped.
    """

    def __init__(self, probes: Sequence[Probe], dim: int) -> None:
        points: list[Array] = []
        weights: list[tuple[int, float]] = []
        for index, probe in enumerate(probes):
            centre = np.array(probe.position, dtype=np.float64)
            if centre.shape != (dim,):
                raise InputError(f"probe {probe.name!r} is at {probe.position}, but the case has {dim} dimensions")
            if probe.radius == 0.0:
                points.append(centre)
                weights.append((index, 1.0))
                continue
            if probe.tangent is None or len(probe.tangent) != dim:
                raise InputError(f"probe {probe.name!r} is a disc: give its tangent, a unit vector along the wall")
            chords = _NODE_WEIGHTS * np.sqrt(1.0 - _NODES**2)
            for node, chord in zip(_NODES, chords / chords.sum(), strict=True):
                points.append(centre + probe.radius * node * np.array(probe.tangent))
                weights.append((index, float(chord)))
        self.points = np.array(points).reshape(-1, dim)
        self._average = np.zeros((len(probes), len(points)))
        self._lowest = np.full(len(points), -np.inf)
        for column, (index, weight) in enumerate(weights):
            self._average[index, column] = weight
            if probes[index].radius > 0.0:
                self._lowest[column] = 0.0

    def average(self, pressures: Array) -> Array:
        """Return one value per probe from ``pressures`` (points,), Pa."""
        averages: Array = self._average @ np.maximum(pressures, self._lowest)
        return averages


class Gauges:
    """Free-surface elevation gauges: the highest point of a vertical line where the filling passes one half."""

    def __init__(self, gauges: Sequence[Gauge], lower: Array, upper: Array, resolution: float) -> None:
        dim = len(lower)
        self._heights = np.arange(lower[-1], upper[-1] + resolution, resolution)
        lines = []
        for gauge in gauges:
            if len(gauge.position) != dim - 1:
                raise InputError(
                    f"gauge {gauge.name!r} has position {gauge.position}; give the {dim - 1} horizontal coordinate(s)"
                )
            line = np.empty((len(self._heights), dim))
            line[:, :-1] = gauge.position
            line[:, -1] = self._heights
            lines.append(line)
        self.points = np.array(lines).reshape(-1, dim)
        self._count = len(gauges)

    def elevations(self, fillings: Array) -> Array:
        """Return the elevation at each gauge, m, NaN where dry, from ``fillings`` (points,)."""
        elevations = np.full(self._count, np.nan)
        for index, filling in enumerate(fillings.reshape(self._count, -1) if self._count else []):
            wet = np.flatnonzero(filling >= 0.5)
            if len(wet) and wet[-1] + 1 < len(filling):
                k = wet[-1]
                part = (filling[k] - 0.5) / (filling[k] - filling[k + 1])
                elevations[index] = self._heights[k] + part * (self._heights[k + 1] - self._heights[k])
        return elevations
