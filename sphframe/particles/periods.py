"""Particles: directions in which everything repeats itself."""

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sphframe.arrays import Array, BoolArray, IntArray


class Periods(NamedTuple):
    """The box that repeats itself: its ``lower`` corner and its ``length`` (dim,), m; 0 where nothing is repeated."""

    lower: Array
    length: Array

    @classmethod
    def of(cls, axes: Sequence[str], domain: tuple[Sequence[float], Sequence[float]]) -> "Periods":
        """Return the periods along ``axes`` ("x", "y", "z") of a ``domain``, m."""
        lower, upper = np.array(domain, dtype=np.float64)
        return cls(lower, np.where([axis in axes for axis in "xyz"[: len(lower)]], upper - lower, 0.0))

    @classmethod
    def none(cls, dim: int) -> "Periods":
        """Return no periods in ``dim`` dimensions."""
        return cls(np.zeros(dim), np.zeros(dim))

    @property
    def repeats(self) -> BoolArray:
        """Whether each direction (dim,) is periodic."""
        return self.length > 0.0

    def __bool__(self) -> bool:
        """Whether any direction is periodic."""
        return bool(np.any(self.repeats))

    def shifts(self) -> Array:
        """Return the shifts (m, dim) of the box and of all boxes around it, m; the first one is zero."""
        steps = [(0.0, -length, length) if length > 0.0 else (0.0,) for length in self.length]
        return np.array(list(itertools.product(*steps)))

    def turns(self, points: Array) -> IntArray:
        """Return by how many lengths (n, dim) each of ``points`` (n, dim) lies outside the box."""
        length = np.where(self.repeats, self.length, np.inf)
        return np.floor((points - self.lower) / length).astype(np.int64) * self.repeats

    def wrapped(self, points: Array) -> Array:
        """Return the points of the box that stand for ``points`` (n, dim)."""
        return points - self.turns(points) * self.length if self else points

    def nearest(self, offsets: Array) -> Array:
        """Return ``offsets`` (n, dim) between particles and points of the box as those of the nearest copies."""
        if not self:
            return offsets
        length = np.where(self.repeats, self.length, np.inf)
        return offsets - np.rint(offsets / length) * self.length

    def at_home(self, points: Array, slack: float) -> BoolArray:
        """Return which of ``points`` (n, dim) lie in the box, moved by ``-slack`` (m) so that round-off decides not."""
        inside = (points >= self.lower - slack) & (points < self.lower + self.length - slack)
        return np.asarray(np.all(inside | ~self.repeats, axis=1))

    def with_copies(self, points: Array, margin: float) -> tuple[Array, IntArray]:
        """Return ``points`` (n, dim) in the box and their copies within a ``margin`` (m) of it, and their numbers."""
        low = np.where(self.repeats, self.lower - margin, -np.inf)
        high = np.where(self.repeats, self.lower + self.length + margin, np.inf)
        own = self.wrapped(points)
        found = [(own, np.arange(len(points)))]
        for shift in self.shifts()[1:]:
            near = np.all((own + shift >= low) & (own + shift <= high), axis=1)
            found.append((own[near] + shift, np.flatnonzero(near)))
        return np.vstack([part for part, _ in found]), np.concatenate([number for _, number in found])
