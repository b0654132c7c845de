"""Analysis: what probes and other sampled series say."""

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from sphframe.errors import InputError

__all__ = ["probe_statistics", "series_error"]


def probe_statistics(
    dataset: xr.Dataset,
    *,
    start: float | None = None,
    stop: float | None = None,
    expected: ArrayLike | None = None,
) -> xr.Dataset:
    """Mean, standard deviation, smallest and largest pressure of each probe between two times.

    Parameters
    ----------
    dataset: the run.
    start, stop: the window in s; by default the second half of the run.
    expected: what each probe should read, in Pa (probes,).

    Returns
    -------
    ``mean``, ``std``, ``min``, ``max`` on (probe), in Pa, and with ``expected`` also ``error`` = mean - expected.

    Raises
    ------
    InputError: the run has no probes, or no sample in the window.
    """
    if "probe_pressure" not in dataset:
        raise InputError("this run has no probes: its case declares none")
    end = float(dataset["probe_time"][-1]) if dataset.sizes["probe_time"] else 0.0
    window = slice(0.5 * end if start is None else start, stop)
    pressure = dataset["probe_pressure"].sel(probe_time=window).load()
    if not pressure.sizes["probe_time"]:
        raise InputError(f"no sample lies between {window.start} s and {window.stop} s: the run covers 0 to {end:g} s")
    statistics = xr.Dataset(
        {name: getattr(pressure, name)("probe_time") for name in ("mean", "std", "min", "max")},
        attrs={"start": float(pressure.probe_time[0]), "stop": float(pressure.probe_time[-1])},
    )
    if expected is not None:
        statistics["error"] = statistics["mean"] - np.asarray(expected)
    for variable in statistics.data_vars.values():
        variable.attrs["units"] = "Pa"
    return statistics


def series_error(series: xr.DataArray, reference: xr.DataArray) -> dict[str, float]:
    """Compare a sampled series with a reference at the reference's own times, where both exist.

    Parameters
    ----------
    series, reference: one-dimensional, over coordinates that mean the same (both in s, or both dimensionless).

    Returns
    -------
    ``rms``, ``bias`` (mean of series - reference) and ``largest`` difference, in the unit of the series; the number
    of ``points`` compared, and the ``correlation``, NaN where either does not vary.

    Raises
    ------
    InputError: fewer than two reference points lie within the series.

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
