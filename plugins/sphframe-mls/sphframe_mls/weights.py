"""Moving least squares weights of degree one and two (Eqs. 8-9 of Huang et al. 2019)."""

from dataclasses import dataclass
from typing import Literal

from sphframe import (
    OK,
    SINGULAR,
    TOO_FEW,
    BoundaryInterpolator,
    CompiledKernel,
    Order,
    Orders,
    Traits,
    WeightsFunction,
    local_array,
)
from sphframe_mls.rank_revealing import rank_revealing

Fallback = Literal["kernel-average", "rank-revealing"]
_THINNEST = 1e-8
"""smallest pivot, relative to the scale of its degree: the square of the relative thickness of the cloud"""
_LEAST_SHARE = 0.01
"""smallest pivot of the constant over sum W_j V_j: the share of the constant that the other terms do not reproduce"""


_LINEAR = Orders(
    pressure=Order(1, 1), divergence=Order(1, 1), viscosity=Order(0, 0), shear=Order(2, 2),
    slip_divergence=Order(2, 0), slip_viscosity=Order(0, -1),
)  # fmt: skip
_QUADRATIC = Orders(
    pressure=Order(2, 1), divergence=Order(1, 1), viscosity=Order(0, 0), shear=Order(2, 2),
    slip_divergence=Order(2, 0), slip_viscosity=Order(0, -1),
)  # fmt: skip


@dataclass(frozen=True)
class _LeastSquares(BoundaryInterpolator):
    """Options and fallback of both degrees."""

    amplification: float = 3.0
    """largest accepted sum |Phi_j|, the factor by which noise may be amplified"""
    fallback: Fallback = "kernel-average"
    """weights where the status is not OK: "kernel-average", or "rank-revealing", linear along the neighbours' spread"""

    def __post_init__(self) -> None:
        if not self.amplification >= 1.0:
            wanted = "amplification must be a number of at least 1, since the weights sum to one"
            raise ValueError(f"{wanted}; got {self.amplification!r}")
        if self.fallback not in ("kernel-average", "rank-revealing"):
            raise ValueError(f'fallback must be "kernel-average" or "rank-revealing", got {self.fallback!r}')

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the weights function."""
        return _least_squares(self.traits.reproduces_degree, kernel, dim, self.amplification)

    def fallback_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the weights where the status is not OK."""
        average = super().fallback_weights(kernel, dim)
        revealing = self.fallback == "rank-revealing"
        return rank_revealing(average, kernel, dim, self.amplification) if revealing else average


@dataclass(frozen=True)
class LinearMLS(_LeastSquares):
    """Moving least squares of degree one: exact on linear fields.

    With the basis b_j = (1, x_j/h, y_j/h[, z_j/h]) about the evaluation point::

        Phi_j = e_1 . M^-1 b_j W_j V_j,   M = sum_j b_j b_j^T W_j V_j

    The status is TOO_FEW for fewer than 3 (4) neighbours in 2-D (3-D). It is SINGULAR where the neighbours lie on one
    line (plane), and where sum |Phi_j| exceeds ``amplification``. Neighbours on a line are recognised by the pivots of
    M: a solver of linear systems may find a solution for them, with weights that sum to 0.6. The fallback is the kernel
    average, or with ``fallback="rank-revealing"`` linear along the directions in which the neighbours are spread.

    Source: Lancaster & Salkauskas (1981), doi:10.1090/S0025-5718-1981-0616367-1; Marrone et al. (2011),
    doi:10.1016/j.cma.2010.12.016; Huang et al., Water 11 (2019).

    Attributes
    ----------
    amplification
        largest sum of absolute weights; above it the fallback is used.
    fallback
        "kernel-average", or "rank-revealing": linear along the directions in which the neighbours are spread.
    """

    traits = Traits(reproduces_degree=1, fewest_points=(3, 4), order=_LINEAR)


