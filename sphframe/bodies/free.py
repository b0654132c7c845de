"""Bodies: a body that moves freely under the water's force and its own weight."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, final

import numpy as np

from sphframe.arrays import Array
from sphframe.geometry import directions_to_world, moments, rotation_matrix, turning_velocities
from sphframe.interfaces.body_force import gravity_vector
from sphframe.interfaces.rigid_body import Motion, RigidBody, Surroundings

_STANDARD_GRAVITY = 9.81
_COORDINATES = {2: ("x", "y", "angle"), 3: ("x", "y", "z", "rx", "ry", "rz")}


@final
@dataclass(frozen=True)
class Free(RigidBody):
    """A rigid body with three degrees of freedom in 2-D and six in 3-D, some of which may be held.

    ::

        m A = F + m g,    I alpha + omega x I omega = M    (about the centre of mass; in 2-D omega x I omega = 0)

    A body with a ``hinge`` turns about this point, at r from which its centre of mass lies::

        (I + m (r^2 1 - r r^T)) alpha = M + r x (F + m g) - omega x (...) omega,    A = alpha x r + omega x (omega x r)

    Of what is not given, mass, inertia and centre are those of the closed walls that the body carries, filled with
    the ``density``; gravity is that of the case.

    Attributes
    ----------
    mass
        m, kg/m in 2-D, kg in 3-D.
    inertia
        I about the centre of mass, as drawn: kg m in 2-D; in 3-D kg m^2, three moments about axes parallel to
        those of space, or a matrix.
    centre
        centre of mass as drawn, m.
    gravity
        m/s^2, downwards along the last axis or a vector, in place of that of the case.
    density
        kg/m^3, in place of the mass.
    hinge
        fixed point about which the body turns, as drawn, m.
    held
        coordinates that do not change: x, y, angle in 2-D; x, y, z, rx, ry, rz in 3-D.
    initial_velocity
        in generalised coordinates, see :class:`Motion`.

    Notes
    -----
    The ghosts' pressure contains the wall's acceleration, and the acceleration follows from the pressure of the
    evaluation before. This iteration converges when the body is heavier than the water whose pressure responds within
    one evaluation. That is not the added mass of the body, which acts only after sound waves have passed, but a layer
    around it: in tests, a body that moves in one direction was unstable below m = 0.6 rho dx times the length of its
    wetted wall across this direction. A floating body is heavier than that if its draught exceeds 0.6 particle
    spacings. A lighter one is refused, see :mod:`sphframe.simulation.light_bodies`.
    """

    mass: float | None = None
    inertia: float | tuple[float, float, float] | tuple[tuple[float, float, float], ...] | None = None
    centre: tuple[float, ...] | None = None  # type: ignore[assignment]  # None until the body is placed
    gravity: float | tuple[float, ...] | None = None
    density: float | None = None
    hinge: tuple[float, ...] | None = None
    held: tuple[str, ...] = ()
    initial_velocity: tuple[float, ...] = ()

    needs_load: ClassVar[bool] = True
    rotates_in_3d: ClassVar[bool] = True

    def __post_init__(self) -> None:
        for name in ("mass", "density"):
            value = getattr(self, name)
            if value is not None and not value > 0.0:
                raise ValueError(f"{name} = {value} must be positive")
        if isinstance(self.gravity, int | float) and not self.gravity >= 0.0:
            raise ValueError(f"gravity = {self.gravity} must not be negative")
        if self.mass is not None and self.density is not None:
            raise ValueError(f"mass = {self.mass} and density = {self.density} are both given; give one of them")
        if self.inertia is not None:
            tensor = _tensor(self.inertia)
            if not 1e9 * np.abs(tensor - tensor.T).max() < np.linalg.eigvalsh(tensor).min():
                raise ValueError(f"inertia = {self.inertia} must be positive, and a matrix symmetric")
            object.__setattr__(self, "_inertia", 0.5 * (tensor + tensor.T))

    def placed(self, surroundings: Surroundings) -> "Free":
        """Return the body with what follows from its ``surroundings`` filled in, and everything checked together."""
        dim, solid, names = surroundings.dimension, surroundings.solid, _COORDINATES[surroundings.dimension]
        missing = [name for name in ("mass", "inertia", "centre") if getattr(self, name) is None]
        if missing and solid is None:
            raise ValueError(f"give {', '.join(missing)}; they follow from a density only if its wall is closed")
        mass, inertia, centre = self.mass, self.inertia, self.centre
        if solid is not None:
            if mass is None and self.density is None:
                raise ValueError("give its mass, or its density, from which the mass follows by its closed wall")
            mass = mass or float(self.density or 0.0) * solid.volume
            centre = centre or tuple(solid.centroid.tolist())
            if inertia is None:
                moments = mass / solid.volume * solid.moments
                inertia = float(moments[0, 0]) if dim == 2 else tuple(map(tuple, moments.tolist()))
        for name, point, length in (("centre", centre, dim), ("hinge", self.hinge, dim)):
            if point is not None and len(point) != length:
                raise ValueError(f"{name} = {point} must have {length} coordinates in {dim}-D")
        if _tensor(inertia).shape[0] != 2 * dim - 3:
            raise ValueError(f"inertia = {inertia} must be {'a number' if dim == 2 else '3 numbers or a matrix'}")
        if set(self.held) - set(names) or len(self.initial_velocity) > len(names):
            raise ValueError(f"held and initial_velocity refer to the coordinates {', '.join(names)} in {dim}-D")
        gravity = surroundings.gravity if self.gravity is None else self.gravity
        gravity_vector(gravity, dim)
        return replace(self, mass=mass, inertia=inertia, centre=centre, gravity=gravity, density=None)

    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the motion under ``load`` and gravity."""
        dim, mass = (2 if len(position) == 3 else 3), float(self.mass or 0.0)
        acceleration = np.empty_like(load)
        acceleration[:dim] = load[:dim] / mass
        acceleration[:dim] -= -gravity_vector(_STANDARD_GRAVITY if self.gravity is None else self.gravity, dim)
        position, velocity = position.copy(), velocity.copy()
        held = np.isin(_COORDINATES[dim], self.held)
        velocity[held] = 0.0
        moment, inertia = load[dim:], self._inertia_at(position, dim)
        arm = self._arm(position, dim)
        if arm is not None:
            moment = moment + moments(arm[None], mass * acceleration[None, :dim])[0]
            inertia = inertia + mass * (arm @ arm * np.eye(len(moment)) - (np.outer(arm, arm) if dim == 3 else 0.0))
        omega, turning = velocity[dim:], ~held[dim:]
        acceleration[dim:] = 0.0
        if dim == 2:
            acceleration[2:] = moment / inertia[0, 0] * turning
        elif np.any(turning):
            moment = moment - np.cross(omega, inertia @ omega)
            acceleration[3:][turning] = np.linalg.solve(inertia[np.ix_(turning, turning)], moment[turning])
        if arm is not None:
            position[:dim] = arm - (np.array(self.centre) - np.array(self.hinge))
            velocity[:dim] = turning_velocities(omega, arm[None])[0]
            acceleration[:dim] = turning_velocities(acceleration[dim:], arm[None])[0]
            acceleration[:dim] += turning_velocities(omega, velocity[None, :dim])[0]
        else:
            acceleration[held] = 0.0
        return Motion(position, velocity, acceleration)

    def _inertia_at(self, position: Array, dim: int) -> Array:
        """Return the tensor of inertia with the axes of space, (1, 1) in 2-D."""
        tensor: Array = vars(self)["_inertia"]
        if dim == 2:
            return tensor
        rotation = rotation_matrix(position[3:])
        return rotation @ tensor @ rotation.T

    def _arm(self, position: Array, dim: int) -> Array | None:
        """Return the vector from the hinge to the centre of mass at present; None without a hinge."""
        if self.hinge is None:
            return None
        arm: Array = directions_to_world(np.array([np.array(self.centre) - np.array(self.hinge)]), position)[0]
        return arm


def _tensor(inertia: float | Sequence[Any] | None) -> Array:
    given = np.array(inertia, dtype=np.float64)
    return np.diag(np.atleast_1d(given)) if given.ndim < 2 else given
