"""Analysis: series of samples: their running mean, and their difference from a reference."""

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from sphframe.errors import InputError


def running_mean(times: ArrayLike, values: ArrayLike, window: float, step: float) -> xr.DataArray:
    """Return the mean of a series over a window around each of evenly spaced times; it removes acoustic waves.

    ::

        mean(t) = 1/W int_(t - W/2)^(t + W/2) f(s) ds

    where f between two samples is their mean. At both ends of the series the window is shortened to the part with
    samples.

    Parameters
    ----------
    times, values
        (n,), with increasing times.
    window
        width W, in the unit of the times.
    step
        distance between the times of the result, in the same unit.

    Returns
    -------
    xr.DataArray
        The mean over the coordinate ``t``; empty for fewer than two samples.

    Examples
    --------
    >>> running_mean(range(5), [0.0, 2.0, 0.0, 2.0, 0.0], window=2.0, step=1.0).values.tolist()
    [1.0, 1.0, 1.0, 1.0, 1.0]
    """
    t, f = np.asarray(times, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if len(t) < 2:
        return xr.DataArray(np.zeros(0), coords={"t": np.zeros(0)})
    even = np.arange(t[0], t[-1] + 0.5 * step, step)
    integral = np.concatenate([[0.0], np.cumsum(0.5 * (f[1:] + f[:-1]) * np.diff(t))])
    low, high = np.maximum(even - 0.5 * window, t[0]), np.minimum(even + 0.5 * window, t[-1])
    mean = (np.interp(high, t, integral) - np.interp(low, t, integral)) / (high - low)
    return xr.DataArray(mean, coords={"t": even})


def series_error(series: xr.DataArray, reference: xr.DataArray) -> dict[str, float]:
    """Compare a sampled series with a reference at the reference's own times, where both exist.

    Parameters
    ----------
    series, reference
        one-dimensional, over coordinates that mean the same (both in s, or both dimensionless).

    Returns
    -------
    dict[str, float]
        ``rms``, ``bias`` (mean of series - reference) and ``largest`` difference, in the unit of the series; the number
        of ``points`` compared, and the ``correlation``, NaN where either does not vary.

    Raises
    ------
    InputError
        fewer than two reference points lie within the series.

    Examples
    --------
    >>> series = xr.DataArray([0.0, 2.0, 4.0], coords={"t": [0.0, 1.0, 2.0]})
    >>> reference = xr.DataArray([1.0, 2.0, 9.0], coords={"t": [0.0, 1.5, 3.0]})
    >>> error = series_error(series, reference)
    >>> round(error["rms"], 3), error["bias"], error["points"]
    (1.0, 0.0, 2.0)
    """
    t, values = (np.asarray(array, dtype=np.float64) for array in (series[series.dims[0]], series))
    t_reference, expected = (np.asarray(array, dtype=np.float64) for array in (reference[reference.dims[0]], reference))
    common = (t_reference >= t[0]) & (t_reference <= t[-1]) & np.isfinite(expected) if t.size else np.zeros(0, bool)
    if common.sum() < 2:
        raise InputError(
            f"the series covers {t[0] if t.size else 0:g} to {t[-1] if t.size else 0:g}, the reference"
            f" {t_reference.min():g} to {t_reference.max():g}: they do not overlap; use the same unit of time"
        )
    given = np.interp(t_reference[common], t, values)
    expected = expected[common]
    difference = given - expected
    varies = np.ptp(given) > 0.0 and np.ptp(expected) > 0.0
    return {
        "rms": float(np.sqrt(np.mean(difference**2))),
        "bias": float(difference.mean()),
        "largest": float(np.abs(difference).max()),
        "correlation": float(np.corrcoef(given, expected)[0, 1]) if varies else float("nan"),
        "points": float(common.sum()),
    }
