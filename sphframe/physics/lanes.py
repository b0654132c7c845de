"""Physics: the particles that a loop over pairs computes at once."""

import numba


@numba.njit(error_model="numpy", forceinline=True)
def read_lanes(rows, first, present, columns, x, y, z, u, v, w, density, pressure):  # type: ignore[no-untyped-def]
    """Copy the rows from ``first`` on to arrays (LANES,); what lies beyond those ``present`` repeats the last one."""
    for a in range(x.shape[0]):
        i = first + min(a, present - 1)
        x[a], y[a], u[a], v[a] = rows[i, 0], rows[i, 1], rows[i, columns.u], rows[i, columns.v]
        z[a], w[a] = (rows[i, 2], rows[i, columns.w]) if columns.dim == 3 else (0.0, 0.0)
        density[a], pressure[a] = rows[i, columns.density], rows[i, columns.pressure]
