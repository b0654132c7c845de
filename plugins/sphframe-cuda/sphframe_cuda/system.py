"""The fluid on a CUDA device: its rows, rates and ghosts are held and computed there."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from types import SimpleNamespace
from typing import Any, final

import numpy as np

from sphframe import InputError
from sphframe.devices import (
    FluidSystem,
    ImageFilling,
    LargestMotion,
    Scratch,
    add_columns,
    advance_state,
    check_fluid,
    first_bad_ghost,
    hold_state,
    largest_motion,
)
from sphframe_cuda.arrays import check_device, fetched, put, put_into, room
from sphframe_cuda.lists import DeviceLists
from sphframe_cuda.loops import SIMULATED, Loop
from sphframe_cuda.templates import copy_rows, give_rows, put_rows, take_rows

_GHOSTS_AT_ONCE = 4 if SIMULATED else 32_768
"""ghosts that are filled at the same time, each with scratch memory of its own"""
_CHUNKS = 8 if SIMULATED else 8_192
"""parts of the fluid whose loads on walls are summed at the same time"""
_WALLS = ("points", "lifts", "foot", "normal", "reflection", "velocity", "position")
"""arrays of the ghosts that change where walls move; ``driving`` is in the arrays of the loops"""


def _scratch(capacity: int, dim: int) -> Scratch:
    """Return memory of the device for neighbourhoods; the threads use places beside each other."""
    own, count = partial(room, order="F"), _GHOSTS_AT_ONCE
    return Scratch(
        own((count, capacity, dim)), own((count, 4, capacity)), own((count, capacity), np.uint32), own((count, dim))
    )


@final
class CudaSystem(FluidSystem):
    """The fluid on a CUDA device, advanced by the kernels that Numba makes of sphframe's loop templates.

    The processor sorts the particles into cells, and computes bodies and output; rows, or positions only, travel there
    when one of these needs them.

    Raises
    ------
    InputError
        at the start, for what the device does not compute: thin walls, images of the fluid, wall particles with a state
        of their own, open ends, shifting and sources.
    """

    specialise, make_scratch, lists_type = Loop, staticmethod(_scratch), DeviceLists
    check_available = staticmethod(check_device)
    hold_state, advance_state, add_columns = Loop(hold_state), Loop(advance_state), Loop(add_columns)
    check_rows, check_ghosts = Loop(check_fluid), Loop(first_bad_ghost)
    _take_rows, _give_rows, _put_rows, _copy_rows = Loop(take_rows), Loop(give_rows), Loop(put_rows), Loop(copy_rows)
    _largest_motion = Loop(largest_motion)

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self._refuse()
        boundary = self.boundary
        self._corners: dict[bytes, Any] = {}
        self._are_on_host = False
        self._ghost_rows = self.rows[self.fluid_count :].copy()
        self._walls = SimpleNamespace(
            **{name: put(getattr(boundary, name)) for name in _WALLS},
            statuses=put(boundary.statuses),
            passable=put(boundary.passable),
            images=type(boundary.images)(*map(put, boundary.images)),
        )
        shared = {name: getattr(self._walls, name) for name in ("normal", "reflection", "velocity", "position")}
        self._walls.arrays = boundary.arrays._replace(
            **shared, **{name: put(array) for name, array in boundary.arrays._asdict().items() if name not in shared}
        )
        self._place()

    def _refuse(self) -> None:
        for present, what in (
            (self.boundary.sides is not None, "thin walls"),
            (isinstance(self._filling, ImageFilling), "treatments with images of the fluid"),
            (self.wall_states.needed, "treatments whose wall particles have a state of their own"),
            (self.channel is not None, "open ends"),
            (self.loops.shifting is not None, "shifting"),
            (self._driving.sources is not None, "sources"),
        ):
            if present:
                raise InputError(f'device "cuda" does not compute {what}: run the case with device "cpu"')

    def make_room(self, memory: int) -> None:
        """Refuse integrators that store totals from step to step.

        Raises
        ------
        InputError
            for such an integrator.
        """
        if memory:
            raise InputError('device "cuda" does not compute integrators of several steps: run with device "cpu"')
        super().make_room(0)

    # where the arrays are

    def _place(self) -> None:
        """Bring rows, rates and gradient to the device."""
        self.rows, self.rates, self.gradient = put(self.rows), put(self.rates), put(self.gradient)
        self._start, self._total = room(self.rates.shape), room(self.rates.shape)
        self._spare, self._places = room((self.fluid_count, self.columns.width)), room(self.gradient.shape)
        self._host_rows, self._fetched_after = np.zeros(0), -1

    def _renew_walls(self) -> None:
        """Bring what changes of walls that move, or of the force, to the device."""
        for name in _WALLS:
            put_into(getattr(self.boundary, name), getattr(self._walls, name))
        put_into(self.boundary.driving, self._walls.arrays.force)

    @contextmanager
    def _on_host(self, *, changed: bool) -> Iterator[None]:
        """Hold rows, rates and gradient on the processor meanwhile, where they may be ``changed``."""
        if self._are_on_host:
            yield
            return
        held = self.rows, self.rates, self.gradient, self._start, self._total, self._spare
        self.rows, self.rates, self.gradient = map(fetched, held[:3])
        self._start = self._total = self._spare = np.zeros_like(self.rates)
        self._are_on_host = True
        yield
        self._are_on_host = False
        if changed:
            self._place()
        else:
            self.rows, self.rates, self.gradient, self._start, self._total, self._spare = held

    @property
    def host_rows(self) -> Any:
        """A copy of the rows on the processor."""
        self._fetch()
        return self._host_rows

    def _fetch(self) -> None:
        """Copy rows and what is assigned to ghosts to the processor if they may have changed."""
        if self._fetched_after != Loop.launches:
            self._host_rows, self._fetched_after = fetched(self.rows), Loop.launches
            self.boundary.statuses[:] = fetched(self._walls.statuses)
            self.boundary.arrays.viscous_velocity[:] = fetched(self._walls.arrays.viscous_velocity)

    @property
    def statuses(self) -> Any:
        """The :class:`Status` (g,) of each ghost at the last filling."""
        self._fetch()
        return self.boundary.statuses

    @property
    def around(self) -> tuple[Any, Any]:
        """Lists and walls on the device."""
        return self.lists, self._walls

    # neighbours

    def _positions(self) -> Any:
        """Return the positions (n, dim) of the fluid, m, on the processor."""
        self._copy_rows(self.rows, self._places)
        return fetched(self._places)

    def _present_positions(self, fluid: Any) -> Any:
        """Return the positions (n + g, dim) of ``fluid`` (n, dim) and ghosts, m, on the processor."""
        return np.vstack([fluid, self._ghost_rows[:, self.columns.position]])

    def find_neighbours(self, stride: float = 0.0) -> None:
        """Sort the particles into cells on the processor, put them in order and list their neighbours on the device."""
        self.lists.adapt_skin(stride)
        position = self._positions()
        order = self._sort(position)
        chosen = put(order)
        for array, spare in ((self.rows, self._spare), (self.rates, self._total), (self.gradient, self._places)):
            self._take_rows(array, chosen, spare)
            self._put_rows(array, 0, spare)
        self.lists.build(self._present_positions(position[order]), self.boundary.points)
        if self.boundary.periods:
            self._put_rows(self.rows, 0, self.lists.position)

    def largest_motion(self) -> LargestMotion:
        """Return the largest speed of the fluid and its largest displacement since the last neighbour search."""
        return LargestMotion(*self._largest_motion(self.rows, self.lists.position, self.columns.dim))

    def neighbours_remain_valid(self, motion: LargestMotion, interval: float) -> bool:
        """Return whether the lists stay complete; the positions of the fluid count by its largest motion alone."""
        ahead, boundary = motion.displacement + motion.speed * interval, self.boundary
        if 2.0 * ahead > self.lists.skin or not boundary.bodies:
            return 2.0 * ahead <= self.lists.skin
        rows = self._present_positions(np.empty(self._places.shape))
        return self.lists.remain_valid(rows, boundary.points, motion, wall_speed=boundary.speed, interval=interval)

    def keep(self, kept: Any) -> None:
        """Continue with the fluid particles that are ``kept``."""
        with self._on_host(changed=True):
            super().keep(kept)

    # the step

    def move_walls(self, time: float) -> None:
        """Carry the ghosts to where the bodies are, on the processor, and bring what has changed to the device."""
        self.bodies.update_motions(time, self._body_loads())
        self.set_body_force(time)
        if self._driving.move(self.boundary, self.bodies.motions, self._ghost_rows, time):
            self._renew_walls()
            self._put_rows(self.rows, self.fluid_count, put(self._ghost_rows[:, self.columns.position]))

    def put_back(self) -> int:
        """Put particles that have come behind a wall back on it; return how many there were."""
        near, walls, solids = self.lists, self._walls, self.boundary.solid_contacts
        marked = put(np.zeros(self.fluid_count if solids.needed else 1, np.bool_))
        count = self._put_back(
            self.rows, self.fluid_count, near.fluid, near.fluid_counts, near.ghost_counts, near.shares, walls.passable,
            self.columns, self.parameters, walls.foot, walls.normal, walls.velocity, marked,
        )  # fmt: skip
        if solids.needed and len(behind := np.flatnonzero(fetched(marked))):
            chosen, beside = put(behind), room((len(behind), self.columns.width))
            self._take_rows(self.rows, chosen, beside)
            rows = fetched(beside)
            moved = solids.put_back(rows, np.ones(len(rows), np.bool_), self.bodies.motions)
            if moved:
                self._give_rows(self.rows, chosen, put(rows))
            count += moved
        return int(count)

    def react(self, walls: Any, shares: Any, centres: Any) -> Any:
        """Return the loads on the ``walls`` (g,) of the ghosts."""
        partial = put(np.zeros((_CHUNKS, len(centres), self.bodies.size)))
        fetched_before = self._fetched_after == Loop.launches
        given = put(walls), type(shares)(*map(put, shares)), put(centres), partial
        self.loops.react(self.rows, *self.around, self.parameters, *given)
        if fetched_before:  # this loop has changed no rows
            self._fetched_after = Loop.launches
        return fetched(partial).sum(axis=0)

    # checks

    def check_fluid(self, lower: Any, upper: Any, lowest: float, highest: float) -> tuple[int, int, int, int]:
        """Check the fluid; return the first rows that are wrong, and the number of densities out of range."""
        key = lower.tobytes() + upper.tobytes()
        if key not in self._corners:
            self._corners[key] = put(lower), put(upper)
        lower, upper = self._corners[key]
        return super().check_fluid(lower, upper, lowest, highest)

    # what restarts a run

    def state(self) -> Any:
        """Return copies of all that the next step depends on, by name."""
        self.boundary.statuses[:] = fetched(self._walls.statuses)
        with self._on_host(changed=False):
            return super().state()

    def restore(self, state: Any) -> None:
        """Continue from what :meth:`state` returned for the same case."""
        with self._on_host(changed=True):
            super().restore(state)
        put_into(self.boundary.statuses, self._walls.statuses)
        self._renew_walls()
