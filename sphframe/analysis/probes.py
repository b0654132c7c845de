"""Analysis: statistics of the pressure at the probes."""

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from sphframe.errors import InputError


def probe_statistics(
    dataset: xr.Dataset, *, start: float | None = None, stop: float | None = None, expected: ArrayLike | None = None
) -> xr.Dataset:
    """Mean, standard deviation, smallest and largest pressure of each probe between two times.

    Parameters
    ----------
    dataset
        the run.
    start, stop
        the window in s; by default the second half of the run.
    expected
        what each probe should read, in Pa (probes,).

    Returns
    -------
    xr.Dataset
        ``mean``, ``std``, ``min``, ``max`` on (probe), in Pa, and with ``expected`` also ``error`` = mean - expected.

    Raises
    ------
    InputError
        the run has no probes, or no sample in the window.
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
