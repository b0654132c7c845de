"""Simulation: generalised coordinates of the bodies, advanced by the integrator together with the fluid.

In 3-D a rotation is advanced by composing it with the rotation of an interval, as quaternions. Two things follow from
rotations being no vectors. In a Runge-Kutta scheme the rates of the stages refer to the rotation theta since the start
of the step, and are ``theta' = omega - theta x omega / 2 + theta x (theta x omega) / 12``, up to terms of the fourth
order (H. Munthe-Kaas, BIT 38 (1998), doi:10.1007/BF02510919). And the acceleration of a body depends on its angular
velocity, so that each kick of the symplectic scheme is a step of Heun's method at a fixed load.
"""

from collections.abc import Mapping

import numpy as np

from sphframe.arrays import Array
from sphframe.errors import SimulationError
from sphframe.geometry import turned
from sphframe.interfaces import Motion, RigidBody


class BodyStates:
    """Position and velocity of all ``bodies`` (by name) in ``dim`` dimensions, and their last motion.

    Attributes
    ----------
    size
        number of generalised coordinates of a body, 3 in 2-D and 6 in 3-D.
    position, velocity
        (bodies, size) generalised coordinates, see :class:`Motion`.
    motions
        of each body, as it was last asked for.
    """

    def __init__(self, bodies: Mapping[str, RigidBody], dim: int) -> None:
        self._bodies = list(bodies.items())
        self.size = 3 if dim == 2 else 6
        count, size = len(self._bodies), self.size
        self.position = np.zeros((count, size))
        self.velocity = np.zeros((count, size))
        for k, (_, body) in enumerate(self._bodies):
            self.velocity[k, : len(body.initial_velocity)] = body.initial_velocity
        self.motions = [Motion(np.zeros(size), np.zeros(size), np.zeros(size)) for _ in range(count)]
        self._rates = np.zeros((2, count, size))
        self._start = np.zeros((2, count, size))
        self.total = np.zeros((2, count, size))
        self._loads = np.zeros((count, size))
        self._time = 0.0

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

        ``loads`` (bodies, size): force and moment on each body.
        """
        for k, (_, body) in enumerate(self._bodies):
            motion = self._ask(time, k, loads[k])
            kept = self.motions[k].acceleration if body.needs_load else motion.acceleration
            self.motions[k] = motion._replace(acceleration=kept)

    def update_rates(self, time: float, loads: Array) -> None:
        """Compute velocities and accelerations under the present ``loads`` (bodies, size)."""
        self._time, self._loads = time, loads
        for k, (_, body) in enumerate(self._bodies):
            if body.needs_load:
                self.motions[k] = self._ask(time, k, loads[k])
        for k, motion in enumerate(self.motions):
            self._rates[0, k] = motion.velocity
            self._rates[1, k] = motion.acceleration

    def _ask(self, time: float, k: int, load: Array) -> Motion:
        """Return the motion of body ``k``, and take over its position and velocity."""
        motion = self._motion(time, k, self.velocity[k], load)
        self.position[k], self.velocity[k] = motion.position, motion.velocity
        return motion

    def _motion(self, time: float, k: int, velocity: Array, load: Array) -> Motion:
        name, body = self._bodies[k]
        known = self.size if body.rotates_in_3d else 3
        try:
            motion = body.motion(time, self.position[k, :known], velocity[:known], load[:known])
            if not isinstance(motion, Motion):
                raise TypeError(f"it returned {motion!r:.80}")
            if len(motion.position) < self.size:
                motion = Motion(*(np.append(part, np.zeros(self.size - len(part))) for part in motion))
            fault = "" if np.all(np.isfinite(motion)) or not np.all(np.isfinite(load)) else f"returned {motion}"
        except Exception as error:
            fault = f"raised {type(error).__name__}: {error}"
        if fault:
            raise SimulationError(
                f"body {name!r} failed: {type(body).__name__}.motion at t = {time:.6g} s with load {load} {fault};"
                f" fix it: it must return a Motion of three arrays of {known} finite numbers"
            )
        return motion

    def hold(self) -> None:
        """Remember the state as the start of the step."""
        self._start[0], self._start[1] = self.position, self.velocity
        self.total[:] = 0.0

    def advance(self, interval: float) -> None:
        """y = y0 + interval * f."""
        self._advance_from_start(interval, self._rates_since_start())

    def accumulate(self, weight: float) -> None:
        """total = total + weight * f."""
        self.total += weight * self._rates_since_start()

    def advance_total(self, interval: float) -> None:
        """y = y0 + interval * total."""
        self._advance_from_start(interval, self.total)

    def drift(self, interval: float) -> None:
        """x = x + interval * u."""
        rotations = self.position[:, 3:].copy()
        self.position += interval * self.velocity
        for k, rotation in enumerate(rotations if self.size == 6 else ()):
            self.position[k, 3:] = turned(rotation, interval * self.velocity[k, 3:])

    def kick(self, interval: float) -> None:
        """u = u + interval * acceleration."""
        if self.size == 6:
            self._rates[1] = 0.5 * (first := self._accelerations(self.velocity))
            self._rates[1] += 0.5 * self._accelerations(self.velocity + interval * first)
        self.velocity += interval * self._rates[1]

    def _accelerations(self, velocity: Array) -> Array:
        """Return the accelerations (bodies, size) at another ``velocity``, under the loads of the last evaluation."""
        accelerations: Array = self._rates[1].copy()
        for k, (_, body) in enumerate(self._bodies):
            if body.needs_load and body.rotates_in_3d:
                accelerations[k] = self._motion(self._time, k, velocity[k], self._loads[k]).acceleration
        return accelerations

    def _rates_since_start(self) -> Array:
        """Return the rates of velocity and of position; the latter of the rotation since the start of the step."""
        rates = self._rates.copy()
        for k in range(len(self) if self.size == 6 else 0):
            theta = turned(-self._start[0, k, 3:], self.position[k, 3:])
            once = np.cross(theta, rates[0, k, 3:])
            rates[0, k, 3:] += np.cross(theta, once) / 12.0 - 0.5 * once
        return rates

    def _advance_from_start(self, interval: float, rates: Array) -> None:
        self.position[:], self.velocity[:] = self._start + interval * rates
        for k in range(len(self) if self.size == 6 else 0):
            self.position[k, 3:] = turned(self._start[0, k, 3:], interval * rates[0, k, 3:])

    def state(self) -> dict[str, Array]:
        """Return copies of all that the next step depends on, by name."""
        return {
            "position": self.position.copy(),
            "velocity": self.velocity.copy(),
            "rates": self._rates.copy(),
            "motions": np.array(self.motions).reshape(-1, 3, self.size),
            "loads": self._loads.copy(),
            "time": np.array([self._time]),
        }

    def restore(self, state: Mapping[str, Array]) -> None:
        """Continue from what :meth:`state` returned."""
        self.position[:] = state["position"]
        self.velocity[:] = state["velocity"]
        self._rates[:] = state["rates"]
        self.motions[:] = [Motion(*motion.copy()) for motion in state["motions"]]
        self._loads, self._time = state["loads"].copy(), float(state["time"][0])
