"""The wall pressure of Hashemi et al. (2012), from the momentum along the normal of the wall, for sphframe."""

from dataclasses import dataclass
from typing import Any

from sphframe import (
    OK,
    SINGULAR,
    TOO_FEW,
    BoundaryInterpolator,
    CompiledKernel,
    EvaluationPoint,
    Interpolated,
    Order,
    Orders,
    Traits,
    WallContext,
    WallParts,
    WallPoint,
    WallTraits,
    WallTreatment,
    WeightsFunction,
    local_array,
)

__all__ = ["Hashemi", "NormalDerivative"]

_THINNEST = 1e-8
"""smallest pivot of the matrix over its trace"""


@dataclass(frozen=True)
class NormalDerivative(BoundaryInterpolator):
    """Weights of the corrected derivative along the normal n of the wall, at the wall particle.

    ::

        Phi_j = omega_j / sum_k omega_k,    omega_j = V_j n.L grad W_Gj,    L = [sum_j V_j (x_j - x_G) grad W_Gj^T]^-1

    They are positive where all particles lie on one side of the wall particle. TOO_FEW with fewer than 2 (3) particles
    in 2-D (3-D); SINGULAR where L does not exist, or sum omega vanishes.
    """

    traits = Traits(fewest_points=(2, 3), evaluation_point=EvaluationPoint.DIRECTED, kernel_gradient=True)

    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the weights function, whose ``lift`` is the normal."""
        slope, smoothing_lengths, thinnest = kernel.gradient, kernel.support, _THINNEST
        entries = dim * dim

        def weights(offsets, distances, kernel_values, volumes, support, lift, out):  # type: ignore[no-untyped-def]
            n = distances.shape[0]
            if n < dim:
                return TOO_FEW
            per_h = smoothing_lengths / support
            matrix = local_array(entries)
            solution = local_array(dim)
            trace = 0.0
            for a in range(dim):
                solution[a] = lift[a]
                for b in range(dim):
                    matrix[a * dim + b] = 0.0
            for j in range(n):
                out[j] = -volumes[j] * slope(distances[j] * per_h)  # grad W_Gj V_j = out[j] (x_j - x_G), up to a factor
                for a in range(dim):
                    trace += out[j] * offsets[j, a] * offsets[j, a] * per_h * per_h
                    for b in range(dim):
                        matrix[a * dim + b] += out[j] * offsets[j, a] * offsets[j, b] * per_h * per_h
            for a in range(dim):  # solve matrix y = n; omega_j = y.(x_j - x_G) out[j]
                if not matrix[a * dim + a] > thinnest * trace:
                    return SINGULAR
                for b in range(a + 1, dim):
                    factor = matrix[b * dim + a] / matrix[a * dim + a]
                    for c in range(a, dim):
                        matrix[b * dim + c] -= factor * matrix[a * dim + c]
                    solution[b] -= factor * solution[a]
            for k in range(dim):
                a = dim - 1 - k
                for b in range(a + 1, dim):
                    solution[a] -= matrix[a * dim + b] * solution[b]
                solution[a] /= matrix[a * dim + a]
            total = 0.0
            absolute = 0.0
            for j in range(n):
                along = 0.0
                for a in range(dim):
                    along += solution[a] * offsets[j, a]
                out[j] *= along
                total += out[j]
                absolute += abs(out[j])
            if not abs(total) > 1e-3 * absolute:
                return SINGULAR
            for j in range(n):
                out[j] /= total
            return OK

        return weights


_WALLS = Orders(
    pressure=Order(1, 1), divergence=Order(1, 1), viscosity=Order(-1, -1), shear=Order(1, 1),
    slip_divergence=Order(0, 0), slip_viscosity=Order(-1, -1),
)  # fmt: skip


@dataclass(frozen=True)
class Hashemi(WallTreatment):
    """The pressure of a wall particle fulfils the momentum equation along the normal n; velocity of the wall.

    With the weights of :class:`NormalDerivative`::

        n.sum_j (p_j - p_G) L grad W_Gj V_j = b.n
        p_G = [sum_j omega_j p_j - b.n] / sum_j omega_j = sum_j Phi_j p_j - (b.n) sum_j Phi_j (x_j - x_G).n
        u_G = u_w

    This is exact for every linear pressure whose derivative along n is b.n, whatever its gradient along the wall.

    Departs from the paper, which has one row of particles on the wall and corrected operators for the fluid, too: here
    all layers have this pressure, and the fluid's operators are those of sphframe. The viscous part of the normal
    momentum is left out.

    Known failure: L is singular with few neighbours; there the kernel average is lifted in the same way.

    Source: M. R. Hashemi, R. Fatehi, M. T. Manzari (2012), doi:10.1016/j.ijnonlinmec.2011.10.007.
    """

    traits = WallTraits(exact_constant=True, exact_hydrostatic=True, order=_WALLS)

    def interpolator(self, chosen: BoundaryInterpolator) -> BoundaryInterpolator:
        """Return the weights of the normal derivative."""
        return NormalDerivative()

    def parts(self, context: WallContext) -> WallParts:
        """Return the assignment."""
        dim = context.dim

        def assign(
            fluid: Interpolated, wall: WallPoint, constants: Any, velocity: Any, viscous_velocity: Any
        ) -> tuple[float, float]:
            along = 0.0
            force = 0.0
            for d in range(dim):
                velocity[d] = wall.velocity[d]
                along += fluid.offset[d] * wall.normal[d]
                force += wall.force[d] * wall.normal[d]
            return fluid.pressure - force * along, 1.0

        return WallParts(assign=assign, friction=context.no_slip)
