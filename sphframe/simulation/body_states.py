"""Simulation: generalised coordinates of the bodies, advanced by the integrator together with the fluid."""

from collections.abc import Mapping

import numpy as np

from sphframe.arrays import Array
from sphframe.errors import SimulationError
from sphframe.interfaces import Motion, RigidBody


class BodyStates:
    """Position and velocity of all ``bodies`` (by name), and their motion at the last evaluation.

    Attributes
    ----------
    position, velocity: (bodies, 3) generalised coordinates, see :class:`Motion`.
    motions: of each body, as it was last asked for.
    """

    def __init__(self, bodies: Mapping[str, RigidBody]) -> None:
        self._bodies = list(bodies.items())
        count = len(self._bodies)
        self.position = np.zeros((count, 3))
        self.velocity = np.zeros((count, 3))
        self.motions = [Motion(np.zeros(3), np.zeros(3), np.zeros(3)) for _ in range(count)]
        self._rates = np.zeros((2, count, 3))
        self._start = np.zeros((2, count, 3))
        self._total = np.zeros((2, count, 3))

    def __len__(self) -> int:
        """Return the number of bodies."""
        return len(self._bodies)

    @property
    def need_loads(self) -> bool:
        """Whether the motion of any body depends on the force of the fluid."""
        return any(body.needs_load for _, body in self._bodies)

    def present_motions(self) -> dict[str, Motion]:
        """Return the motion of each body at the end of the last step."""
        present = {}
        for k, (name, body) in enumerate(self._bodies):
            present[name] = self.motions[k]
            if body.needs_load:  # its motion was asked for within the step, before the integrator completed it
                present[name] = self.motions[k]._replace(
                    position=self.position[k].copy(), velocity=self.velocity[k].copy()
                )
        return present

    def update_motions(self, time: float, loads: Array) -> None:
        """Ask each body for its motion at ``time``; one that depends on its load keeps its last acceleration.

        ``loads`` (bodies, 3): force and moment of the fluid on each body.
        """
        for k, (_, body) in enumerate(self._bodies):
            motion = self._ask(time, k, loads[k])
            kept = self.motions[k].acceleration if body.needs_load else motion.acceleration
            self.motions[k] = motion._replace(acceleration=kept)

    def update_rates(self, time: float, loads: Array) -> None:
        """Compute velocities and accelerations under the present ``loads`` (bodies, 3)."""
        for k, (_, body) in enumerate(self._bodies):
            if body.needs_load:
                self.motions[k] = self._ask(time, k, loads[k])
        for k, motion in enumerate(self.motions):
            self._rates[0, k] = motion.velocity
            self._rates[1, k] = motion.acceleration

    def _ask(self, time: float, k: int, load: Array) -> Motion:
        name, body = self._bodies[k]
        try:
            motion = body.motion(time, self.position[k], self.velocity[k], load)
            self.position[k], self.velocity[k] = motion.position, motion.velocity
            fault = "" if np.all(np.isfinite(motion)) or not np.all(np.isfinite(load)) else f"returned {motion}"
        except Exception as error:
            fault = f"raised {type(error).__name__}: {error}"
        if fault:
            raise SimulationError(
                f"body {name!r} failed: {type(body).__name__}.motion at t = {time:.6g} s with load {load} {fault};"
                " fix it: it must return a Motion of three arrays of three finite numbers"
            )
        return motion

    def hold(self) -> None:
        """Remember the state as the start of the step."""
        self._start[0], self._start[1] = self.position, self.velocity
        self._total[:] = 0.0

    def advance(self, interval: float) -> None:
        """y = y0 + interval * f."""
        self.position[:], self.velocity[:] = self._start + interval * self._rates

    def accumulate(self, weight: float) -> None:
        """total = total + weight * f."""
        self._total += weight * self._rates

    def advance_total(self, interval: float) -> None:
        """y = y0 + interval * total."""
        self.position[:], self.velocity[:] = self._start + interval * self._total

    def drift(self, interval: float) -> None:
        """x = x + interval * u."""
        self.position += interval * self.velocity

    def kick(self, interval: float) -> None:
        """u = u + interval * acceleration."""
        self.velocity += interval * self._rates[1]

    def state(self) -> dict[str, Array]:
        """Return copies of all that the next step depends on, by name."""
        return {
            "position": self.position.copy(),
            "velocity": self.velocity.copy(),
            "rates": self._rates.copy(),
            "motions": np.array(self.motions).reshape(-1, 3, 3),
        }

    def restore(self, state: Mapping[str, Array]) -> None:
        """Continue from what :meth:`state` returned."""
        self.position[:] = state["position"]
        self.velocity[:] = state["velocity"]
        self._rates[:] = state["rates"]
        self.motions[:] = [Motion(*motion.copy()) for motion in state["motions"]]
