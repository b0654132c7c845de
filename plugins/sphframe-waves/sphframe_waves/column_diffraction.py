"""The force of a solitary wave on a round column, by the linear theory of long waves."""

import math
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray
from scipy.special import h1vp, hankel1, jvp

from sphframe import Array

ComplexArray = NDArray[np.complex128]

_ORDERS = np.arange(1, 8, 2)
"""odd orders m of cos(m theta) by which columns side by side feel each other"""
_SMALL = 36.0
"""-log of what is left out of spectrum and images"""


@final
@dataclass(frozen=True)
class ColumnDiffraction:
    """A solitary wave that runs past a vertical round column, by the linear theory of long waves.

    The wave is a sum of long waves exp[i q (x - c t)], x from the axis of the column, which all have the speed c::

        eta = A sech^2[k (x - c t)] = integral of E(q) exp[i q (x - c t)] dq,  E = A q / (2 k^2 sinh(pi q / (2 k)))

    The column of radius a reflects each of them (MacCamy and Fuchs, with a pressure that does not depend on the
    height: q d << 1). On it, the elevation is that of Isaacson, and with it the force along x::

        eta = sum_m D_m 2 i / (pi q a H_m'(q a)) exp(i m theta) E(q) exp(-i q c t),    D_m = i^m in the open sea
        F = integral of 4 rho g d E(q) / (q H_1'(q a)) (D_1 / i) exp(-i q c t) dq

    with Hankel functions H of the first kind. In a channel of the ``width`` W, with the column in its middle, the side
    walls are mirrors: the column stands in a row of columns W apart, of which each also reflects the waves of the
    others, by Graf's addition theorem::

        D_m = i^m - sum_n J_n'(q a) / H_n'(q a) D_n (S_(n-m) - S_(n+m)),    S_p = 2 cos(p pi / 2) sum_j H_p(j q W)

    over j = 1, 2, ... and odd m and n > 0. For columns that are thin beside the wave and the channel, this is the
    force of inertia 2 pi rho a^2 d Du/Dt / (1 - (pi a / W)^2 / 3).

    Attributes
    ----------
    wave_height
        A, m.
    wavenumber
        k of the solitary wave, 1/m.
    speed
        c, m/s.
    depth
        d, m.
    radius
        a, m.
    width
        W, m; infinite for the open sea.
    density
        rho, kg/m^3.
    gravity
        g, m/s^2.

    Raises
    ------
    ValueError
        when a length, the speed, the density or the gravity is not positive, or the column does not fit the channel.

    Notes
    -----
    It is of first order in A / d: forces of the square of the velocity, the height of the water along the column and
    the steepening of the waves that the column reflects are left out. Departs from Isaacson, whose column stands in the
    open sea.

    The integral is taken along the line Im q = k / 2, where waves grow in time, so that the sums over j converge.

    Source: R. C. MacCamy, R. A. Fuchs (1954), Beach Erosion Board TM-69; M. de St Q. Isaacson (1983),
    doi:10.1061/(ASCE)0733-950X(1983)109:1(121); for waves that columns send to
    each other C. M. Linton, D. V. Evans, J. Fluid Mech. 215 (1990) 549, doi:10.1017/S0022112090002750.

    Examples
    --------
    >>> wave = ColumnDiffraction(wave_height=0.1, wavenumber=0.25, speed=3.3, depth=1.0, radius=0.5)
    >>> wave.force(np.array([-0.8, 0.0, 0.8])).round(0)
    array([ 298.,   22., -309.])
    """

    wave_height: float
    wavenumber: float
    speed: float
    depth: float
    radius: float
    width: float = math.inf
    density: float = 1000.0
    gravity: float = 9.81

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not value > 0.0:
                raise ValueError(f"{name} = {value} must be positive")
        if not self.width > 2.0 * self.radius:
            raise ValueError(
                f"width = {self.width} of the channel must be more than the diameter of the column, {2 * self.radius}:"
                " give a wider channel or a thinner column"
            )

    def elevation(self, x: float, time: Array) -> Array:
        """Return the elevation (t,), m, of the wave alone, ``x`` m behind the axis, at ``time`` (t,), s."""
        phase = np.minimum(np.abs(self.wavenumber * (x - self.speed * np.asarray(time))), 300.0)
        return np.asarray(self.wave_height / np.cosh(phase) ** 2)

    def force(self, time: Array) -> Array:
        """Return the force (t,) along x, N, at ``time`` (t,), s, from when the crest would pass the axis."""
        step = self.wavenumber / 20.0
        count = math.ceil(2.0 * _SMALL / math.pi * self.wavenumber / step)
        q: ComplexArray = np.asarray(step * np.arange(count + 1) + 0.5j * self.wavenumber, np.complex128)
        weight = np.where(q.real > 0.0, 2.0 * step, step)  # the other half has the conjugate values
        waves = weight * self.spectrum(q) * self.force_of_wave(q)
        return np.asarray((np.exp(-1j * self.speed * np.outer(time, q)) @ waves).real)

    def spectrum(self, q: ComplexArray) -> ComplexArray:
        """Return E (n,), m^2, of the wave at complex wavenumbers ``q`` (n,), 1/m."""
        k = self.wavenumber
        return np.asarray(self.wave_height * q / (2.0 * k * k * np.sinh(0.5 * math.pi / k * q)))

    def force_of_wave(self, q: ComplexArray) -> ComplexArray:
        """Return the force (n,), N/m, of a wave exp[i q (x - c t)] of 1 m at t = 0, at ``q`` (n,), 1/m, Im q > 0."""
        scale = 4.0 * self.density * self.gravity * self.depth
        return np.asarray(scale * self.orders(q)[:, 0] / (1j * q * h1vp(1, q * self.radius)))

    def orders(self, q: ComplexArray) -> ComplexArray:
        """Return D_m (n, 4) of m = 1, 3, 5 and 7, without units, at wavenumbers ``q`` (n,), 1/m, Im q > 0."""
        alone = 1j ** _ORDERS.astype(np.complex128)
        if math.isinf(self.width):
            return np.tile(alone, (len(q), 1))
        images = np.arange(1, math.ceil(_SMALL / (q.imag.min() * self.width)) + 1)
        even = np.arange(0, 2 * _ORDERS[-1] + 1, 2)
        row = np.array([[hankel1(p, images * self.width * one).sum() for p in even] for one in q])
        sums = 2.0 * np.cos(0.5 * math.pi * even) * row
        m, n = _ORDERS[:, None], _ORDERS[None, :]
        z = (q * self.radius)[:, None]
        reflected = (jvp(_ORDERS, z) / h1vp(_ORDERS, z))[:, None, :]
        matrix = np.eye(len(_ORDERS)) + reflected * (sums[:, np.abs(n - m) // 2] - sums[:, (n + m) // 2])
        return np.asarray(np.linalg.solve(matrix, np.broadcast_to(alone[:, None], (len(q), len(alone), 1)))[:, :, 0])
