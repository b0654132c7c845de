"""Bodies: a body at rest."""

from typing import final

import numpy as np

from sphframe.arrays import Array
from sphframe.interfaces.rigid_body import Motion, RigidBody


@final
class Fixed(RigidBody):
    """A body that never moves."""

    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return no displacement."""
        rest = np.zeros(3)
        return Motion(rest, rest, rest)
