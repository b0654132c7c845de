"""Bodies: a body that moves freely under the water's force and its own weight."""

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from sphframe.arrays import Array
from sphframe.interfaces.rigid_body import Motion, RigidBody


@final
@dataclass(frozen=True)
class Free(RigidBody):
    """A rigid body with three degrees of freedom in two dimensions.

    ::

        m A = F - m g e_y,    I alpha = M    (about the centre of mass)

    Attributes
    ----------
    mass: m, kg/m; ``inertia``: moment of inertia I about the centre of mass, kg m; per metre of width.
    centre: centre of mass as drawn, m.
    gravity: m/s^2, downwards along y.

    The ghosts' pressure contains the wall's acceleration, and the acceleration follows from the pressure of the
    evaluation before. This iteration converges when the body is heavier than the water whose pressure responds within
    one evaluation. That is not the added mass of the body, which acts only after sound waves have passed, but a layer
    of a third of a particle spacing around it: in tests, a body was unstable below m = 0.34 rho dx times its wetted
    length. A floating body is heavier than that if its draught exceeds half a particle spacing.
    """

    mass: float
    inertia: float
    centre: tuple[float, ...] = (0.0, 0.0)
    gravity: float = 9.81

    needs_load: ClassVar[bool] = True

    def __post_init__(self) -> None:
        for name in ("mass", "inertia"):
            if not getattr(self, name) > 0.0:
                raise ValueError(f"{name} = {getattr(self, name)} must be positive")
        if not self.gravity >= 0.0:
            raise ValueError(f"gravity = {self.gravity} must not be negative")
        if len(self.centre) != 2:
            raise ValueError(f"centre = {self.centre} must be a point of the plane: free bodies are two-dimensional")

    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the motion under ``load`` and gravity."""
        acceleration = load / np.array([self.mass, self.mass, self.inertia])
        acceleration[1] -= self.gravity
        return Motion(position.copy(), velocity.copy(), acceleration)