@dataclass(frozen=True)
class QuadraticMLS(_LeastSquares):
    """Moving least squares of degree two: exact on quadratic fields.

    The equation is that of :class:`LinearMLS` with the full quadratic basis of 6 (10) terms in 2-D (3-D). The status is
    TOO_FEW for fewer than 6 (10) neighbours, and SINGULAR where they lie on one conic (quadric), or so near to one that
    the terms of first and second degree reproduce the constant but for a hundredth of its square: round-off in the
    weights is then magnified a hundred times, although they may be small. The fallbacks are those of
    :class:`LinearMLS`.

    Attributes
    ----------
    amplification
        largest sum of absolute weights; above it the fallback is used.
    fallback
        "kernel-average", or "rank-revealing": linear along the directions in which the neighbours are spread.
    """

    traits = Traits(reproduces_degree=2, fewest_points=(6, 10), order=_QUADRATIC)


def _least_squares(degree: int, kernel: CompiledKernel, dim: int, amplification: float) -> WeightsFunction:
    terms = dim + 1 if degree == 1 else (dim + 1) * (dim + 2) // 2
    entries = terms * terms
    last = terms - 1
    smoothing_lengths = kernel.support
    thinnest, least_share = _THINNEST, _LEAST_SHARE

    def weights(offsets, distances, kernel_values, volumes, support, lift, out):  # type: ignore[no-untyped-def]
        n = distances.shape[0]
        if n < terms:
            return TOO_FEW
        per_length = smoothing_lengths / support
        basis = local_array(terms)  # linear terms, then quadratic ones, then the constant
        basis[last] = 1.0
        matrix = local_array(entries)  # the lower triangle, by rows
        for k in range(entries):
            matrix[k] = 0.0
        for j in range(n):
            k = dim
            for a in range(dim):
                basis[a] = offsets[j, a] * per_length
                if degree == 2:
                    for b in range(a + 1):
                        basis[k] = basis[a] * basis[b]
                        k += 1
            weight = kernel_values[j] * volumes[j]
            for a in range(terms):
                for b in range(a + 1):
                    matrix[a * terms + b] += weight * basis[a] * basis[b]

        # the scale of a pivot: the mean diagonal entry of the terms of its degree, which is invariant under rotation
        linear_scale = 0.0
        quadratic_scale = 0.0
        for a in range(last):
            if a < dim:
                linear_scale += matrix[a * terms + a] / dim
            else:
                quadratic_scale += matrix[a * terms + a] / (last - dim)
        constant_scale = matrix[entries - 1]

        # M = L D L^T, with L below the diagonal
        for a in range(terms):
            for b in range(a):
                for c in range(b):
                    matrix[a * terms + b] -= matrix[a * terms + c] * matrix[b * terms + c] * matrix[c * terms + c]
                matrix[a * terms + b] /= matrix[b * terms + b]
            for c in range(a):
                matrix[a * terms + a] -= matrix[a * terms + c] ** 2 * matrix[c * terms + c]
            scale = linear_scale if a < dim else (quadratic_scale if a < last else constant_scale)
            if not matrix[a * terms + a] > (thinnest if a < last else least_share) * scale:
                return SINGULAR

        # with the constant last, M c = e_last needs only back substitution
        solution = local_array(terms)
        solution[last] = 1.0 / matrix[entries - 1]
        for k in range(1, terms):
            a = last - k
            solution[a] = 0.0
            for b in range(a + 1, terms):
                solution[a] -= matrix[b * terms + a] * solution[b]

        absolute_sum = 0.0
        for j in range(n):
            k = dim
            polynomial = solution[last]
            for a in range(dim):
                basis[a] = offsets[j, a] * per_length
                polynomial += solution[a] * basis[a]
                if degree == 2:
                    for b in range(a + 1):
                        polynomial += solution[k] * basis[a] * basis[b]
                        k += 1
            out[j] = polynomial * kernel_values[j] * volumes[j]
            absolute_sum += abs(out[j])
        if not absolute_sum <= amplification:
            return SINGULAR
        return OK

    return weights
