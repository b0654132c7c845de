"""Physics: the renormalised density gradient (Eq. 6 of the paper, which is missing in its text).

::

    <grad rho>_i = L_i sum_j (rho_j - rho_i) grad_i W_ij V_j,    L_i = [sum_j x_ji (x) grad_i W_ij V_j]^-1

over the fluid neighbours j. It is exact for a linear density, whatever the neighbours, wherever L_i exists. Where the
matrix is ill-conditioned (spray, isolated particles) the uncorrected sum is used.

Sources: M. Antuono et al. (2010), doi:10.1016/j.cpc.2009.11.002; S. Marrone et al. (2011),
doi:10.1016/j.cma.2010.12.016.
"""

import numba

ILL_CONDITIONED = 0.02
"""det(A) / (trace(A)/d)^d below which the matrix A = L^-1 is not inverted; it is 1 in a full neighbourhood"""


@numba.njit(error_model="numpy", forceinline=True)
def renormalised_2d(bx, by, xx, xy, yy):  # type: ignore[no-untyped-def]
    """Return the solution of A g = b, A = [[xx, xy], [xy, yy]], or b itself where A is ill-conditioned."""
    determinant = xx * yy - xy * xy
    mean = 0.5 * (xx + yy)
    if determinant > ILL_CONDITIONED * mean * mean:
        return (yy * bx - xy * by) / determinant, (xx * by - xy * bx) / determinant
    return bx, by


@numba.njit(error_model="numpy", forceinline=True)
def renormalised_3d(bx, by, bz, xx, xy, yy, xz, yz, zz):  # type: ignore[no-untyped-def]
    """Return the solution of A g = b for the symmetric matrix A, or b itself where A is ill-conditioned."""
    cxx = yy * zz - yz * yz
    cxy = xz * yz - xy * zz
    cxz = xy * yz - xz * yy
    determinant = xx * cxx + xy * cxy + xz * cxz
    mean = (xx + yy + zz) / 3.0
    if determinant > ILL_CONDITIONED * mean * mean * mean:
        cyy = xx * zz - xz * xz
        cyz = xy * xz - xx * yz
        czz = xx * yy - xy * xy
        return (
            (cxx * bx + cxy * by + cxz * bz) / determinant,
            (cxy * bx + cyy * by + cyz * bz) / determinant,
            (cxz * bx + cyz * by + czz * bz) / determinant,
        )
    return bx, by, bz
