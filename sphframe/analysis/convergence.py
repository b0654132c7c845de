"""Analysis: orders of convergence."""

import numpy as np
from numpy.typing import ArrayLike

from sphframe.arrays import Array
from sphframe.errors import InputError


def convergence_orders(spacings: ArrayLike, errors: ArrayLike) -> Array:
    """Observed order between each spacing and the next, log(e1/e2) / log(dx1/dx2), shape (n - 1,).

    >>> convergence_orders([0.04, 0.02, 0.01], [1.6e-3, 4e-4, 2e-4]).round(12).tolist()
    [2.0, 1.0]
    """
    dx, e = _checked(spacings, errors)
    return np.asarray(np.diff(np.log(e)) / np.diff(np.log(dx)))


def convergence_order(spacings: ArrayLike, errors: ArrayLike) -> float:
    """Order p of the least-squares fit log e = p log dx + constant over all spacings.

    >>> round(convergence_order([0.04, 0.02, 0.01], [1.6e-3, 4e-4, 1e-4]), 12)
    2.0

    Raises
    ------
    InputError
        fewer than two spacings, or values that are not positive.
    """
    dx, e = _checked(spacings, errors)
    return float(np.polyfit(np.log(dx), np.log(e), 1)[0])


def _checked(spacings: ArrayLike, errors: ArrayLike) -> tuple[Array, Array]:
    dx, e = np.asarray(spacings, dtype=np.float64), np.asarray(errors, dtype=np.float64)
    if dx.shape != e.shape or dx.ndim != 1 or len(np.unique(dx)) != len(dx) or len(dx) < 2:
        raise InputError(f"give one error for each of at least two different spacings, not {dx} and {e}")
    if not (np.all(dx > 0.0) and np.all(e > 0.0)):
        raise InputError(f"spacings and errors must be positive for an order, not {dx} and {e}")
    return dx, e
