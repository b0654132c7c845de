"""Simulation: a channel through which fluid flows: the state in its zones, and who enters and leaves."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from sphframe.arrays import Array, Arrays, BoolArray, IntArray
from sphframe.cases import Case, Scene
from sphframe.cases.open_boundaries import ChannelEnds, OpenBoundaries, channel_ends
from sphframe.compiled import specialise
from sphframe.errors import SimulationError
from sphframe.neighbours import NeighbourLists
from sphframe.particles import Columns
from sphframe.physics import LoopParameters, invert_pressure, update_pressure
from sphframe.physics.open_ends import fit_sums

_CROSSINGS = 5.0
"""times in which sound crosses the channel, over which the gradient of pressure at the inflow is smoothed"""


class OpenChannel:
    """Inflow and outflow of :mod:`sphframe.physics.open_ends`.

    Attributes
    ----------
    ends
        the planes. ``capacity``: the largest number of particles; numbers of those that have left are given again.
    waiting
        (n,) whether a particle belongs to the inflow zone and has not entered yet.
    passed
        mass that has entered and that has left, kg. ``memory``: time, and gradient of pressure at the inflow.
    """

    def __init__(
        self, given: OpenBoundaries, ends: ChannelEnds, spacing: float, position: Array, parts: Mapping[str, Any]
    ) -> None:
        self._given, self.ends, self._volume = given, ends, spacing**2
        self.capacity = len(position) + len(position) // 10 + 100
        self.waiting = position[:, 0] < ends.inflow
        self.passed, self.memory = np.zeros(2), np.zeros(2)
        self._heights = ends.bottom + spacing * (np.arange(round((ends.top - ends.bottom) / spacing)) + 0.5)
        self._pressure = parts["PRESSURE"]
        self._fit = specialise(fit_sums, parts)
        self._invert, self._update = (specialise(f, parts, parallel=False) for f in (invert_pressure, update_pressure))
        self._nodes = np.zeros((0, 2))
        self._lists, self._counts = np.zeros((0, 8), np.uint32), np.zeros(0, np.uint32)
        self._inflow = self._outflow = np.zeros(0, np.int64)

    @classmethod
    def of_case(
        cls, case: Case, scene: Scene, parameters: LoopParameters, position: Array, parts: Mapping[str, Any]
    ) -> "OpenChannel | None":
        """Return the open boundaries of ``case``, or None."""
        if case.open_boundaries is None:
            return None
        ends = channel_ends(scene, case.particle_spacing, parameters.support)
        return cls(case.open_boundaries, ends, case.particle_spacing, position, parts)

    def initial_velocity(self, position: Array) -> Array:
        """Return the velocity (n, 2) of the inflow at time 0 at the heights of ``position`` (n, 2), m/s."""
        along = self._given.growth(0.0) * self._given.velocities(position[:, 1], self.ends)
        return np.column_stack([along, np.zeros_like(along)])

    def find(self, rows: Array, lists: NeighbourLists, support: float) -> None:
        """List the fluid near the nodes, after ``lists`` have been built."""
        if not len(self._nodes):
            x = np.repeat([self.ends.inflow + support, self.ends.outflow - support], len(self._heights))
            self._nodes = np.column_stack([x, np.tile(self._heights, 2)])
        self._lists, self._counts = lists.around(self._nodes, rows)

    def prescribe(self, rows: Array, count: int, columns: Columns, parameters: LoopParameters, time: float) -> None:
        """Write the state of the particles in both zones to the first ``count`` of ``rows``."""
        ends, given = self.ends, self._given
        entering, leaving = np.split(self._fits(rows, parameters), 2)
        x = rows[:count, 0]
        self._inflow, self._outflow = np.flatnonzero(x < ends.inflow), np.flatnonzero(x > ends.outflow)
        state = rows[self._inflow]
        y = state[:, 1]
        state[:, columns.velocity] = np.column_stack([given.growth(time) * given.velocities(y, ends), np.zeros_like(y)])
        behind = state[:, 0] - self._nodes[0, 0]
        slope = self._smoothed(float(entering[:, 1].mean()), time, parameters.sound_speed)
        state[:, columns.pressure] = np.interp(y, self._heights, entering[:, 0]) + slope * behind
        self._invert(state, len(state), parameters)
        state[:, columns.mass] = self._volume * state[:, columns.density]
        self._update(state, len(state), parameters)  # as after a restart: that of the density, to the bit
        rows[self._inflow] = state
        state = rows[self._outflow]
        y = state[:, 1]
        slope, u, v = (np.interp(y, self._heights, column) for column in leaving[:, 1:].T)
        rho0 = parameters.reference_density
        p_out = self._pressure(rho0, rho0, parameters.sound_speed) if given.pressure is None else given.pressure
        state[:, columns.velocity] = np.column_stack([u, v])
        state[:, columns.pressure] = p_out + slope * (state[:, 0] - ends.outflow)
        self._invert(state, len(state), parameters)
        self._update(state, len(state), parameters)
        rows[self._outflow] = state

    def _fits(self, rows: Array, parameters: LoopParameters) -> Array:
        """Return pressure, its gradient along x, and both velocities at the nodes (k, 4)."""
        count = len(self._nodes)
        matrices, sums = np.zeros((count, 4, 4)), np.zeros((count, 4, 3))
        ends = self.ends
        self._fit(self._nodes, rows, self._lists, self._counts, parameters, ends.inflow, ends.outflow, matrices, sums)
        try:
            found = np.linalg.solve(matrices, sums)
        except np.linalg.LinAlgError:
            raise SimulationError(
                "there is no fluid beside an open end; likely causes: fluid that flows back, or a pressure too low"
            ) from None
        return np.column_stack([found[:, 0, 0], found[:, 1, 0] / parameters.support, found[:, 0, 1:]])

    def _smoothed(self, slope: float, time: float, sound_speed: float) -> float:
        """Return the gradient of pressure at the inflow, Pa/m, as it is apart from sound waves."""
        relaxation = _CROSSINGS * (self.ends.outflow - self.ends.inflow) / sound_speed
        last, before = self.memory
        if time > last:
            self.memory[:] = time, before + (slope - before) * -math.expm1((last - time) / relaxation)
        return float(self.memory[1])

    def hold(self, rates: Array, columns: Columns) -> None:
        """Set the rates of velocity and density in both zones to zero."""
        for zone in (self._inflow, self._outflow):
            rates[zone, columns.u :] = 0.0

    def in_zone(self, position: Array) -> BoolArray:
        """Return which of ``position`` (n, 2) are in a zone."""
        zone: BoolArray = (position[:, 0] < self.ends.inflow) | (position[:, 0] > self.ends.outflow)
        return zone

    def exchange(self, position: Array, mass: Array, ids: IntArray) -> tuple[IntArray, IntArray, int]:
        """Return who goes on, with copies of those that have entered at the end, and all numbers, and how many copies.

        ``position`` (n, 2), m, ``mass`` (n,), kg, and ``ids`` (n,) are those of the particles at present.

        Raises
        ------
        SimulationError
            when there would be more particles than the capacity.
        """
        x = position[:, 0]
        entered = np.flatnonzero(self.waiting & (x >= self.ends.inflow))
        stay = np.flatnonzero(x <= self.ends.outflow + self.ends.length)
        self.waiting[entered] = False
        self.passed += [mass[entered].sum(), mass.sum() - mass[stay].sum()]
        if len(stay) + len(entered) > self.capacity:
            raise SimulationError(
                f"more than {self.capacity} particles are in the channel, a tenth more than at the start; likely"
                " causes: fluid that does not reach the outflow, or an outflow narrower than the inflow"
            )
        free = np.setdiff1d(np.arange(self.capacity), ids[stay])[: len(entered)]
        self.waiting = np.concatenate([self.waiting[stay], np.ones(len(entered), np.bool_)])
        return np.concatenate([stay, entered]), np.concatenate([ids[stay], free]), len(entered)

    def state(self) -> Arrays:
        """Return copies of what the next exchange depends on."""
        return {"waiting": self.waiting.astype(np.int64), "passed": self.passed.copy(), "memory": self.memory.copy()}

    def restore(self, state: Arrays) -> None:
        """Continue from :meth:`state`."""
        self.waiting = state["waiting"].astype(np.bool_)
        self.passed, self.memory = state["passed"].copy(), state["memory"].copy()
