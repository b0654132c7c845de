"""Studies: which methods differ by more than the spread of their runs."""

import numpy as np
from scipy import stats

from sphframe.arrays import Array, IntArray
from sphframe.studies.ensemble import CONFIDENCE

ROUND_OFF = 1e-9
"""errors that differ by less are equal"""


def relative_spread(errors: Array) -> Array:
    """Return the standard deviation over the mean (methods,) of ``errors`` (methods, repeats), NaN for single runs."""
    if errors.shape[1] < 2:
        return np.full(len(errors), np.nan)
    mean = errors.mean(axis=1)
    spread: Array = np.divide(errors.std(axis=1, ddof=1), mean, out=np.full(len(errors), np.nan), where=mean > 0.0)
    return spread


def ranks(error: Array, spread: Array, repeats: int) -> IntArray:
    """Return the rank (methods,) of each method: 1 + the number of methods that are better by more than the spread.

    The errors of two methods differ if their difference exceeds the half width of Welch's interval::

        |e_i - e_j| > t sqrt[(s_i e_i)^2 + (s_j e_j)^2] / sqrt(n)

    with Student's t for the level 95 %, two-sided, with the degrees of freedom of Welch and Satterthwaite.

    Parameters
    ----------
    error
        (methods,) mean errors; NaN for a run that failed, which is behind all others.
    spread
        (methods,) standard deviations of a single run over its error; NaN counts as no spread.
    repeats
        number n of runs from which the spread was found.

    Examples
    --------
    >>> ranks(np.array([0.02, 0.01, np.nan, 0.0101]), np.array([0.05, 0.05, np.nan, 0.05]), 4).tolist()
    [3, 1, 4, 1]
    """
    variance = np.nan_to_num(np.square(spread * error)) / max(repeats, 1)
    pair = variance[:, None] + variance[None, :]
    freedom = np.divide(
        np.square(pair) * max(repeats - 1, 1),
        np.square(variance)[:, None] + np.square(variance)[None, :],
        out=np.full(pair.shape, np.inf),
        where=pair > 0.0,
    )
    margin = stats.t.ppf(0.5 * (1.0 + CONFIDENCE), freedom) * np.sqrt(pair)
    known = np.where(np.isnan(error), np.inf, error)
    with np.errstate(invalid="ignore"):
        worse = known[:, None] - known[None, :] > np.nan_to_num(margin) + ROUND_OFF
    return np.asarray(1 + worse.sum(axis=1))
