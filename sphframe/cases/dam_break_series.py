"""Cases: pressure and density of a rectangular water column at the instant at which the gate is removed."""

import math
from dataclasses import dataclass

import numpy as np

from sphframe.arrays import Array

_NEGLIGIBLE = 40.0
"""exp(-40) = 4e-18 is below round-off"""


@dataclass(frozen=True)
class WaterColumn:
    """The column of a dam break, 0 <= x <= L and 0 <= y <= H, at the instant at which the gate is removed.

    Its pressure obeys the Laplace equation, dp/dy = -rho g on the bed, dp/dx = 0 on the wall x = 0, p = 0 on the free
    sides x = L and y = H, and p = c0^2 (rho - rho0); Eqs. 23-25 of Huang et al. (2019)::

        rho = rho0 + sum_n alpha_n cos(lambda_n x) sinh(lambda_n (H - y)),   lambda_n = (n + 1/2) pi / L

        alpha_n = rho0 g sin(lambda_n L)
                  / {lambda_n [c0^2 lambda_n cosh(lambda_n H) - g sinh(lambda_n H)] L/2}

    Attributes
    ----------
    height, length
        H and L, m.
    reference_density
        rho0, kg/m^3.
    gravity
        g, m/s^2.
    sound_speed
        c0, m/s.
    terms
        largest number of terms that are summed. Away from the bed the sum ends once exp(-lambda_n y) is below
        round-off. On the bed itself the error of the pressure is largest near the corner (L, 0), about
        2 L / (pi^2 terms) rho0 g.

    Notes
    -----
    Departs from the paper: Eq. 24 prints sin(lambda_n x) for sin(lambda_n L). Its last factor
    L/2 + sin(2 lambda_n L) / (4 lambda_n) is L/2, since 2 lambda_n L is an odd multiple of pi. The hyperbolic functions
    overflow near n = 450: their ratios are evaluated by decaying exponentials.

    Source: Huang et al. (2019), doi:10.3390/w11051110, section 4.2.

    Examples
    --------
    >>> column = WaterColumn(0.6, 1.2, reference_density=1000.0, gravity=9.81, sound_speed=48.52)
    >>> (column.pressure(np.array([0.0]), np.array([0.0])) / (1000.0 * 9.81 * 0.6)).round(3)
    array([0.932])
    """

    height: float
    length: float
    reference_density: float
    gravity: float
    sound_speed: float
    terms: int = 4096

    def density(self, x: Array, y: Array) -> Array:
        """Return the density, kg/m^3, at ``x`` and ``y``, arrays of equal shape, in m; y upwards from the bed."""
        excess = np.zeros(x.shape)
        for n in range(self.terms):
            wave_number = (n + 0.5) * math.pi / self.length
            near_bed = wave_number * y < _NEGLIGIBLE
            if not near_bed.any():
                break
            depth = y[near_bed]
            decay = np.exp(-wave_number * depth) - np.exp(-wave_number * (2.0 * self.height - depth))
            excess[near_bed] += self._amplitude(n, wave_number) * np.cos(wave_number * x[near_bed]) * decay
        return self.reference_density + excess

    def _amplitude(self, n: int, wave_number: float) -> float:
        """Return alpha_n exp(lambda_n H) / 2, kg/m^3."""
        over_cosh = 1.0 / (1.0 + math.exp(-2.0 * wave_number * self.height))
        tanh = math.tanh(wave_number * self.height)
        sign = 1.0 if n % 2 == 0 else -1.0  # sin(lambda_n L)
        amplitude = 2.0 * sign * self.reference_density * self.gravity / (self.length * wave_number)
        return amplitude * (over_cosh / (self.sound_speed**2 * wave_number - self.gravity * tanh))

    def pressure(self, x: Array, y: Array) -> Array:
        """Return the pressure p = c0^2 (rho - rho0), Pa, at ``x`` and ``y`` as in :meth:`density`."""
        return self.sound_speed**2 * (self.density(x, y) - self.reference_density)
