"""Physics: the force per mass of gravity and of the case's acceleration.

::

    f(x, t) = g + a(t) + G(t) x

It acts on the fluid, and as b = rho0 (f - a_wall) in the pressure of the ghosts, with f at the foot of the ghost, which
is half-way to its mirror point: the pressure of a centrifugal force, quadratic in x, is mirrored exactly.
"""

import numba
import numpy as np

from sphframe.arrays import Array
from sphframe.physics.parameters import LoopParameters

_FIRST = LoopParameters._fields.index("force_x")
"""place of the twelve numbers of the force, which are the last"""


@numba.njit(error_model="numpy", forceinline=True)
def body_force(p, x, y, z):  # type: ignore[no-untyped-def]
    """Return f, m/s^2, at a point, from :class:`LoopParameters`; in 2-D its last component, and ``z``, are not used."""
    return (
        p.force_x + (p.force_xx * x + p.force_xy * y + p.force_xz * z),
        p.force_y + (p.force_yx * x + p.force_yy * y + p.force_yz * z),
        p.force_z + (p.force_zx * x + p.force_zy * y + p.force_zz * z),
    )


def with_body_force(parameters: LoopParameters, force: Array, gradient: Array | None) -> LoopParameters:
    """Return ``parameters`` with the ``force`` (dim,) at the origin, m/s^2, and its ``gradient`` (dim, dim), 1/s^2."""
    dim = len(force)
    values = np.zeros((4, 3))
    values[0, :dim] = force
    if gradient is not None:
        values[1 : dim + 1, :dim] = gradient
    return LoopParameters(*parameters[:_FIRST], *values.ravel().tolist())


def uniform_and_linear(parameters: LoopParameters, dim: int) -> tuple[Array, Array | None]:
    """Return the force (dim,) at the origin and its gradient (dim, dim), None where it is zero."""
    values = np.array(parameters[_FIRST:]).reshape(4, 3)
    gradient = values[1 : dim + 1, :dim]
    return values[0, :dim], gradient if gradient.any() else None
