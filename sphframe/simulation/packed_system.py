"""Simulation: what integrators are made of: updates of the packed rows, and of the bodies and walls with them."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from sphframe.arrays import Array, IntArray
from sphframe.boundary.boundary import Boundary
from sphframe.boundary.wall_states import WallStates
from sphframe.interfaces import Status, System
from sphframe.neighbours import NeighbourLists
from sphframe.particles import Columns
from sphframe.simulation.body_states import BodyStates
from sphframe.simulation.row_checks import check_fluid, first_bad_ghost
from sphframe.simulation.updates import add_columns, advance_state, hold_state


class PackedSystem(System):
    """A system whose state is packed ``rows``, with the ``rates`` of the last evaluation; a subclass evaluates them."""

    hold_state, advance_state, add_columns = map(staticmethod, (hold_state, advance_state, add_columns))
    check_rows, check_ghosts = map(staticmethod, (check_fluid, first_bad_ghost))

    rows: Array
    lists: NeighbourLists
    boundary: Boundary
    rates: Array
    columns: Columns
    bodies: BodyStates
    wall_states: WallStates
    _start = _total = np.zeros((0, 1))
    _pressure_is_current: bool
    stored: Sequence[dict[str, Array]] = ()

    @property
    def host_rows(self) -> Array:
        """The rows as the processor reads them, which are not to be written."""
        return self.rows

    @property
    def around(self) -> tuple[Any, Any]:
        """The lists of neighbours and the walls as the loops read them."""
        return self.lists, self.boundary

    @property
    def statuses(self) -> IntArray:
        """The :class:`Status` (g,) of each ghost at the last filling."""
        return self.boundary.statuses

    @property
    def fluid_count(self) -> int:
        """Number of fluid particles, which come first in the rows."""
        return len(self.rates)

    def hold(self) -> None:
        """Remember the state as the start of the step."""
        self._make_totals()
        self.hold_state(self.rows, self._start, self._total)
        self.bodies.hold()
        self.wall_states.hold()

    def advance(self, interval: float) -> None:
        """y = y0 + interval * f."""
        self.advance_state(self.rows, self._start, self.rates, interval)
        self.bodies.advance(interval)
        self.wall_states.advance(interval)
        self._pressure_is_current = False

    def accumulate(self, weight: float) -> None:
        """total = total + weight * f."""
        self.add_columns(self._total, self.rates, self.fluid_count, 0, self._total.shape[1], 0, weight)
        self.bodies.accumulate(weight)
        self.wall_states.accumulate(weight)

    def advance_total(self, interval: float) -> None:
        """y = y0 + interval * total."""
        self.advance_state(self.rows, self._start, self._total, interval)
        self.bodies.advance_total(interval)
        self.wall_states.advance_total(interval)
        self._pressure_is_current = False

    def make_room(self, memory: int) -> None:
        """Make room for as many totals that are stored from step to step."""
        if memory:
            self._make_totals()
        self.stored = [{name: np.full_like(a, -1.0) for name, a in self._totals().items()} for _ in range(memory)]

    def _make_totals(self) -> None:
        """Make room for start and total of a step, which not every integrator needs."""
        if len(self._total) != self.fluid_count:
            self._start, self._total = np.zeros_like(self.rates), np.zeros_like(self.rates)

    def _totals(self, time: float = 0.0) -> dict[str, Array]:
        fluid, bodies, walls = self._total, self.bodies.total, self.wall_states.total
        return {"fluid": fluid, "bodies": bodies, "walls": walls, "time": np.array([time])}

    def store(self, place: int, time: float) -> None:
        """Store the total as that of ``time``, s."""
        for name, total in self._totals(time).items():
            self.stored[place][name][:] = total

    def stored_time(self, place: int) -> float | None:
        """Return the time of a stored total, s; None before the first."""
        return None if (time := float(self.stored[place]["time"][0])) < 0.0 else time

    def accumulate_stored(self, place: int, weight: float) -> None:
        """total = total + weight * stored total."""
        for name, total in self._totals().items():
            total += weight * self.stored[place][name]

    def drift(self, interval: float) -> None:
        """x = x + interval * u."""
        self.add_columns(self.rows, self.rows, self.fluid_count, 0, self.columns.dim, self.columns.u, interval)
        self.bodies.drift(interval)

    def kick(self, interval: float) -> None:
        """u = u + interval * acceleration."""
        self.add_columns(self.rows, self.rates, self.fluid_count, self.columns.u, self.columns.density, 0, interval)
        self.bodies.kick(interval)

    def update_density(self, interval: float) -> None:
        """rho = rho + interval * density rate."""
        density = self.columns.density
        self.add_columns(self.rows, self.rates, self.fluid_count, density, density + 1, 0, interval)
        self.wall_states.update_density(interval)
        self._pressure_is_current = False

    def references(self) -> Array:
        """Return the points (walls, dim) to which moments refer: the centre of the wall's body, or the origin, m."""
        return self.boundary.references(self.bodies.motions)

    # checks

    def check_fluid(self, lower: Array, upper: Array, lowest: float, highest: float) -> tuple[int, int, int, int]:
        """Check the fluid, see :func:`sphframe.simulation.row_checks.check_fluid`."""
        found: tuple[int, int, int, int] = self.check_rows(
            self.rows, self.fluid_count, self.columns, lower, upper, lowest, highest
        )
        return found

    def first_bad_ghost(self) -> int:
        """Return the first ghost near the fluid that is not finite or has no status; their number if there is none."""
        lists, walls = self.around
        return int(
            self.check_ghosts(self.rows, self.fluid_count, self.columns, lists.near, walls.statuses, len(Status))
        )
