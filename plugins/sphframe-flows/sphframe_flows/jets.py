"""Exact partial derivatives of functions of two variables, up to third order, by arithmetic of Taylor polynomials."""

from collections.abc import Callable
from typing import Self, final

import numpy as np

from sphframe import Array

_FACTORIAL = (1.0, 1.0, 2.0, 6.0)


@final
class Jet:
    """Values of a function f(x, y) at many points, with its Taylor coefficients f_ij/(i! j!), i + j <= degree <= 3.

    Coefficients are arrays (n,) by (i, j); those that are missing are zero. Sums, products, powers and the functions
    :func:`sine` and :func:`cosine` of jets are jets.
    """

    def __init__(self, coefficients: dict[tuple[int, int], Array], degree: int = 3) -> None:
        self._coefficients, self._degree = coefficients, degree

    @classmethod
    def variables(cls, points: Array, degree: int = 3) -> tuple[Self, Self]:
        """Return the jets of x and y at ``points`` (n, 2), for derivatives up to the ``degree``, at least 1."""
        one = np.ones(len(points))
        return cls({(0, 0): points[:, 0], (1, 0): one}, degree), cls({(0, 0): points[:, 1], (0, 1): one}, degree)

    def derivative(self, i: int, j: int) -> Array:
        """Return the derivative (n,), i times with respect to x and j times with respect to y."""
        return _FACTORIAL[i] * _FACTORIAL[j] * self._coefficients.get((i, j), np.zeros_like(self.value))

    @property
    def value(self) -> Array:
        """The values (n,)."""
        return self._coefficients[0, 0]

    def __add__(self, other: "Jet | float") -> "Jet":
        """Return the sum."""
        if not isinstance(other, Jet):
            return Jet({**self._coefficients, (0, 0): self.value + other}, self._degree)
        found = dict(self._coefficients)
        for place, added in other._coefficients.items():
            found[place] = found[place] + added if place in found else added
        return Jet(found, self._degree)

    def __mul__(self, other: "Jet | float") -> "Jet":
        """Return the product, without terms of higher degree."""
        if not isinstance(other, Jet):
            return Jet({place: value * other for place, value in self._coefficients.items()}, self._degree)
        found: dict[tuple[int, int], Array] = {}
        for (i, j), a in self._coefficients.items():
            for (k, m), b in other._coefficients.items():
                if i + j + k + m <= self._degree:
                    place = i + k, j + m
                    found[place] = found[place] + a * b if place in found else a * b
        return Jet(found, self._degree)

    def __neg__(self) -> "Jet":
        """Return the negative."""
        return self * -1.0

    def __sub__(self, other: "Jet | float") -> "Jet":
        """Return the difference."""
        return self + (-other)

    def __rsub__(self, other: float) -> "Jet":
        """Return the difference."""
        return -self + other

    def __pow__(self, exponent: int) -> "Jet":
        """Return a positive integer power."""
        found = self
        for _ in range(exponent - 1):
            found = found * self
        return found

    __radd__, __rmul__ = __add__, __mul__

    def composed(self, derivatives: Callable[[Array], tuple[Array, Array, Array, Array]]) -> "Jet":
        """Return g(f) for a function g with the ``derivatives`` (g, g', g'', g''')."""
        degree = self._degree
        others = {place: value for place, value in self._coefficients.items() if place != (0, 0)}
        rest = Jet(others | {(0, 0): np.zeros_like(self.value)}, degree)
        value, *slopes = derivatives(self.value)
        found, power = Jet({(0, 0): value}, degree), Jet({(0, 0): np.ones_like(value)}, degree)
        for slope, factorial in zip(slopes[:degree], _FACTORIAL[1:], strict=False):
            power = power * rest
            found = found + power * Jet({(0, 0): slope / factorial}, degree)
        return found


def sine(jet: Jet) -> Jet:
    """Return the sine of a jet."""

    def derivatives(f: Array) -> tuple[Array, Array, Array, Array]:
        sin, cos = np.sin(f), np.cos(f)
        return sin, cos, -sin, -cos

    return jet.composed(derivatives)


def cosine(jet: Jet) -> Jet:
    """Return the cosine of a jet."""

    def derivatives(f: Array) -> tuple[Array, Array, Array, Array]:
        sin, cos = np.sin(f), np.cos(f)
        return cos, -sin, -cos, sin

    return jet.composed(derivatives)
