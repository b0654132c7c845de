"""Interfaces: the motion of a rigid body that carries walls."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

from sphframe.arrays import Array


class Motion(NamedTuple):
    """Position, velocity and acceleration in generalised coordinates.

    Each is an array: the displacement of the body from its initial position, followed by the rotation about its
    centre. In 2-D it is ``(x, y, angle)`` in (m, m, rad), shape (3,); in 3-D ``(x, y, z)`` in m, shape (3,).
    """

    position: Array
    velocity: Array
    acceleration: Array


class RigidBody(ABC):
    """A body that carries walls: it returns its motion for a given load."""

    needs_load: ClassVar[bool] = False
    """whether :meth:`motion` uses the load, which costs a sum over the wall's neighbours at every stage"""

    centre: tuple[float, ...] = (0.0, 0.0)
    """initial centre of rotation, m; angles and moments refer to it"""

    @classmethod
    def with_contents(cls, options: Mapping[str, Any], folder: Path) -> dict[str, Any]:
        """Return the body's ``options`` complete with the contents of the files that they name.

        A case is kept in its output file with these options, so that the run can be repeated without those files.
        By default a body reads no file. ``folder`` is that of the case file.
        """
        return dict(options)

    @abstractmethod
    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the body's motion at ``time``.

        Parameters
        ----------
        time: in s.
        position, velocity: generalised coordinates as advanced by the integrator with the accelerations returned
            earlier; zero at the start.
        load: force and moment of the fluid on the body, (N, N, N m) per metre of width in 2-D, (N, N, N) in 3-D;
            zero when ``needs_load`` is false.

        Returns
        -------
        The motion. A prescribed body ignores the arguments and returns functions of time; a dynamic body
        returns the position and velocity it was given (or corrects them, at a stop) and its acceleration.
        """
