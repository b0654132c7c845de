"""Physics: momentum with artificial viscosity.

::

    rho_i Du_i/Dt = -sum_j (p_i + p_j) grad_i W_ij V_j + rho_i f + alpha h c0 rho0 sum_j pi_ij grad_i W_ij V_j
    pi_ij         = (u_j - u_i).x_ji / |x_ji|^2

over fluid and ghosts. Both sums are antisymmetric between two fluid particles of m = rho V: momentum is conserved.

Departs from the paper: the viscous factor is the constant rho0, not rho_i, with which momentum would not be conserved.

Source: X. Huang et al. (2019), doi:10.3390/w11051110, Eq. 5.
"""

import numba


@numba.njit(inline="always")
def pair_stress(pressure_sum, viscosity, approach, distance2):  # type: ignore[no-untyped-def]
    """Return -(p_i + p_j) + alpha h c0 rho0 pi_ij, in Pa, the factor of grad_i W_ij V_j.

    ``viscosity`` is alpha h c0 rho0 and ``approach`` is (u_j - u_i).x_ji; it is zero for two particles at one place.
    """
    return viscosity * approach / (distance2 if distance2 > 0.0 else 1.0) - pressure_sum
