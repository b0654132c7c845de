"""Physics: pressure from the equation of state, the volume V = m / rho, and at first the density from the pressure."""

from typing import Any

import numba

__all__ = ["invert_pressure", "update_pressure"]

# parts bound by specialise()
DIM = 2


def PRESSURE(density: Any, reference_density: Any, sound_speed: Any) -> Any:  # noqa: N802
    """Stand for the equation of state."""


def DENSITY(pressure: Any, reference_density: Any, sound_speed: Any) -> Any:  # noqa: N802
    """Stand for the inverse of the equation of state."""


def invert_pressure(rows, count, reference_density, sound_speed):  # type: ignore[no-untyped-def]
    """Write the density (kg/m^3) of the first ``count`` rows from their pressure."""
    for i in range(count):
        rows[i, 2 * DIM] = DENSITY(rows[i, 2 * DIM + 1], reference_density, sound_speed)


def update_pressure(rows, count, reference_density, sound_speed):  # type: ignore[no-untyped-def]
    """Write pressure (Pa) and volume (m^d) of the first ``count`` rows from their density and mass."""
    for i in numba.prange(count):
        density = rows[i, 2 * DIM]
        rows[i, 2 * DIM + 1] = PRESSURE(density, reference_density, sound_speed)
        rows[i, 2 * DIM + 2] = rows[i, 2 * DIM + 3] / density
