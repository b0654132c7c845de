"""Bodies: a body that moves freely under the water's force and its own weight."""

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from sphframe.interfaces.rigid_body import Array, Motion, RigidBody

__all__ = ["Free"]


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
    added_mass: kg/m of water that is taken along implicitly, see below.

    The ghosts' pressure contains the wall's acceleration, and the acceleration is computed from the pressure of the
    evaluation before. That iteration converges when the body is heavier than the water that answers at once, which
    is not the whole added mass but the layer within the kernel's reach, about rho times wetted length times dx / 2
    (the rest is carried by sound). For lighter bodies give ``added_mass`` of that size or more: each new
    acceleration is then a mean of the old, with the weight added_mass, and of force over mass, with the weight m. A
    steady acceleration is not changed by it, and a varying one lags by added_mass / m time steps.
    """

    mass: float
    inertia: float
    centre: tuple[float, ...] = (0.0, 0.0)
    gravity: float = 9.81
    added_mass: float = 0.0

    needs_load: ClassVar[bool] = True

    def __post_init__(self) -> None:
        for name in ("mass", "inertia"):
            if not getattr(self, name) > 0.0:
                raise ValueError(f"{name} = {getattr(self, name)} must be positive")
        for name in ("gravity", "added_mass"):
            if not getattr(self, name) >= 0.0:
                raise ValueError(f"{name} = {getattr(self, name)} must not be negative")
        if len(self.centre) != 2:
            raise ValueError(f"centre = {self.centre} must be a point of the plane: free bodies are two-dimensional")

    @property
    def relaxation(self) -> float:
        """Weight of a new acceleration, m / (m + added_mass)."""
        return self.mass / (self.mass + self.added_mass)

    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the motion under ``load`` and gravity."""
        acceleration = load / np.array([self.mass, self.mass, self.inertia])
        acceleration[1] -= self.gravity
        return Motion(position.copy(), velocity.copy(), acceleration)
