"""Bodies: a body whose motion is a given function of time."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np

from sphframe.arrays import Array
from sphframe.interfaces.rigid_body import Motion, RigidBody


@final
@dataclass(frozen=True)
class Prescribed(RigidBody):
    """A body moved by ``function``: time (s) -> displacement, velocity and acceleration in generalised coordinates.

    Each is a sequence of three numbers, or of six in 3-D, as in :class:`Motion`; the three must be consistent.

    Attributes
    ----------
    function
        the motion; only in Python, since a case file is data.
    centre
        about which the body turns, m.
    """

    function: Callable[[float], tuple[object, object, object]]
    centre: tuple[float, ...] = (0.0, 0.0)

    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the given motion at ``time``."""
        x, u, a = (np.asarray(part, dtype=np.float64) for part in self.function(time))
        return Motion(x, u, a)
