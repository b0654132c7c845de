"""Simulation: what drives the fluid: the force per mass of gravity and of the case, and sources of its equations."""

from collections.abc import Sequence

from sphframe.arrays import Array
from sphframe.boundary.boundary import Boundary
from sphframe.cases.scene import Sources
from sphframe.interfaces import BodyForce, Motion
from sphframe.particles import Columns
from sphframe.physics import LoopParameters, uniform_and_linear, with_body_force


class Driving:
    """The driving force of the ghosts' pressure: ``force`` (dim,), rho0 f at the origin, N/m^3, and its ``gradient``.

    The gradient (dim, dim) is that of f, 1/s^2; None where the force is uniform. ``added`` is the case's acceleration,
    and ``sources`` are added to the rates.
    """

    def __init__(
        self, parameters: LoopParameters, dim: int, added: BodyForce | None, sources: Sources | None = None
    ) -> None:
        self.sources, self._columns, self._density = sources, Columns.of(dim), parameters.reference_density
        self._gravity, self.gradient = uniform_and_linear(parameters, dim)
        self.force: Array = parameters.reference_density * self._gravity
        self._added = added

    def at(self, time: float, parameters: LoopParameters) -> LoopParameters:
        """Take the force at ``time``, and return ``parameters`` with it."""
        if self._added is None:
            return parameters
        force = self._gravity + self._added.acceleration(time)
        self.gradient = self._added.gradient(time)
        self.force = parameters.reference_density * force
        return with_body_force(parameters, force, self.gradient)

    def move(self, boundary: Boundary, motions: Sequence[Motion], ghosts: Array, time: float) -> bool:
        """Move the walls of ``boundary`` and the rows of their ``ghosts``; set the force that the pressure balances.

        Returns whether anything has changed.
        """
        moved = boundary.move(motions, ghosts, self.force, self._density, self.gradient)
        if self.sources is not None:
            boundary.driving[:] = self.sources.wall_force(boundary.foot, time)
        return moved

    def add_sources(self, rows: Array, rates: Array, time: float, *, continuity: bool) -> None:
        """Add the sources, if there are any, to the density rates or the accelerations ``rates`` of the fluid."""
        if self.sources is None:
            return
        position = rows[: len(rates), self._columns.position]
        if continuity:
            rates[:, self._columns.density] += self.sources.density_rate(position, time)
        else:
            rates[:, self._columns.velocity] += self.sources.acceleration(position, time)
