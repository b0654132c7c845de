"""Interfaces: the smoothing kernel."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import ClassVar, NamedTuple

ScalarFunction = Callable[[float], float]


class Kernel(ABC):
    """A radial smoothing kernel with compact support.

    With q = r/h and sigma_d the normalisation in d dimensions::

        W(x)      = sigma_d / h^d     * w(q)
        grad W(x) = sigma_d / h^(d+2) * (w'(q)/q) * x

    An author supplies w, w'(q)/q (finite at q = 0) and sigma_d. The two functions are compiled by sphframe: plain
    arithmetic and ``math`` on one float, best without branches (the loops vectorise). A value they return for q
    slightly beyond the support is discarded.
    """

    support: ClassVar[float]
    """cut-off radius in smoothing lengths, R/h"""

    @abstractmethod
    def value_function(self) -> ScalarFunction:
        """Return the function w(q)."""

    @abstractmethod
    def gradient_function(self) -> ScalarFunction:
        """Return the function w'(q)/q."""

    def gradient_of_square_function(self) -> ScalarFunction:
        """Return w'(q)/q as a function of s = q^2, which is what the pair loops compute.

        The default takes the square root of s. A kernel that does not need the root is
        faster if it overrides this method.
        """
        gradient = self.gradient_function()

        def of_square(s: float) -> float:
            return gradient(math.sqrt(s))

        return of_square

    @abstractmethod
    def normalisation(self, dim: int) -> float:
        """Return sigma_d, such that the integral of W over the support is one, for dim 1, 2 or 3."""


class CompiledKernel(NamedTuple):
    """The functions and constants of a kernel that the loops and the weights of a method use.

    ``value`` and ``gradient`` are compiled functions of q (see :class:`Kernel`), ``gradient_of_square`` is the latter
    as a function of q^2; ``support`` is R/h and ``normalisation`` is sigma_d for the dimension at hand. Inside the
    weights function h = R / support.
    """

    value: ScalarFunction
    gradient: ScalarFunction
    support: float
    normalisation: float
    gradient_of_square: ScalarFunction
