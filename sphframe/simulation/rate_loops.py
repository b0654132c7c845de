"""Simulation: the compiled sums of continuity and momentum over fluid and walls, as the treatment needs them."""

from collections.abc import Callable, Mapping
from typing import Any

from sphframe.arrays import Array, IntArray
from sphframe.boundary.boundary import Boundary
from sphframe.boundary.corners import Shares
from sphframe.boundary.images import most_images
from sphframe.compiled import specialise
from sphframe.interfaces import CompiledKernel, WallParts
from sphframe.neighbours import NeighbourLists
from sphframe.physics import (
    LoopParameters,
    fluid_sums,
    make_seen,
    make_surface,
    surface_reaction,
    surface_sums,
    wall_reaction,
    wall_sums,
)
from sphframe.simulation.shifting import Shifting


class RateLoops:
    """Density rates, accelerations and wall loads with the compiled ``parts`` and the ``walls`` of the treatment.

    Where the treatment leaves ghosts as they were assigned, one loop sums over fluid and ghosts. Else a second one
    sums over the ghosts. ``attracts``: whether a pair of fluid and ghost may attract; ``images``: whether images of
    the fluid take the place of ghosts. ``shifting`` adds its control of the tensile instability to the accelerations.
    ``compile_loop`` makes the loops, as :func:`~sphframe.compiled.specialise` does.
    """

    def __init__(
        self,
        parts: Mapping[str, Any],
        kernel: CompiledKernel,
        walls: WallParts,
        *,
        attracts: bool,
        images: bool,
        shifting: Shifting | None = None,
        compile_loop: Callable[..., Callable[..., None]] = specialise,
    ) -> None:
        self.shifting = shifting
        own = walls.seen, walls.force, walls.surface
        changed = images or walls.own_viscous_velocity or not (attracts and walls.friction)
        as_assigned = own == (None, None, None) and not changed
        bound = {
            **parts,
            "AS_ASSIGNED": as_assigned,
            "FORCES": walls.force is not None,
            "IMAGES": images,
            "SLOTS": most_images(parts["DIM"]),
        }
        if not as_assigned:
            bound |= {"KINDS": 1, "SEEN": make_seen(walls, attracts=attracts), "FORCE": walls.force or _no_force}
        over_walls, reaction = wall_sums, wall_reaction
        if walls.surface is not None:
            over_walls, reaction = surface_sums, surface_reaction
            bound["SURFACE"] = make_surface(walls.surface, attracts=attracts)
            bound |= {"DIVIDES": walls.divides_by_gamma, "SIGMA": kernel.normalisation}
            bound["EDGE_INTEGRALS"] = kernel.edge_integrals
        self._fluid, self._walls = {}, {}
        for continuity in (True, False):
            bound["CONTINUITY"] = continuity
            self._fluid[continuity] = compile_loop(fluid_sums, bound)
            if not as_assigned and not (continuity and walls.force):
                self._walls[continuity] = compile_loop(over_walls, bound)
        self._reaction = compile_loop(reaction, bound)

    def __call__(
        self,
        rows: Array,
        lists: NeighbourLists,
        boundary: Boundary,
        parameters: LoopParameters,
        gradient: Array,
        rates: Array,
        *,
        continuity: bool,
    ) -> None:
        """Write density rates or accelerations to ``rates``, see :func:`sphframe.physics.rates.fluid_sums`."""
        near = lists.fluid, lists.fluid_counts, lists.ghost_counts, lists.shares
        self._fluid[continuity](rows, *near, parameters, gradient, rates)
        if continuity in self._walls:
            self._walls[continuity](rows, *near, boundary.arrays, boundary.images, parameters, rates)
        if self.shifting is not None and not continuity:
            self.shifting.control(rows, lists, parameters, rates)

    def react(
        self,
        rows: Array,
        lists: NeighbourLists,
        boundary: Boundary,
        parameters: LoopParameters,
        walls: IntArray,
        shares: Shares,
        centres: Array,
        partial: Array,
    ) -> None:
        """Add parts of the loads on ``walls``, see :func:`sphframe.physics.wall_force.wall_reaction`."""
        self._reaction(
            rows, lists.fluid_count, lists.fluid, lists.fluid_counts, lists.ghost_counts, lists.shares, walls,
            shares, centres, boundary.arrays, boundary.images, parameters, partial,
        )  # fmt: skip


def _no_force(wall: Any, separation: Any, constants: Any) -> tuple[float, float, float]:
    """Stand for the force of a treatment that has none."""
    return 0.0, 0.0, 0.0
