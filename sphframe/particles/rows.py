"""Particles: one packed row of float64 per particle, fluid first, then ghosts.

A pair loop reads all it needs of a neighbour from one place in memory: in 2-D a row is one cache line of 64 bytes.
With d dimensions the columns are

=========== ======== ===========================================
column      name     quantity
=========== ======== ===========================================
0 .. d-1    position position, m; the last one is the height
d .. 2d-1   velocity velocity, m/s
2d          density  density, kg/m^3
2d + 1      pressure pressure, Pa
2d + 2      volume   volume m/rho, m^d
2d + 3      mass     mass, kg (per metre of width in 2-D)
=========== ======== ===========================================
"""

from typing import NamedTuple

import numpy as np

from sphframe.arrays import Array


class Columns(NamedTuple):
    """Column of each quantity in a row, for ``dim`` dimensions. Compiled functions read the fields.

    Attributes
    ----------
    z
        the last coordinate, the height; the others are columns 0 and, in 3-D, 1.
    u, v, w
        first, second and last component of the velocity (in 2-D ``w`` is ``v``).
    density, pressure, volume, mass
        as in the table above.
    width
        number of columns.
    """

    dim: int
    z: int
    u: int
    v: int
    w: int
    density: int
    pressure: int
    volume: int
    mass: int
    width: int

    @classmethod
    def of(cls, dim: int) -> "Columns":
        """Return the columns for ``dim`` = 2 or 3."""
        return cls(
            dim, z=dim - 1, u=dim, v=dim + 1, w=2 * dim - 1,
            density=2 * dim, pressure=2 * dim + 1, volume=2 * dim + 2, mass=2 * dim + 3, width=2 * dim + 4,
        )  # fmt: skip

    @property
    def position(self) -> slice:
        """Columns of the position."""
        return slice(0, self.dim)

    @property
    def velocity(self) -> slice:
        """Columns of the velocity."""
        return slice(self.u, 2 * self.dim)

    def zeros(self, count: int) -> Array:
        """Return ``count`` rows of zeros, shape (count, width)."""
        return np.zeros((count, self.width))
