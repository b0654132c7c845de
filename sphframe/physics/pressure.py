"""Physics: pressure from the equation of state, and the volume V = m / rho."""

from typing import Any

import numba

__all__ = ["update_pressure"]

# parts bound by specialise()
DIM = 2


def PRESSURE(density: Any, reference_density: Any, sound_speed: Any) -> Any:  # noqa: N802
    """Stand for the equation of state."""


def update_pressure(rows, count, reference_density, sound_speed):  # type: ignore[no-untyped-def]
    """Write pressure (Pa) and volume (m^d) of the first ``count`` rows from their density and mass."""
    for i in numba.prange(count):
        density = rows[i, 2 * DIM]
        rows[i, 2 * DIM + 1] = PRESSURE(density, reference_density, sound_speed)
        rows[i, 2 * DIM + 2] = rows[i, 2 * DIM + 3] / density
