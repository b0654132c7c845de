"""The modified dynamic boundary condition (mDBC) of English et al. (2022) for sphframe."""

from dataclasses import dataclass

from sphframe import (
    OK,
    SINGULAR,
    TOO_FEW,
    BoundaryInterpolator,
    CompiledKernel,
    EvaluationPoint,
    Order,
    Orders,
    Traits,
    WeightsFunction,
    local_array,
)

__all__ = ["MDBC"]

_THINNEST = 1e-8
"""smallest pivot, relative to its scale"""


_ORDERS = Orders(
    pressure=Order(1, 1), divergence=Order(1, 1), viscosity=Order(0, 0), shear=Order(2, 2),
    slip_divergence=Order(2, 0), slip_viscosity=Order(0, -1),
)  # fmt: skip


@dataclass(frozen=True)
class MDBC(BoundaryInterpolator):
    """First-order consistent SPH at the mirror point, extrapolated to the ghost particle.

    At the mirror point m (the paper's ghost node), with all offsets relative to it::

        A [f_m, grad f_m]^T = sum_j V_j f_j [W_j, grad W_j]^T,   A = sum_j V_j [W_j, grad W_j]^T [1, x_j - x_m]
        f_G = f_m + (x_G - x_m) . grad f_m

    which is linear in f_j: Phi_j = V_j (y_0 W_j + y . grad W_j) with A^T [y_0, y]^T = [1, x_G - x_m]^T. The
    weights are exact on linear fields at x_G and need no hydrostatic lift.

    Departs from the paper: the kernel average is used with fewer than 3 (4) neighbours in 2-D (3-D), TOO_FEW, and where
    a pivot of A is too small or sum |Phi_j| exceeds ``amplification``, SINGULAR. The paper uses it where the
    determinant of A is below a fixed number.

    Source: English et al. (2022), doi:10.1007/s40571-021-00403-3; Liu & Liu (2006), doi:10.1016/j.apnum.2005.02.012.

    Attributes
    ----------
    amplification
        largest sum of absolute weights; above it the kernel average is used.
    """

    amplification: float = 10.0
    """largest accepted sum |Phi_j|, the factor by which noise may be amplified"""

    traits = Traits(
        reproduces_degree=1,
        fewest_points=(3, 4),
        kernel_gradient=True,
        jumps_at_cut_off=True,
        evaluation_point=EvaluationPoint.EXTRAPOLATED,
        order=_ORDERS,
    )

    def __post_init__(self) -> None:
        if not self.amplification >= 1.0:
            raise ValueError(f"amplification must be a number of at least 1, got {self.amplification!r}")

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the weights function; it uses kernel values, kernel gradients and ``lift``."""
        terms = dim + 1
        entries = terms * terms
        amplification = self.amplification
        kernel_gradient, smoothing_lengths, normalisation = kernel.gradient, kernel.support, kernel.normalisation
        thinnest = _THINNEST

        def weights(offsets, distances, kernel_values, volumes, support, lift, out):  # type: ignore[no-untyped-def]
            n = distances.shape[0]
            if n < terms:
                return TOO_FEW
            per_h = smoothing_lengths / support
            gradient_scale = -normalisation * per_h**dim  # gives the rows of grad W the unit and the sign of W

            # A^T with lengths in units of h; the constant is last, after a symmetric positive block
            basis = local_array(terms)
            basis[dim] = 1.0
            matrix = local_array(entries)
            for k in range(entries):
                matrix[k] = 0.0
            for j in range(n):  # a loop of its own, which the compiler vectorises
                out[j] = gradient_scale * kernel_gradient(distances[j] * per_h)
            for j in range(n):
                for a in range(dim):
                    basis[a] = offsets[j, a] * per_h
                slope = volumes[j] * out[j]
                value = volumes[j] * kernel_values[j]
                for a in range(terms):
                    scaled = slope * basis[a]
                    for b in range(min(a + 1, dim)):
                        matrix[a * terms + b] += scaled * basis[b]
                    matrix[a * terms + dim] += value * basis[a]
            for a in range(dim):
                for b in range(a):
                    matrix[b * terms + a] = matrix[a * terms + b]
            solution = local_array(terms)
            scale = 0.0
            for a in range(dim):
                solution[a] = lift[a] * per_h
                scale += matrix[a * terms + a] / dim
            solution[dim] = 1.0
            constant_scale = matrix[entries - 1]

            for a in range(terms):
                pivot = matrix[a * terms + a]
                if not abs(pivot) > thinnest * (scale if a < dim else constant_scale):
                    return SINGULAR
                for b in range(a + 1, terms):
                    factor = matrix[b * terms + a] / pivot
                    for c in range(a + 1, terms):
                        matrix[b * terms + c] -= factor * matrix[a * terms + c]
                    solution[b] -= factor * solution[a]
            for k in range(terms):
                a = terms - 1 - k
                for b in range(a + 1, terms):
                    solution[a] -= matrix[a * terms + b] * solution[b]
                solution[a] /= matrix[a * terms + a]

            absolute_sum = 0.0
            for j in range(n):
                along = 0.0
                for a in range(dim):
                    along += solution[a] * (offsets[j, a] * per_h)
                out[j] = volumes[j] * (solution[dim] * kernel_values[j] + out[j] * along)
                absolute_sum += abs(out[j])
            if not absolute_sum <= amplification:
                return SINGULAR
            return OK

        return weights
