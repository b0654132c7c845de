"""Boundary: fills the ghosts from the fluid by compiled loops, which need scratch memory."""

from collections.abc import Mapping
from typing import Any

from sphframe.arrays import Array
from sphframe.boundary.boundary import Boundary
from sphframe.boundary.conjugate import make_conjugate
from sphframe.boundary.ghosts import Scratch, fill_ghosts
from sphframe.compiled import specialise
from sphframe.interfaces import BoundaryInterpolator, CompiledKernel, EvaluationPoint
from sphframe.neighbours import NeighbourLists
from sphframe.physics import LoopParameters


class Filling:
    """Interpolates the fluid to the evaluation points and assigns velocity, pressure and density of the ghosts.

    Parameters
    ----------
    interpolator, kernel: the method and the kernel; ``parts`` the compiled parts of the loops, by name.
    balanced: whether the hydrostatic correction is the balanced one; ``corrected`` whether ghost velocities are
        corrected, see :mod:`sphframe.boundary.ghosts` and :mod:`sphframe.boundary.conjugate`.
    """

    def __init__(
        self,
        interpolator: BoundaryInterpolator,
        kernel: CompiledKernel,
        parts: Mapping[str, Any],
        *,
        balanced: bool,
        corrected: bool,
    ) -> None:
        self._dim: int = parts["DIM"]
        evaluation_point = interpolator.traits.evaluation_point
        self._fill = specialise(
            fill_ghosts,
            {
                **parts,
                "BALANCED": balanced or evaluation_point is EvaluationPoint.GHOST,
                "SCALED": balanced and corrected and evaluation_point is not EvaluationPoint.GHOST,
                "EXTRAPOLATED": evaluation_point is EvaluationPoint.EXTRAPOLATED,
                "WEIGHTS": interpolator.point_weights(kernel, self._dim),
                "FALLBACK": interpolator.fallback_weights(kernel, self._dim),
            },
        )
        conjugate = corrected and not balanced and evaluation_point is EvaluationPoint.MIRROR
        self._make_conjugate = specialise(make_conjugate, parts) if conjugate else None
        self._scratch = Scratch.of(8, self._dim)

    def __call__(self, rows: Array, lists: NeighbourLists, boundary: Boundary, parameters: LoopParameters) -> None:
        """Fill the ghosts of ``boundary`` in ``rows`` (n + g, width), and set their statuses."""
        if lists.points.shape[1] > self._scratch.members.shape[1]:
            self._scratch = Scratch.of(lists.points.shape[1], self._dim)
        self._fill(
            rows, lists.fluid_count, lists.points, lists.point_counts, boundary.points, boundary.lifts,
            boundary.normal, boundary.depth, boundary.height, boundary.reflection, boundary.velocity, boundary.driving,
            parameters, self._scratch, boundary.statuses,
        )  # fmt: skip
        if self._make_conjugate is not None:
            self._make_conjugate(
                rows, lists.fluid_count, lists.points, lists.point_counts, boundary.reflection, boundary.velocity,
                parameters,
            )  # fmt: skip
