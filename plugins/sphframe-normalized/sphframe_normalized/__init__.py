"""Normalised kernel weights for sphframe (Eqs. 14-16 of Huang et al. 2019)."""

from dataclasses import dataclass

from sphframe import OK, TOO_FEW, BoundaryInterpolator, CompiledKernel, Order, Orders, Traits, WeightsFunction

__all__ = ["Normalized"]


_ORDERS = Orders(
    pressure=Order(1, 1), divergence=Order(1, 1), viscosity=Order(0, 0), shear=Order(2, 2),
    slip_divergence=Order(2, 0), slip_viscosity=Order(0, -1),
)  # fmt: skip


@dataclass(frozen=True)
class Normalized(BoundaryInterpolator):
    """Normalised kernel weights (Eqs. 14-16 of Huang et al. 2019): Phi_j = W_j V_j / sum_k W_k V_k.

    The status is TOO_FEW where all W_j V_j are zero in floating point, as for a single particle at the cut-off; the
    fallback is the value of the nearest particle.

    Source: Randles & Libersky (1996), doi:10.1016/S0045-7825(96)01090-0; Huang et al., Water 11 (2019).
    """

    traits = Traits(non_negative=True, range_restricted=True, order=_ORDERS)

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the weights function; it uses only the kernel values and the volumes."""

        def weights(offsets, distances, kernel_values, volumes, support, lift, out):  # type: ignore[no-untyped-def]
            n = distances.shape[0]
            total = 0.0
            for j in range(n):
                out[j] = kernel_values[j] * volumes[j]
                total += out[j]
            if total <= 0.0:
                return TOO_FEW
            for j in range(n):
                out[j] /= total
            return OK

        return weights
