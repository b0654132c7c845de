"""Studies: what the sections read from series of samples."""

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from sphframe.analysis import read_reference_series, summary
from sphframe.errors import InputError

__all__ = ["Reference", "ended", "fallback_share", "running_mean"]

Array = NDArray[np.float64]


class Reference:
    """The folder of reference series that the user named, or none; remembers what was asked for in vain."""

    def __init__(self, folder: Path | None) -> None:
        if folder is not None and not folder.is_dir():
            raise InputError(f"--reference {folder}: there is no such folder; name the one that holds the series")
        self._folder = folder
        self.absent: list[str] = []

    def get(self, name: str, column: int | str = 1) -> xr.DataArray | None:
        """Return the series ``name``, or None where it is not there."""
        if self._folder is None:
            self._note(f"{name}: no --reference folder was named")
            return None
        try:
            return read_reference_series(self._folder, name, column)
        except InputError as error:
            self._note(f"{name}: {error}")
            return None

    def _note(self, text: str) -> None:
        if text not in self.absent:
            self.absent.append(text)


def running_mean(t: Array, values: Array, window: float, step: float) -> xr.DataArray:
    """Mean of a series over ``window`` around evenly spaced times ``t``, which takes out acoustic waves.

    >>> running_mean(np.arange(5.0), np.array([0.0, 2.0, 0.0, 2.0, 0.0]), window=2.0, step=1.0).values.tolist()
    [1.0, 1.0, 1.0, 1.0, 1.0]
    """
    if len(t) < 2:
        return xr.DataArray(np.zeros(0), coords={"t": np.zeros(0)})
    even = np.arange(t[0], t[-1] + 0.5 * step, step)
    integral = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(t))])
    low, high = np.maximum(even - 0.5 * window, t[0]), np.minimum(even + 0.5 * window, t[-1])
    smooth = (np.interp(high, t, integral) - np.interp(low, t, integral)) / (high - low)
    return xr.DataArray(smooth, coords={"t": even})


def ended(dataset: xr.Dataset) -> str:
    """Return "yes" for a run that came to its end, else how far it came."""
    if dataset.attrs["completed"] == "yes":
        return "yes"
    end = float(dataset["probe_time"][-1]) if dataset.sizes["probe_time"] else 0.0
    return f"no, to {end:.3g} s"


def fallback_share(dataset: xr.Dataset) -> float:
    """Share of wet ghosts, in per cent, for which the method declined and its fallback was used."""
    statuses: dict[str, Any] = summary(dataset).get("statuses", {})
    declined = float(statuses.get("TOO_FEW", 0.0) + statuses.get("SINGULAR", 0.0))
    wet = declined + float(statuses.get("OK", 0.0))
    return 100.0 * declined / wet if wet else 0.0
