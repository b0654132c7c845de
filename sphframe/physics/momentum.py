"""Physics: momentum with artificial and laminar viscosity.

::

    rho_i Du_i/Dt = -sum_j (p_i + p_j) grad_i W_ij V_j + rho_i f + alpha h c0 rho0 sum_j pi_ij grad_i W_ij V_j
    pi_ij         = (u_j - u_i).x_ji / |x_ji|^2

over fluid and ghosts. A kinematic viscosity nu adds, in d dimensions, one of two forms::

    Morris               sum_j 2 rho0 nu (u_j - u_i) (x_ji.grad_i W_ij) / |x_ji|^2 V_j
    Monaghan, Gingold    2 (d + 2) rho0 nu sum_j pi_ij grad_i W_ij V_j

to the right-hand side. The first conserves linear momentum and is the Laplacian; the second, which is the artificial
viscosity with another factor, also conserves angular momentum, and is the Laplacian where the velocity has no
divergence. Both sums are antisymmetric between two fluid particles of m = rho V: momentum is conserved.

Departs from the paper: the viscous factor is the constant rho0, not rho_i, with which momentum would not be conserved.

Source: X. Huang et al. (2019), doi:10.3390/w11051110, Eq. 5; J. P. Morris, P. J. Fox, Y. Zhu (1997),
doi:10.1006/jcph.1997.5776; J. J. Monaghan, R. A. Gingold (1983), doi:10.1016/0021-9991(83)90036-0.
"""

import numba


@numba.njit(error_model="numpy", forceinline=True)
def pair_stress(pressure_sum, viscosity, approach, distance2):  # type: ignore[no-untyped-def]
    """Return -(p_i + p_j) + alpha h c0 rho0 pi_ij, in Pa, the factor of grad_i W_ij V_j.

    ``viscosity`` is alpha h c0 rho0 and ``approach`` is (u_j - u_i).x_ji; it is zero for two particles at one place.
    """
    return viscosity * approach / (distance2 if distance2 > 0.0 else 1.0) - pressure_sum
