"""Simplified finite difference interpolation for sphframe (Eqs. 10-12 of Huang et al. 2019)."""

import math
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

__all__ = ["SFDI"]

_THINNEST = 1e-8
"""smallest pivot, relative to the mean diagonal entry: the square of the relative thickness of the cloud"""


_COUPLED = Orders(
    pressure=Order(1, 1), divergence=Order(1, 0), viscosity=Order(0, 0), shear=Order(2, 2),
    slip_divergence=Order(2, 0), slip_viscosity=Order(0, -1),
)  # fmt: skip
_PRINTED = Orders(
    pressure=Order(1, 0), divergence=Order(1, 0), viscosity=Order(0, 0), shear=Order(2, 2),
    slip_divergence=Order(2, 0), slip_viscosity=Order(0, -1),
)  # fmt: skip


@dataclass(frozen=True)
class SFDI(BoundaryInterpolator):
    """Simplified finite difference interpolation: a kernel average, corrected by the gradient at the nearest particle.

    With r_ji = x_j - x_i, where i is the particle nearest to the evaluation point r::

        f(r)   = sum_j W_j f_j / sum W - R0 . grad f,            R0 = sum_j W_j (x_j - r) / sum W
        grad f = N^-1 sum_j W(|r_ji|)/|r_ji|^2 r_ji (f_j - f_i),  N = sum_j W(|r_ji|)/|r_ji|^2 r_ji r_ji^T

    which gives, with B_j = W(|r_ji|)/|r_ji|^2 r_ji . N^-1 R0::

        Phi_j = W_j / sum W - B_j   (j not i),   Phi_i = W_i / sum W + sum_{k not i} B_k

    ``form="coupled"`` uses the full matrix N and is exact on linear fields. ``form="printed"`` uses only its
    diagonal, as Eqs. 10-12 do; it is neither exact on linear fields nor invariant under rotation.

    Departs from the paper: ``coupled`` is the default, and R0 is relative to the evaluation point, as the Taylor
    expansion requires. Of several particles at the same smallest distance, i is the first in the order of coordinates.
    The status is TOO_FEW for fewer than 2 neighbours (coupled: 3 in 2-D, 4 in 3-D), and SINGULAR where N has no inverse
    or sum |Phi_j| exceeds ``amplification``. The fallback is the kernel average.

    Source: Ma (2008), doi:10.3970/cmes.2008.023.075; Huang et al., Water 11 (2019).

    Attributes
    ----------
    form
        the full matrix N, or its diagonal alone as printed in the paper.
    amplification
        largest sum of absolute weights; above it the kernel average is used. By default 3, printed 10.
    """

    form: Literal["coupled", "printed"] = "coupled"
    """the full matrix N, or its diagonal as in the paper"""
    amplification: float | None = None
    """largest accepted sum |Phi_j|, the factor by which noise may be amplified; by default 3 (printed: 10)"""

    def __post_init__(self) -> None:
        if self.form not in ("coupled", "printed"):
            raise ValueError(f'form must be "coupled" or "printed", got {self.form!r}')
        if self.amplification is not None and not self.amplification >= 1.0:
            raise ValueError(f"amplification must be a number of at least 1, got {self.amplification!r}")

    @property
    def traits(self) -> Traits:
        """The traits of the chosen form."""
        if self.form == "coupled":
            return Traits(
                reproduces_degree=1, fewest_points=(3, 4), volume_independent=True, continuous=False, order=_COUPLED
            )
        return Traits(
            fewest_points=(2, 2), rotation_invariant=False, volume_independent=True, continuous=False, order=_PRINTED
        )

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the weights function; it uses kernel values between neighbours."""
        coupled = self.form == "coupled"
        fewest = self.traits.fewest_points[dim - 2]
        largest = 10.0 if self.form == "printed" else 3.0
        amplification = largest if self.amplification is None else self.amplification
        kernel_value, smoothing_lengths = kernel.value, kernel.support
        entries = dim * dim
        thinnest = _THINNEST

        def weights(offsets, distances, kernel_values, volumes, support, lift, out):  # type: ignore[no-untyped-def]
            n = distances.shape[0]
            if n < fewest:
                return TOO_FEW
            per_h = smoothing_lengths / support

            i = 0
            for j in range(1, n):
                if distances[j] < distances[i]:
                    i = j
                elif distances[j] == distances[i]:
                    for a in range(dim):
                        if offsets[j, a] != offsets[i, a]:
                            if offsets[j, a] < offsets[i, a]:
                                i = j
                            break

            total = 0.0
            for j in range(n):
                total += kernel_values[j]
            if not total > 0.0:
                return SINGULAR
            share = 1.0 / total

            # right-hand side R0 and matrix N, both in units of h; out[j] holds W(|r_ji|) / |r_ji|^2 for the second pass
            correction = local_array(dim)
            matrix = local_array(entries)
            for a in range(dim):
                correction[a] = 0.0
                for b in range(dim):
                    matrix[a * dim + b] = 0.0
            for j in range(n):  # a loop of its own, which the compiler vectorises
                square = 0.0
                for a in range(dim):
                    square += ((offsets[j, a] - offsets[i, a]) * per_h) ** 2
                q = math.sqrt(square)
                value = kernel_value(min(q, smoothing_lengths)) / (square if square > 0.0 else 1.0)
                out[j] = value if 0.0 < q < smoothing_lengths else 0.0
            for j in range(n):
                for a in range(dim):
                    correction[a] += kernel_values[j] * share * (offsets[j, a] * per_h)
                    scaled = out[j] * ((offsets[j, a] - offsets[i, a]) * per_h)
                    for b in range(a + 1):
                        if coupled or a == b:
                            matrix[a * dim + b] += scaled * ((offsets[j, b] - offsets[i, b]) * per_h)

            # N = L D L^T, then correction := N^-1 R0
            scale = 0.0
            for a in range(dim):
                scale += matrix[a * dim + a] / dim
            for a in range(dim):
                for b in range(a):
                    for c in range(b):
                        matrix[a * dim + b] -= matrix[a * dim + c] * matrix[b * dim + c] * matrix[c * dim + c]
                    matrix[a * dim + b] /= matrix[b * dim + b]
                for c in range(a):
                    matrix[a * dim + a] -= matrix[a * dim + c] ** 2 * matrix[c * dim + c]
                if not matrix[a * dim + a] > thinnest * scale:
                    return SINGULAR
                for b in range(a):
                    correction[a] -= matrix[a * dim + b] * correction[b]
            for k in range(dim):
                a = dim - 1 - k
                correction[a] /= matrix[a * dim + a]
                for b in range(a + 1, dim):
                    correction[a] -= matrix[b * dim + a] * correction[b]

            balance = 0.0
            absolute_sum = 0.0
            for j in range(n):
                along = 0.0
                for a in range(dim):
                    along += (offsets[j, a] - offsets[i, a]) * per_h * correction[a]
                balance += out[j] * along
                out[j] = kernel_values[j] * share - out[j] * along
                if j != i:
                    absolute_sum += abs(out[j])
            out[i] += balance
            absolute_sum += abs(out[i])
            if not absolute_sum <= amplification:
                return SINGULAR
            return OK

        return weights
