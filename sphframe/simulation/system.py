"""Simulation: the fluid and its bodies as one system of ordinary differential equations.

The order of things within one evaluation reads from top to bottom in :meth:`FluidSystem.evaluate`.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from sphframe.arrays import Array, Arrays, BoolArray, IntArray
from sphframe.boundary.boundary import Boundary
from sphframe.boundary.contact import put_back
from sphframe.boundary.corners import Shares
from sphframe.boundary.filling import Filling, ImageFilling
from sphframe.boundary.ghosts import Scratch
from sphframe.boundary.wall_states import WallStates
from sphframe.compiled import specialise
from sphframe.compiled.threaded import LONG
from sphframe.neighbours import LargestMotion, NeighbourLists
from sphframe.particles import Columns
from sphframe.physics import LoopParameters, update_pressure
from sphframe.simulation.body_contact import BodyContacts
from sphframe.simulation.body_states import BodyStates
from sphframe.simulation.driving import Driving
from sphframe.simulation.open_channel import OpenChannel
from sphframe.simulation.packed_system import PackedSystem
from sphframe.simulation.rate_loops import RateLoops

_SAVED = ("rows", "rates", "gradient", "loads")
"""the system's own arrays on which the next step depends; ``ids`` come first, as their number may differ"""


class FluidSystem(PackedSystem):
    """The state that an integrator advances: packed rows of the fluid, and generalised coordinates of the bodies.

    Attributes
    ----------
    rows
        (n + g, width) packed rows, see :class:`Columns`; the fluid comes first.
    rates
        (n, 2 dim + 1) velocity, acceleration and density rate of the last evaluation.
    gradient
        (n, dim) renormalised density gradient, kg/m^4.
    ids
        (n,) original numbers of the fluid particles, which are kept in spatial order.
    turns
        (n, dim) periods by which each of them has left the box that repeats itself.
    bodies
        the states of the bodies; ``contacts`` between them and walls. ``channel``: its open ends, or None.
    loads
        (walls, 3 or 6) force and moment of the fluid on each wall.

    A subclass computes elsewhere than on the processor: it holds ``rows``, ``rates`` and ``gradient`` there, and says
    how loops over them are compiled (``specialise``) and where their scratch memory and their lists are.
    """

    specialise, make_scratch = staticmethod(specialise), staticmethod(Scratch.of)
    lists_type: type[NeighbourLists] = NeighbourLists

    @staticmethod
    def check_available() -> None:
        """Raise an InputError where what computes the steps is missing; the processor is always there."""

    def __init__(
        self,
        rows: Array,
        boundary: Boundary,
        filling: Filling | ImageFilling,
        lists: NeighbourLists,
        loops: RateLoops,
        wall_states: WallStates,
        parts: Mapping[str, Any],
        parameters: LoopParameters,
        contacts: BodyContacts,
        driving: Driving,
        channel: OpenChannel | None = None,
    ) -> None:
        dim, several = boundary.dim, len(rows) >= LONG
        self.channel, self.boundary, self.contacts = channel, boundary, contacts
        self._filling, self.loops, self.wall_states = filling, loops, wall_states
        self.parameters, self.columns = parameters, Columns.of(dim)
        self.bodies = BodyStates(boundary.bodies, dim)
        self.loads = np.zeros((len(boundary.wall_body), self.bodies.size))
        self._driving, self._pressure_is_current = driving, False
        self._pressure = self.specialise(update_pressure, parts, parallel=several)
        self._put_back = self.specialise(put_back, {**parts, "MARKS": boundary.solid_contacts.needed}, parallel=several)
        self.rows, self.lists, count = rows, lists, lists.fluid_count
        self.ids, self.turns = np.arange(count), np.zeros((count, dim), np.int64)
        self.rates = np.zeros((count, self.columns.density + 1))
        self.gradient = np.zeros((count, dim))
        self._saved = (*_SAVED, "turns") if boundary.periods else _SAVED

    # neighbours

    def find_neighbours(self, stride: float = 0.0) -> None:
        """Pass open ends, put all in order in its box, list the neighbours; ``stride``: of particles in a step, m."""
        if self.channel is not None:
            self._exchange(self.channel)
        self.lists.adapt_skin(stride)
        order = self._sort(self.rows)
        for array in (self.rows, self.rates, self.gradient, *(totals["fluid"] for totals in self.stored)):
            array[: self.fluid_count] = array[order]
        self.lists.build(self.rows, self.boundary.points)
        if self.channel is not None:
            self.channel.waiting = self.channel.waiting[order]
            self.channel.find(self.rows, self.lists, self.parameters.support)

    def _sort(self, rows: Array) -> IntArray:
        """Bring the fluid in ``rows`` into the box that repeats itself, sort ``ids`` and turns; return the order."""
        periods = self.boundary.periods
        if periods:
            position = rows[: self.fluid_count, self.columns.position]
            turns = periods.turns(position)
            position -= turns * periods.length
            self.turns += turns
        order = self.lists.sort(rows)
        self.ids = self.ids[order]
        self.turns = self.turns[order] if periods else self.turns
        return order

    def _exchange(self, channel: OpenChannel) -> None:
        """Let particles enter and leave through the open ends."""
        rows, columns = self.rows[: self.fluid_count], self.columns
        kept, ids, entered = channel.exchange(rows[:, columns.position], rows[:, columns.mass], self.ids)
        if entered or len(kept) < self.fluid_count:
            self.keep(kept)
            self.ids = ids
            self.rows[len(kept) - entered : len(kept), 0] -= channel.ends.length

    def largest_motion(self) -> LargestMotion:
        """Return the largest speed of the fluid and its largest displacement since the last neighbour search."""
        return self.lists.largest_motion(self.rows)

    def neighbours_remain_valid(self, motion: LargestMotion, interval: float) -> bool:
        """Return whether the lists stay complete if everything keeps its speed for ``interval``, s."""
        boundary = self.boundary
        return self.lists.remain_valid(self.rows, boundary.points, motion, wall_speed=boundary.speed, interval=interval)

    def keep(self, kept: BoolArray | IntArray) -> None:
        """Continue with the fluid particles that are ``kept`` (n,), or with these numbers of them (k,).

        Their neighbours must be found again.
        """
        n = self.fluid_count
        self.rows = np.vstack([self.rows[:n][kept], self.rows[n:]])
        self.ids, self.turns = self.ids[kept], self.turns[kept]
        self.rates, self.gradient = self.rates[kept], self.gradient[kept]
        for totals in self.stored:
            totals["fluid"] = totals["fluid"][kept]
        self.lists = self.lists.resized(self.fluid_count)

    # evaluation

    def evaluate(self, time: float) -> None:
        """Compute all rates of the present state at ``time``."""
        self.evaluate_acceleration(time)
        self._sum_density_rates(time)

    def evaluate_density(self, time: float) -> None:
        """Compute the density rates of the present state at ``time``, with the density gradient last computed."""
        self._prepare(time)
        self._sum_density_rates(time)

    def evaluate_acceleration(self, time: float) -> None:
        """Compute the accelerations and the density gradient of the present state at ``time``."""
        self._prepare(time)
        self._sum(time, continuity=False)
        if self.bodies.need_loads:
            self.update_loads()
        if len(self.bodies):
            loads = self._body_loads()
            self.contacts.add_loads(self.bodies.motions, loads)
            self.bodies.update_rates(time, loads)

    def _prepare(self, time: float) -> None:
        """Bring walls, pressures, zones of open ends and ghosts to the present state at ``time``."""
        self.move_walls(time)
        self.update_pressure()
        if self.channel is not None:
            self.channel.prescribe(self.rows, self.fluid_count, self.columns, self.parameters, time)
        self.fill_ghosts()

    def move_walls(self, time: float) -> None:
        """Carry the ghosts to where the bodies are; a body under load keeps its last acceleration."""
        self.bodies.update_motions(time, self._body_loads())
        self.set_body_force(time)
        self._driving.move(self.boundary, self.bodies.motions, self.rows[self.fluid_count :], time)

    def set_body_force(self, time: float) -> None:
        """Take the force per mass at ``time``, that of gravity and of the case's acceleration."""
        self.parameters = self._driving.at(time, self.parameters)

    def update_pressure(self) -> None:
        """Compute pressure and volume of the fluid from its density."""
        self._pressure(self.rows, self.fluid_count, self.parameters)
        self._pressure_is_current = True

    def refresh_pressure(self) -> None:
        """Compute pressure and volume of the fluid, unless they are those of the present density."""
        if not self._pressure_is_current:
            self.update_pressure()

    def fill_ghosts(self) -> None:
        """Mirror, interpolate, assign."""
        self._filling(self.rows, *self.around, self.parameters)

    def _sum_density_rates(self, time: float) -> None:
        self._sum(time, continuity=True)
        self.wall_states.evaluate(self.rows, self.lists, self.parameters)

    def _sum(self, time: float, *, continuity: bool) -> None:
        self.loops(self.rows, *self.around, self.parameters, self.gradient, self.rates, continuity=continuity)
        self._driving.add_sources(self.rows, self.rates, time, continuity=continuity)
        if self.channel is not None:
            self.channel.hold(self.rates, self.columns)

    def update_loads(self) -> None:
        """Compute force and moment of the fluid on each wall."""
        self.loads = self.react(self.boundary.wall, self.boundary.corner_shares(self.bodies.motions), self.references())

    def react(self, walls: IntArray, shares: Shares, centres: Array) -> Array:
        """Return the loads on the ``walls`` (g,) of the ghosts, a sum over chunks; see :class:`RateLoops`."""
        partial = np.zeros((64, len(centres), self.bodies.size))
        self.loops.react(self.rows, *self.around, self.parameters, walls, shares, centres, partial)
        return np.asarray(partial.sum(axis=0))

    def _body_loads(self) -> Array:
        """Force and moment (bodies, 3 or 6) of the fluid on each body, as last computed."""
        wall_body, count = self.boundary.wall_body, len(self.bodies)
        return np.array([self.loads[wall_body == k].sum(axis=0) for k in range(count)]).reshape(count, self.bodies.size)

    def put_back(self) -> int:
        """Put particles that have come behind a wall back on it; return how many there were."""
        lists, boundary, solids = self.lists, self.boundary, self.boundary.solid_contacts
        marked = np.zeros(self.fluid_count if solids.needed else 1, np.bool_)
        count = self._put_back(
            self.rows, self.fluid_count, lists.fluid, lists.fluid_counts, lists.ghost_counts, lists.shares,
            boundary.passable, self.columns, self.parameters, boundary.foot, boundary.normal, boundary.velocity, marked,
        )  # fmt: skip
        return int(count) + solids.put_back(self.rows, marked, self.bodies.motions)

    def shift(self, speed: float, interval: float) -> None:
        """Shift the particles after a step of ``interval``, s; ``speed``: the largest of the fluid, m/s."""
        assert self.loops.shifting is not None
        still = None if self.channel is None else self.channel.in_zone(self.rows[: self.fluid_count])
        self.loops.shifting.shift(self.rows, self.lists, self.parameters, speed, interval, still)
        self._pressure_is_current = False

    # what restarts a run

    def state(self) -> Arrays:
        """Return copies of all that the next step depends on, by name."""
        parts: dict[str, Arrays] = {
            "bodies": self.bodies.state(),
            "boundary": self.boundary.state(),
            "lists": self.lists.state(),
            **{f"stored.{place}": totals for place, totals in enumerate(self.stored)},
            **({} if self.channel is None else {"channel": self.channel.state()}),
        }
        return {
            "ids": self.ids.copy(),
            **{name: getattr(self, name).copy() for name in self._saved},
            **{f"{part}.{name}": array.copy() for part, arrays in parts.items() for name, array in arrays.items()},
        }

    def restore(self, state: Arrays) -> None:
        """Continue from what :meth:`state` returned for the same case."""
        if len(state["ids"]) != self.fluid_count:
            self.keep(np.resize(np.arange(self.fluid_count), len(state["ids"])))
        self.ids = state["ids"].copy()
        self.lists.restore(_part(state, "lists"), self.rows)
        if self.channel is not None:
            self.channel.restore(_part(state, "channel"))
            self.channel.find(self.rows, self.lists, self.parameters.support)
        self.bodies.restore(_part(state, "bodies"))
        self.boundary.restore(_part(state, "boundary"))
        for name in self._saved:
            getattr(self, name)[:] = state[name]
        for place, totals in enumerate(self.stored):
            totals.update({name: array.copy() for name, array in _part(state, f"stored.{place}").items()})
        self._pressure_is_current = False


def _part(state: Arrays, part: str) -> Arrays:
    """Return the arrays of a part of the system, by their names within it."""
    return {name.removeprefix(f"{part}."): array for name, array in state.items() if name.startswith(f"{part}.")}
