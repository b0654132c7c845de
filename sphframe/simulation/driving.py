"""Simulation: the force per mass that drives the fluid, gravity and the acceleration of the case."""

from sphframe.arrays import Array
from sphframe.interfaces import BodyForce
from sphframe.physics import LoopParameters, uniform_and_linear, with_body_force


class Driving:
    """The driving force of the ghosts' pressure: ``force`` (dim,), rho0 f at the origin, N/m^3, and its ``gradient``.

    The gradient (dim, dim) is that of f, 1/s^2; None where the force is uniform. ``added`` is the case's acceleration.
    """

    def __init__(self, parameters: LoopParameters, dim: int, added: BodyForce | None) -> None:
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
