"""Particles: one packed row of float64 per particle, fluid first, then ghosts.

A pair loop reads all it needs of a neighbour from one place in memory: in 2-D a row is one cache line of 64 bytes.
With d dimensions the columns are

=========== ======= ===========================================
column      name    quantity
=========== ======= ===========================================
0 .. d-1            position, m
d .. 2d-1           velocity, m/s
2d          density density, kg/m^3
2d + 1      press.  pressure, Pa
2d + 2      volume  volume m/rho, m^d
2d + 3      mass    mass, kg (per metre of width in 2-D)
=========== ======= ===========================================
"""

import numpy as np
from numpy.typing import NDArray

__all__ = ["Columns"]

Array = NDArray[np.float64]


class Columns:
    """Where each quantity stands in a row, for ``dim`` dimensions."""

    def __init__(self, dim: int) -> None:
        self.position = slice(0, dim)
        self.velocity = slice(dim, 2 * dim)
        self.density = 2 * dim
        self.pressure = 2 * dim + 1
        self.volume = 2 * dim + 2
        self.mass = 2 * dim + 3
        self.width = 2 * dim + 4

    def empty(self, count: int) -> Array:
        """Return ``count`` rows of zeros, shape (count, width)."""
        return np.zeros((count, self.width))
