"""Testing: body forces, one check function per property."""

from collections.abc import Callable

import numpy as np

from sphframe.interfaces import BodyForce
from sphframe.interfaces.body_force import gravity_vector
from sphframe.testing.evaluation import title
from sphframe.testing.proof import require


def check_force(force: BodyForce) -> None:
    """Force and gradient are finite, of the shape of the dimension, and the same ones for the same time."""
    placed = None
    for dim in (2, 3):
        try:
            placed = force.placed(dim, gravity_vector(9.81, dim))
        except ValueError:  # it is of the other dimension
            continue
        for time in (0.0, 0.3, 2.7):
            for what, shape in (("acceleration", (dim,)), ("gradient", (dim, dim))):
                first, second = (getattr(placed, what)(time) for _ in range(2))
                if what == "gradient" and first is None and second is None:
                    continue
                sound = np.shape(first) == shape and bool(np.all(np.isfinite(first)))
                require(sound, f"{title(force)}: the {what} at {time} s is {first!r}; expected finite numbers {shape}")
                require(np.array_equal(first, second), f"{title(force)}: the {what} at {time} s differs between calls")
    require(placed is not None, f"{title(force)}: it refuses both two and three dimensions")


CHECKS: dict[str, Callable[[BodyForce], None]] = {"force": check_force}
"""the checks of a body force, by the name of the property"""
