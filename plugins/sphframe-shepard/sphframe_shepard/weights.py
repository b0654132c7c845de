"""Inverse-distance weights: those of Shepard (1968), and the improved ones of Huang et al. (2019)."""

import math
from dataclasses import dataclass, replace

from sphframe import OK, BoundaryInterpolator, CompiledKernel, Order, Orders, Traits, WeightsFunction, fast_exp

_TRAITS = Traits(
    non_negative=True, range_restricted=True, interpolates_particles=True, volume_independent=True,
    kernel_independent=True,
    order=Orders(
        pressure=Order(2, 0), divergence=Order(1, 1), viscosity=Order(0, 0), shear=Order(2, 2),
        slip_divergence=Order(2, 0), slip_viscosity=Order(0, -1),
    ),
)  # fmt: skip


@dataclass(frozen=True)
class Shepard(BoundaryInterpolator):
    """Shepard's weights (Eqs. 17-18 of Huang et al. 2019): Phi_j = r_j^-mu / sum_k r_k^-mu.

    At r_j = 0 the value is that of the particle, or the mean of all particles at the point. On a lattice mirror points
    coincide with particles, and the printed formula divides zero by zero.

    Source: Shepard (1968), doi:10.1145/800186.810616; Huang et al., Water 11 (2019).

    Attributes
    ----------
    mu
        exponent of the distance.
    """

    mu: float = 2.0
    """power of the distance, positive"""

    traits = replace(_TRAITS, jumps_at_cut_off=True)

    def __post_init__(self) -> None:
        _check_positive("mu", self.mu)

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the weights function; it uses only the distances."""
        mu = _as_power(self.mu)

        def weights(offsets, distances, kernel_values, volumes, support, lift, out):  # type: ignore[no-untyped-def]
            n = distances.shape[0]
            nearest = distances[0]
            for j in range(1, n):
                nearest = min(nearest, distances[j])
            total = 0.0
            for j in range(n):
                if nearest > 0.0:
                    out[j] = (nearest / distances[j]) ** mu  # relative to the nearest particle, to avoid overflow
                else:
                    out[j] = 1.0 if distances[j] == 0.0 else 0.0
                total += out[j]
            for j in range(n):
                out[j] /= total
            return OK

        return weights


@dataclass(frozen=True)
class ImprovedShepard(BoundaryInterpolator):
    """Improved Shepard weights (Eqs. 19-21 of Huang et al. 2019), attenuated to zero at the cut-off R.

    With s = r/R::

        Phi_j = phi_j^mu / sum_k phi_k^mu,   phi(s) = beta(s)/s,   beta(s) = exp[-s^2 / (1 - s^attenuation)]

    Departs from the paper: distances are divided by R, as the weights of the printed Eq. 20 depend on the unit of
    length. The particle volume of Eq. 21 is left out, as the weights would not sum to one with it. Where no particle is
    near, weights are computed relative to that of the nearest one: near the cut-off phi underflows, and a single
    particle there must have weight 1. At r_j = 0 the value is that of :class:`Shepard`.

    Source: Huang et al., Water 11 (2019).

    Attributes
    ----------
    mu
        exponent of phi.
    attenuation
        exponent lambda of s in the attenuation.
    """

    mu: float = 4.0
    """power of the weights, positive"""
    attenuation: float = 2.0
    """the exponent lambda in beta, positive"""

    traits = _TRAITS

    def __post_init__(self) -> None:
        _check_positive("mu", self.mu)
        _check_positive("attenuation", self.attenuation)

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the weights function; it uses only the distances and the cut-off radius."""
        mu, attenuation = _as_power(self.mu), _as_power(self.attenuation)
        power = max(mu, 4)  # exp(-36) is round-off beside a weight of 1; it is a power of exp(lowest), lowest >= -9
        part, lowest = self.mu / power, -36.0 / power
        smallest = 1e-290  # 1 - s^attenuation may round to zero for s just below 1

        def weights(offsets, distances, kernel_values, volumes, support, lift, out):  # type: ignore[no-untyped-def]
            n = distances.shape[0]
            per_support = 1.0 / support
            for j in range(n):  # no branch, no call of the C library: it vectorises; and one division, which is slow
                s = distances[j] * per_support
                rest = max(1.0 - s**attenuation, smallest)
                inverse = 1.0 / (s * rest)
                beta = fast_exp(max(-part * s * s * s * inverse, lowest))
                if power == mu:
                    out[j] = (rest * inverse * beta) ** mu
                else:
                    out[j] = (rest * inverse) ** mu * beta**power
            total = summed(out)
            if not 1.0 < total < 1e200:  # no particle is near, or one is at the point
                relative_weights(distances, support, out)
                total = summed(out)
            share = 1.0 / total
            if n == 1:
                out[0] = share = 1.0
            for j in range(n):
                out[j] *= share
            return OK

        def relative_weights(distances, support, out):  # type: ignore[no-untyped-def]
            """Write weights relative to that of the nearest particle; where it is at the point, 1 there, 0 else."""
            nearest = distances.min()
            s = nearest / support
            largest = -part * s * s / max(1.0 - s**attenuation, smallest)
            for j in range(distances.shape[0]):
                if nearest > 0.0:
                    s = distances[j] / support
                    exponent = -part * s * s / max(1.0 - s**attenuation, smallest) - largest
                    out[j] = (nearest / distances[j]) ** mu * fast_exp(max(exponent, lowest)) ** power
                else:
                    out[j] = 1.0 if distances[j] == 0.0 else 0.0

        def summed(values):  # type: ignore[no-untyped-def]
            """Return the sum of ``values``, of four sums that do not wait for each other."""
            n = values.shape[0]
            first = second = third = fourth = 0.0
            for j in range(0, n - 3, 4):
                first += values[j]
                second += values[j + 1]
                third += values[j + 2]
                fourth += values[j + 3]
            for j in range(n - n % 4, n):
                first += values[j]
            return (first + second) + (third + fourth)

        return weights


def _check_positive(name: str, value: float) -> None:
    if not (math.isfinite(value) and value > 0.0):
        raise ValueError(f"{name} must be a positive number, got {value!r}")


def _as_power(value: float) -> float:
    """Return an integral exponent as an int, for which powers are compiled to multiplications."""
    return int(value) if float(value).is_integer() else float(value)
