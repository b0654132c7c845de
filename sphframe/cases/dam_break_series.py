"""Cases: pressure and density of a rectangular water column at the instant the gate is gone."""

import math

import numpy as np
from numpy.typing import NDArray

__all__ = ["dam_break_density", "dam_break_pressure"]

Array = NDArray[np.float64]

_NEGLIGIBLE = 40.0


def dam_break_density(
    x: Array,
    y: Array,
    *,
    height: float,
    length: float,
    reference_density: float,
    gravity: float,
    sound_speed: float,
    terms: int = 4096,
) -> Array:
    """Return the initial density of a dam break, Eqs. 23-25 of Huang et al. (2019).

    The pressure of a column 0 <= x <= L, 0 <= y <= H obeys the Laplace equation, dp/dy = -rho g on the bed,
    dp/dx = 0 on the wall x = 0, p = 0 on the free sides x = L and y = H, and p = c0^2 (rho - rho0)::

        rho = rho0 + sum_n alpha_n cos(lambda_n x) sinh(lambda_n (H - y)),   lambda_n = (n + 1/2) pi / L

        alpha_n = rho0 g sin(lambda_n L)
                  / {lambda_n [c0^2 lambda_n cosh(lambda_n H) - g sinh(lambda_n H)] L/2}

    Departs from the paper: Eq. 24 prints sin(lambda_n x) for sin(lambda_n L). Its last factor
    L/2 + sin(2 lambda_n L) / (4 lambda_n) is L/2, since 2 lambda_n L is an odd multiple of pi. The hyperbolic functions
    overflow near n = 450: their ratios are evaluated by decaying exponentials.

    Parameters
    ----------
    x, y: coordinates of equal shape, in m; y upwards from the bed.
    height, length: H and L, in m.
    reference_density, gravity, sound_speed: rho0 in kg/m^3, g in m/s^2, c0 in m/s.
    terms: most terms that are summed; away from the bed the sum ends once exp(-lambda_n y) is below round-off. On the
        bed itself the pressure's error is largest beside the corner (L, 0), about 2 L / (pi^2 terms) rho0 g.

    Returns
    -------
    rho, in kg/m^3, with the shape of ``x``.

    Source: Huang et al. (2019), doi:10.3390/w11051110, section 4.2.

    Examples
    --------
    >>> corner = dam_break_density(np.array([0.0]), np.array([0.0]), height=0.6, length=1.2,
    ...     reference_density=1000.0, gravity=9.81, sound_speed=48.52)
    >>> (48.52**2 * (corner - 1000.0) / (1000.0 * 9.81 * 0.6)).round(3)
    array([0.932])
    """
    x, y = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    excess = np.zeros(x.shape)
    for n in range(terms):
        wave_number = (n + 0.5) * math.pi / length
        near_bed = wave_number * y < _NEGLIGIBLE
        if not near_bed.any():
            break
        depth = y[near_bed]
        over_cosh = 1.0 / (1.0 + math.exp(-2.0 * wave_number * height))
        tanh = math.tanh(wave_number * height)
        amplitude = 2.0 * (-1) ** n * reference_density * gravity / (length * wave_number)
        amplitude *= over_cosh / (sound_speed**2 * wave_number - gravity * tanh)
        decay = np.exp(-wave_number * depth) - np.exp(-wave_number * (2.0 * height - depth))
        excess[near_bed] += amplitude * np.cos(wave_number * x[near_bed]) * decay
    return reference_density + excess


def dam_break_pressure(
    x: Array,
    y: Array,
    *,
    height: float,
    length: float,
    reference_density: float,
    gravity: float,
    sound_speed: float,
    terms: int = 4096,
) -> Array:
    """Return the initial pressure p = c0^2 (rho - rho0) of :func:`dam_break_density`, in Pa."""
    density = dam_break_density(
        x,
        y,
        height=height,
        length=length,
        reference_density=reference_density,
        gravity=gravity,
        sound_speed=sound_speed,
        terms=terms,
    )
    return sound_speed**2 * (density - reference_density)
