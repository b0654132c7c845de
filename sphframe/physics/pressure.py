"""Physics: pressure from the equation of state, the volume V = m / rho, and the initial density from the pressure."""

import numba

from sphframe.compiled.stand_ins import COLUMNS, DENSITY, PRESSURE


def invert_pressure(rows, count, parameters):  # type: ignore[no-untyped-def]
    """Write the density (kg/m^3) of the first ``count`` rows from their pressure."""
    for i in range(count):
        pressure = rows[i, COLUMNS.pressure]
        rows[i, COLUMNS.density] = DENSITY(pressure, parameters.reference_density, parameters.sound_speed)


def update_pressure(rows, count, parameters):  # type: ignore[no-untyped-def]
    """Write pressure (Pa) and volume (m^d) of the first ``count`` rows from their density and mass."""
    for i in numba.prange(count):
        density = rows[i, COLUMNS.density]
        rows[i, COLUMNS.pressure] = PRESSURE(density, parameters.reference_density, parameters.sound_speed)
        rows[i, COLUMNS.volume] = rows[i, COLUMNS.mass] / density
