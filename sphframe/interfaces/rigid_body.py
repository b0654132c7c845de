"""Interfaces: the motion of a rigid body that carries walls."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

from sphframe.arrays import Array


class Motion(NamedTuple):
    """Position, velocity and acceleration in generalised coordinates.

    In 2-D each is an array ``(x, y, angle)`` in (m, m, rad), shape (3,): the displacement of the body's centre from
    where it was drawn, and the rotation about it. In 3-D each has shape (6,), see :attr:`RigidBody.rotates_in_3d`:

    position: the displacement (x, y, z) in m and a rotation vector (rx, ry, rz) in rad, along the axis of the rotation
        from how the body was drawn to how it is, with the angle as its length. The integrator composes rotations as
        unit quaternions, so that no orientation is singular.
    velocity, acceleration: of the centre, m/s and m/s^2, and the angular velocity and acceleration, rad/s and rad/s^2.
        All are vectors along the axes of space; the angular velocity is not the derivative of the rotation vector.
    """

    position: Array
    velocity: Array
    acceleration: Array


class Solid(NamedTuple):
    """The shape of a body: ``volume``, m^2 in 2-D, m^3 in 3-D; ``centroid`` (dim,), m; ``moments``, of unit density.

    The moments of inertia about the centroid are the polar one in 2-D, shape (1, 1), in m^4, and the tensor (3, 3) with
    the axes of space in 3-D, in m^5.
    """

    volume: float
    centroid: Array
    moments: Array


class Surroundings(NamedTuple):
    """What a body takes from its case: ``dimension``; ``gravity``, m/s^2; ``solid``, None without a closed wall.

    A number is gravity downwards along the last axis, see :func:`sphframe.interfaces.body_force.gravity_vector`.
    """

    dimension: int
    gravity: float | tuple[float, ...]
    solid: Solid | None


class RigidBody(ABC):
    """A body that carries walls: it returns its motion for a given load."""

    needs_load: ClassVar[bool] = False
    """whether :meth:`motion` uses the load, which costs a sum over the wall's neighbours at every stage"""

    centre: tuple[float, ...] = (0.0, 0.0)
    """initial centre of rotation, m; angles and moments refer to it"""

    initial_velocity: tuple[float, ...] = ()
    """velocity at the start in generalised coordinates; those left out are zero"""

    rotates_in_3d: ClassVar[bool] = False
    """whether the body has six generalised coordinates in 3-D; if not, all arrays of :meth:`motion` have shape (3,)"""

    @classmethod
    def with_contents(cls, options: Mapping[str, Any], folder: Path) -> dict[str, Any]:
        """Return the body's ``options`` complete with the contents of the files that they name.

        A case is kept in its output file with these options, so that the run can be repeated without those files.
        By default a body reads no file. ``folder`` is that of the case file.
        """
        return dict(options)

    def placed(self, surroundings: Surroundings) -> "RigidBody":
        """Return the body as it is in a case, with what it takes from there; by default unchanged.

        Raises
        ------
        InputError, ValueError
            when the body contradicts its surroundings; the caller adds the body's name.
        """
        return self

    @abstractmethod
    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the body's motion at ``time``.

        Parameters
        ----------
        time
            in s.
        position, velocity
            generalised coordinates as advanced by the integrator with the accelerations returned
            earlier; zero and :attr:`initial_velocity` at the start.
        load
            force on the body and moment about its centre, from the fluid and from contacts with walls: (N, N, N m)
            per metre of width in 2-D, (N, N, N, N m, N m, N m) in 3-D; zero when ``needs_load`` is false.

        Returns
        -------
        Motion
            The motion. A prescribed body ignores the arguments and returns functions of time; a dynamic body
            returns the position and velocity it was given (or corrects them, at a stop) and its acceleration.
        """
