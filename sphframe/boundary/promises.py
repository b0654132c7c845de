"""Boundary: what every run demands of the weights of a method, for the guards of runs and for the verification."""

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array

from sphframe.arrays import IntArray
from sphframe.interfaces import Status, Traits

_ROUND_OFF = 1e-8


class Contradiction(NamedTuple):
    """``what`` is wrong with the weights at a ``point``, their ``lowest`` value and their ``sum``."""

    point: int
    what: str
    lowest: float
    sum: float


def first_contradiction(traits: Traits, matrix: csr_array, statuses: IntArray) -> Contradiction | None:
    """Return the first point whose weights (m, n) are not finite, or contradict ``traits``.

    They do where one is below -1e-8 sum |Phi_j| in spite of ``non_negative``, or the sum differs from one by more than
    1e-6 max(1, sum |Phi_j|) in spite of ``partition_of_unity``.
    """
    points = matrix.shape[0]
    sums, lowest, size = matrix.sum(axis=1), np.zeros(points), np.zeros(points)
    rows = np.repeat(np.arange(points), np.diff(matrix.indptr))
    np.minimum.at(lowest, rows, matrix.data)
    np.add.at(size, rows, np.abs(matrix.data))
    uneven = np.abs(sums - 1.0) > 1e-6 * np.maximum(1.0, size)
    for wrong, what in (
        (~np.isfinite(sums), "weights that are not finite"),
        (traits.non_negative & (lowest < -_ROUND_OFF * size), "negative weights, against its traits,"),
        (
            traits.partition_of_unity & (statuses != int(Status.DRY)) & uneven,
            "weights that do not add up to one, against its traits,",
        ),
    ):
        if np.any(wrong):
            point = int(np.argmax(wrong))
            return Contradiction(point, what, float(lowest[point]), float(sums[point]))
    return None
