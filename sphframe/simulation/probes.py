"""Simulation: pressure probes and free-surface gauges, and the points at which they sample the fluid."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.cases import Gauge, Probe
from sphframe.errors import InputError
from sphframe.geometry import to_world
from sphframe.interfaces import Motion

_NODES, _NODE_WEIGHTS = np.polynomial.legendre.leggauss(9)


class Readings(NamedTuple):
    """Pressure at each probe (p,), Pa, 0 where it is dry; whether each is ``wet`` (p,)."""

    pressure: Array
    wet: BoolArray


class GaugeReadings(NamedTuple):
    """At each gauge: ``elevation`` of the surface, m, NaN where dry; ``depth``, the length of its line in water, m."""

    elevation: Array
    depth: Array


class PressureProbes:
    """Pressure sensors: points, and discs that average over the chord at each height.

    A disc of radius a centred on a wall averages max(p(s), 0) over its diameter with the chord length as weight,
    (2 / (pi a^2)) int max(p(s), 0) sqrt(a^2 - s^2) ds, s along the wall. Negative pressures are clipped to zero, as
    those of the ghosts are: water separates from an instrument in the wall. At a point, they are not clipped.

    A point is wet where the kernel's filling by fluid is at least half of what the walls leave of it at the start, as
    below a level surface. Elsewhere its pressure is 0. A disc is wet if at least half of its area is.

    Parameters
    ----------
    probes
        in ``dim`` dimensions; a probe with a body is carried by it, one of the names ``bodies``.

    Attributes
    ----------
    points
        (k, dim) as drawn, m.
    """

    def __init__(self, probes: Sequence[Probe], dim: int, bodies: Sequence[str] = ()) -> None:
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
                raise InputError(f"probe {probe.name!r} is a disc: give its tangent, a direction along the wall")
            tangent = np.array(probe.tangent) / np.linalg.norm(probe.tangent)
            chords = _NODE_WEIGHTS * np.sqrt(1.0 - _NODES**2)
            for node, chord in zip(_NODES, chords / chords.sum(), strict=True):
                points.append(centre + probe.radius * node * tangent)
                weights.append((index, float(chord)))
        self.points = np.array(points).reshape(-1, dim)
        self._body = _indices([probes[index].body for index, _ in weights], bodies)
        self._average = np.zeros((len(probes), len(points)))
        self._lowest = np.full(len(points), -np.inf)
        for column, (index, weight) in enumerate(weights):
            self._average[index, column] = weight
            if probes[index].radius > 0.0:
                self._lowest[column] = 0.0

    def present_points(self, motions: Sequence[Motion], centres: Array) -> Array:
        """Return the points (k, dim), m, at present, with the ``motions`` of the bodies about their ``centres``."""
        present = self.points.copy()
        for body in np.unique(self._body[self._body >= 0]):
            own = self._body == body
            present[own] = to_world(self.points[own], motions[body].position, centres[body])
        return present

    def readings(self, pressures: Array, fillings: Array, solid: Array) -> Readings:
        """Return what the probes read from pressures (k,), Pa, and fillings (k,) at the points.

        ``solid`` (k,): share of the kernel within walls.
        """
        wet = fillings >= 0.5 * np.maximum(1.0 - solid, 0.1)
        pressure: Array = self._average @ np.where(wet, np.maximum(pressures, self._lowest), 0.0)
        return Readings(pressure, self._average @ wet >= 0.5 - 1e-9)


class Gauges:
    """Free-surface gauges: the highest point of a vertical line where the filling passes one half, and how much is wet.

    Spray and sheets of water above the surface count for the elevation, and with their thickness for the depth, which
    is what a wire gauge measures. The filling is linear between points that are a ``resolution``, m, apart.

    A gauge with a body moves along with the displacement of its centre; its line remains vertical.
    """

    def __init__(
        self, gauges: Sequence[Gauge], lower: Array, upper: Array, resolution: float, bodies: Sequence[str] = ()
    ) -> None:
        dim = len(lower)
        self._heights = np.arange(lower[-1], upper[-1] + resolution, resolution)
        self._body = _indices([gauge.body for gauge in gauges], bodies)
        lines = []
        for gauge in gauges:
            if len(gauge.position) != dim - 1:
                raise InputError(
                    f"gauge {gauge.name!r} has position {gauge.position}; give the {dim - 1} horizontal coordinate(s)"
                )
            lines.append(np.column_stack([np.tile(gauge.position, (len(self._heights), 1)), self._heights]))
        self.points = np.array(lines).reshape(-1, dim)
        self._count = len(gauges)

    def present_points(self, motions: Sequence[Motion]) -> Array:
        """Return the points (k, dim), m, of all lines at present."""
        lines = self.points.reshape(self._count, len(self._heights), self.points.shape[1]).copy()
        for line, body in zip(lines, self._body, strict=True):
            if body >= 0:
                line[:, :-1] += motions[body].position[: lines.shape[2] - 1]
        return lines.reshape(self.points.shape)

    def readings(self, fillings: Array) -> GaugeReadings:
        """Return what the gauges read from the ``fillings`` (points,)."""
        excess = fillings.reshape(self._count, len(self._heights)) - 0.5
        wet, size = np.maximum(excess, 0.0), np.abs(excess)
        lengths = np.diff(self._heights) * (wet[:, :-1] + wet[:, 1:]) / np.maximum(size[:, :-1] + size[:, 1:], 1e-300)
        last, gauges = excess.shape[1] - 1 - np.argmax(excess[:, ::-1] >= 0.0, axis=1), np.arange(self._count)
        ends = (excess[gauges, last] >= 0.0) & (last + 1 < len(self._heights))
        tops = self._heights[last] + lengths[gauges, np.minimum(last, len(self._heights) - 2)]
        return GaugeReadings(np.where(ends, tops, np.nan), lengths.sum(axis=1))


def _indices(names: Sequence[str | None], bodies: Sequence[str]) -> IntArray:
    """Return the index of each named body, -1 for None."""
    return np.array([-1 if name is None else list(bodies).index(name) for name in names], np.int64)
