"""Simulation: force and moment of the fluid on walls and on named parts of them, in two ways.

By reaction, from the momentum equation (:mod:`sphframe.physics.wall_force`), and by the integral of the pressure over
the panels of the wall. A moment refers to the wall's reference point, which its body carries; by default to the present
centre of the body, or to the origin for a wall at rest. About a point at d from there it is M - d x F. In the force by
reaction on a part, ghosts belong to the part in which their wall points lie; the shares of corners between two walls
are left out.
"""

from collections.abc import Callable, Sequence

import numpy as np

from sphframe.arrays import Array, BoolArray
from sphframe.boundary.corners import Shares
from sphframe.cases import WallPart
from sphframe.geometry import Panels, Wall, directions_to_world, moments, to_world
from sphframe.interfaces import WallLoad
from sphframe.simulation.system import FluidSystem

_ON_THE_BOX = 1e-9
"""tolerance of the box of a part, m: a panel on its face belongs to it"""


class WallLoads:
    """Loads on the ``walls`` of ``system``, cut into ``panels``, and on their ``parts``.

    ``sample``: returns pressure and filling at points.
    """

    def __init__(
        self,
        system: FluidSystem,
        walls: Sequence[Wall],
        parts: Sequence[WallPart],
        panels: Panels,
        sample: Callable[[Array], tuple[Array, Array]],
    ) -> None:
        self._system, self._panels, self._sample = system, panels, sample
        boundary, index = system.boundary, {wall.name: k for k, wall in enumerate(walls)}
        self._names = list(index)
        self._references = [wall.reference_point for wall in walls]
        self._ghosts = {part.name: (boundary.wall == index[part.wall]) & _within(boundary.foot, part) for part in parts}
        own = {name: (k, panels.wall == k) for name, k in index.items()}
        in_parts = {p.name: (index[p.wall], own[p.wall][1] & _within(panels.centre, p)) for p in parts}
        self._surfaces = {**own, **in_parts}

    def __call__(self) -> dict[str, WallLoad]:
        """Return the load on each wall and part by its name.

        Above the water, where the kernel average still reaches it, the lifted pressure is negative: it is left out.
        """
        system, boundary = self._system, self._system.boundary
        system.refresh_pressure()
        system.update_loads()
        reactions = {name: system.loads[k].copy() for k, name in enumerate(self._names)}
        for name, ghosts in self._ghosts.items():
            reactions[name] = self._reaction(ghosts, self._surfaces[name][0])
        centre, area = self._panels.centre.copy(), self._panels.area.copy()
        for wall, body in enumerate(boundary.wall_body):
            if body >= 0:
                own = self._panels.wall == wall
                position = system.bodies.motions[body].position
                centre[own] = to_world(centre[own], position, boundary.centres[body])
                area[own] = directions_to_world(area[own], position)
        pressure, filling = self._sample(centre)
        pressure[(filling < 0.4) & (pressure < 0.0)] = 0.0  # within the water a wall's filling is one half
        forces, references, dim = pressure[:, None] * area, system.references(), boundary.dim
        loads = {}
        for name, (wall, own) in self._surfaces.items():
            moment = moments(centre[own] - references[wall], forces[own]).sum(axis=0)
            reaction, force = reactions[name], forces[own].sum(axis=0)
            shift = self._reference(wall, references[wall]) - references[wall]
            by_reaction, by_pressure = moments(np.array([shift, shift]), np.array([reaction[:dim], force]))
            loads[name] = WallLoad(reaction[:dim], force, reaction[dim:] - by_reaction, moment - by_pressure)
        return loads

    def _reaction(self, ghosts: BoolArray, wall: int) -> Array:
        """Return force and moment (3 or 6,) of the fluid on some ``ghosts`` (g,) of a wall, without corner shares."""
        system, boundary = self._system, self._system.boundary
        nothing = np.zeros_like(boundary.position)
        shares = Shares(np.full(boundary.count, -1), nothing, nothing)
        centres = system.references()[[wall, wall]]  # the second is of all other ghosts
        return np.asarray(system.react(np.where(ghosts, 0, 1), shares, centres)[0])

    def _reference(self, wall: int, default: Array) -> Array:
        """Return the present point, m, to which the moment on a wall refers."""
        boundary, drawn = self._system.boundary, self._references[wall]
        if drawn is None:
            return default
        point, body = np.array([drawn]), boundary.wall_body[wall]
        if body >= 0:
            point = to_world(point, self._system.bodies.motions[body].position, boundary.centres[body])
        return np.asarray(point[0])


def _within(points: Array, part: WallPart) -> BoolArray:
    low, high = np.array(part.lower) - _ON_THE_BOX, np.array(part.upper) + _ON_THE_BOX
    return np.asarray(np.all((points >= low) & (points <= high), axis=1))
