"""Bodies: a seawall on a spring."""

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from sphframe.arrays import Array
from sphframe.interfaces.rigid_body import Motion, RigidBody


@final
@dataclass(frozen=True)
class SpringMass(RigidBody):
    """A wall that the water pushes along +x against a spring, once its force exceeds a threshold.

    ::

        a = [max(F - F_threshold, 0) - k X] / m,    X >= 0;    at the stop X = 0 the velocity is zero (or outwards)

    Attributes
    ----------
    mass
        m, kg.
    stiffness
        k, N/m.
    threshold
        F_threshold, N; all per metre of width in 2-D.

    Notes
    -----
    Departs from the paper: Eq. 26 as corrected (the threshold is subtracted only while it is exceeded), and the
    velocity is set to zero at the stop, which its Eq. 28 omits: otherwise the wall at rest would keep a velocity.

    Source: X. Huang et al. (2019), doi:10.3390/w11051110, Eqs. 26-28; D. K. Liang et al. (2017),
    doi:10.1016/j.jfluidstructs.2016.12.009.
    """

    mass: float
    stiffness: float
    threshold: float = 0.0

    needs_load: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if not self.mass > 0.0:
            raise ValueError(f"mass = {self.mass} must be positive")
        for name in ("stiffness", "threshold"):
            if not getattr(self, name) >= 0.0:
                raise ValueError(f"{name} = {getattr(self, name)} must not be negative")

    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the wall's motion under the force ``load[0]``."""
        x, u = float(position[0]), float(velocity[0])
        if x <= 0.0:
            x, u = 0.0, max(u, 0.0)
        a = (max(float(load[0]) - self.threshold, 0.0) - self.stiffness * x) / self.mass
        return Motion(np.array([x, 0.0, 0.0]), np.array([u, 0.0, 0.0]), np.array([a, 0.0, 0.0]))
