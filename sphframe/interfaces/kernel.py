"""Interfaces: the smoothing kernel."""

import math
from abc import ABC, abstractmethod
from typing import ClassVar, NamedTuple

from sphframe.interfaces.edge_integrals import EdgeFunction, ScalarFunction, edge_quadrature


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

    def edge_integrals_function(self) -> EdgeFunction:
        """Return the function (z, a, b) -> (c, w0, w1) of the exact integrals over a straight edge in two dimensions.

        A point at the distance z before the line of an edge (z < 0 behind it) has its foot on the line at s = 0; the
        edge is a <= s <= b. All lengths are in smoothing lengths. With r^2 = z^2 + s^2 and
        g(r) = int_r^R w(q) q dq, each integral is over that part of the edge which is nearer than R::

            c  = z int g(r)/r^2 ds     what the solid behind the edge takes away from gamma, the kernel's integral
            w0 = int w(r) ds           grad gamma = -n w0, n the unit normal out of the fluid
            w1 = int w(r) s ds         moment along the edge

        times sigma_2, sigma_2/h and sigma_2. So gamma = 1 - sigma_2 sum c for a point in a fluid with straight
        walls. c jumps by 1/sigma_2 where z changes its sign within the edge; at z = 0 it is 1/2 of that for z = +0.0,
        the limit from the fluid.

        The default is a quadrature: c and w0 times sigma_2 are within 1e-12 for functions of q^2, within 1e-5 for
        splines and Wendland's functions. Kernels of polynomials override it by closed integrals.

        Source: Ferrand et al. (2013), doi:10.1002/fld.3666, for Wendland's C2; by the divergence theorem for others.
        """
        return edge_quadrature(self.value_function(), self.support)

    @abstractmethod
    def normalisation(self, dim: int) -> float:
        """Return sigma_d, such that the integral of W over the support is one, for dim 1, 2 or 3."""


class CompiledKernel(NamedTuple):
    """The functions and constants of a kernel that the loops and the weights of a method use.

    ``value`` and ``gradient`` are compiled functions of q (see :class:`Kernel`), ``gradient_of_square`` is the latter
    as a function of q^2; ``support`` is R/h and ``normalisation`` is sigma_d for the dimension at hand. Inside the
    weights function h = R / support. ``edge_integrals`` is the function of :meth:`Kernel.edge_integrals_function`, None
    in 3-D.
    """

    value: ScalarFunction
    gradient: ScalarFunction
    support: float
    normalisation: float
    gradient_of_square: ScalarFunction
    edge_integrals: EdgeFunction | None = None
