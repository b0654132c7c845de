"""The wall boundary condition of Adami et al. (2012) for sphframe."""

from dataclasses import dataclass

from sphframe import OK, TOO_FEW, BoundaryInterpolator, CompiledKernel, EvaluationPoint, Traits, WeightsFunction

__all__ = ["Adami"]


@dataclass(frozen=True)
class Adami(BoundaryInterpolator):
    """Normalised kernel weights, evaluated at the ghost particle (Eqs. 22, 23 and 27 of Adami et al. 2012).

    With W_j the kernel at the distance of particle j from the ghost::

        Phi_j = W_j / sum_k W_k V_k * V_j

    The ``balanced`` lift of sphframe is the hydrostatic term of their Eq. 27.

    Departs from the paper: W_j is multiplied by the volume V_j. Their Eq. 27 omits it, as all of their particles have
    the same size. The status is TOO_FEW where all W_j V_j are zero in floating point; the fallback is the value of the
    nearest particle.

    Source: Adami, Hu & Adams (2012), doi:10.1016/j.jcp.2012.05.005.
    """

    traits = Traits(non_negative=True, range_restricted=True, evaluation_point=EvaluationPoint.GHOST)

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
