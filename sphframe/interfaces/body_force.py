"""Interfaces: accelerations that act on all of the fluid, beside gravity."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from sphframe.arrays import Array


class BodyForce(ABC):
    """A force per mass, f(x, t) = a(t) + G(t) x, such as that of an accelerated or rotating frame of reference."""

    @classmethod
    def with_contents(cls, options: Mapping[str, Any], folder: Path) -> dict[str, Any]:
        """Return the ``options`` complete with the contents of files, as :meth:`RigidBody.with_contents` does."""
        return dict(options)

    def placed(self, dimension: int, gravity: Array) -> "BodyForce":
        """Return the force as it is in a case with this ``gravity`` (dim,), m/s^2; by default unchanged.

        Raises
        ------
        InputError, ValueError
            when the force contradicts the case.
        """
        return self

    @abstractmethod
    def acceleration(self, time: float) -> Array:
        """Return a (dim,) at ``time`` (s): the force at the origin, m/s^2."""

    def gradient(self, time: float) -> Array | None:
        """Return G (dim, dim) at ``time``, 1/s^2; None for a uniform force, the default."""
        return None


def gravity_vector(gravity: float | Sequence[float], dimension: int) -> Array:
    """Return the acceleration of gravity (dim,), m/s^2; a number acts downwards along the last axis.

    >>> gravity_vector(9.81, 2).tolist()
    [0.0, -9.81]

    Raises
    ------
    ValueError
        when a vector has another number of components.
    """
    if isinstance(gravity, Sequence):
        if len(gravity) != dimension:
            raise ValueError(f"gravity = {[*gravity]} must have {dimension} components, or be a number, downwards")
        return np.array(gravity, dtype=np.float64)
    vector = np.zeros(dimension)
    vector[-1] = -gravity
    return vector
