"""Physics: continuity with density diffusion.

::

    Drho_i/Dt = -rho_i sum_j (u_j - u_i).grad_i W_ij V_j + delta h c0 sum_j psi_ij.grad_i W_ij V_j
    psi_ij    = 2 (rho_j - rho_i) x_ji / |x_ji|^2 - (<grad rho>_i + <grad rho>_j),     x_ji = x_j - x_i

The first sum runs over fluid and ghosts. The diffusion runs over fluid neighbours only: it is antisymmetric between
two particles, so the fluid's volume-weighted density is kept, and nothing diffuses through a wall.

Departs from the paper: its "x_ij = -x_ij" is a misprint; with the other sign the term would be anti-diffusive.

Source: X. Huang et al. (2019), doi:10.3390/w11051110, Eq. 5; S. Marrone et al. (2011), doi:10.1016/j.cma.2010.12.016.
"""

import numba

from sphframe.compiled import fma


@numba.njit(error_model="numpy", forceinline=True)
def diffusive_flux(density_difference, gradient_difference):  # type: ignore[no-untyped-def]
    """Return psi_ij.x_ji = 2 (rho_j - rho_i) - (<grad rho>_i + <grad rho>_j).x_ji; zero for a linear density.

    grad_i W_ij is parallel to x_ji, so this scalar is all that the sum needs of psi_ij.
    """
    return fma(2.0, density_difference, -gradient_difference)
