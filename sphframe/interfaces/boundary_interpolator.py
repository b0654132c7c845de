"""Interfaces: how the fluid is interpolated to an evaluation point of the boundary."""

import dataclasses
import inspect
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import TYPE_CHECKING, final

from numpy.typing import ArrayLike

from sphframe.arrays import Array
from sphframe.interfaces.kernel import CompiledKernel
from sphframe.interfaces.traits import Traits
from sphframe.representation import html_table

if TYPE_CHECKING:
    from scipy.sparse import csr_array

    from sphframe.boundary.operator import ParticleCloud

WeightsFunction = Callable[[Array, Array, Array, Array, float, Array, Array], int]


class BoundaryInterpolator(ABC):
    """A linear rule, value(r) = sum_j Phi_j f_j, from the fluid particles around r to a value at r.

    An author declares :attr:`traits` and returns the function that computes the weights from :meth:`point_weights`.
    Options of a method are the fields of a frozen dataclass, checked in ``__post_init__``::

        @dataclass(frozen=True)
        class Nearest(BoundaryInterpolator):
            traits = Traits(non_negative=True, range_restricted=True)

            def point_weights(self, kernel, dim):
                def weights(offsets, distances, kernel_values, volumes, support, lift, out):
                    ...
                    return OK
                return weights
    """

    @property
    @abstractmethod
    def traits(self) -> Traits:
        """Properties that the method guarantees. A plain class attribute is sufficient."""

    @abstractmethod
    def point_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the function that computes the weights of ONE evaluation point.

        Parameters
        ----------
        kernel
            compiled kernel functions, for methods that need more than its values at the neighbours.
        dim
            2 or 3, a constant of the compiled function.

        Returns
        -------
        WeightsFunction
            A function ``weights(offsets, distances, kernel_values, volumes, support, lift, out) -> status``, compiled
            by sphframe with Numba. It must not allocate, raise, or write anywhere but to ``out``.

            ``offsets`` (n, dim): x_j - r, in m; ``distances`` (n,): their lengths, 0 <= r_j < support;
            ``kernel_values`` (n,): W(r_j, h) in m^-dim; ``volumes`` (n,): V_j in m^dim; ``support``: R in m;
            ``lift`` (dim,): from the evaluation point to the ghost, non-zero only for pressure and only when
            ``traits.evaluation_point`` is EXTRAPOLATED; ``out`` (n,): where the weights go. n >= 1 always: the
            function is not called for a point without neighbours, whose status is DRY.

            It returns OK, or TOO_FEW or SINGULAR, in which case ``out`` is overwritten by :meth:`fallback_weights`.
        """

    def fallback_weights(self, kernel: CompiledKernel, dim: int) -> WeightsFunction:
        """Return the weights used where the function of :meth:`point_weights` returns TOO_FEW or SINGULAR.

        The default is the kernel average, Phi_j = W_j V_j / sum_k W_k V_k, which exists for every cloud.
        """
        return kernel_average

    @final
    def operator(self, points: ArrayLike, cloud: "ParticleCloud") -> "csr_array":
        """Return the sparse matrix of weights Phi (points, particles), so that value(points) = Phi @ f.

        Parameters
        ----------
        points
            (m, dim) or (dim,), m: evaluation points.
        cloud
            a :class:`sphframe.ParticleCloud` of n particles.

        Returns
        -------
        csr_array
            csr_array (m, n); :func:`sphframe.boundary.operator.operator` returns the statuses too, and takes lifts.

        Raises
        ------
        InputError
            when a shape, a dimension or a number is not valid.
        """
        from sphframe.boundary.operator import operator  # from a room above: an exception listed in pyproject.toml

        matrix, _ = operator(
            self, points, cloud.positions, cloud.volumes, smoothing_length=cloud.smoothing_length, kernel=cloud.kernel
        )
        return matrix

    def _repr_html_(self) -> str:
        """Return a table for notebooks: options, description and traits of the method."""
        what = (inspect.getdoc(self) or "").partition("\n\n")[0]
        traits = dataclasses.asdict(self.traits).items()
        words = {"True": "yes", "False": "no"}
        rows = [(name.replace("_", " "), words.get(str(value), value)) for name, value in traits]
        return html_table(repr(self), ["trait", ""], rows, about=what)


def kernel_average(
    offsets: Array, distances: Array, kernel_values: Array, volumes: Array, support: float, lift: Array, out: Array
) -> int:
    """Phi_j = W_j V_j / sum_k W_k V_k; the nearest particle alone where every W_k V_k is zero in floating point."""
    n = distances.shape[0]
    total = 0.0
    nearest = 0
    for j in range(n):
        out[j] = kernel_values[j] * volumes[j]
        total += out[j]
        if distances[j] < distances[nearest]:
            nearest = j
    if total > 0.0:
        for j in range(n):
            out[j] /= total
    else:
        for j in range(n):
            out[j] = 0.0
        out[nearest] = 1.0
    return 0
