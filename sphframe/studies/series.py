"""Studies: reference series, and figures that several sections derive from a run."""

from pathlib import Path
from typing import Any

import xarray as xr

from sphframe.analysis import read_reference_series, summary
from sphframe.errors import InputError


class Reference:
    """Reference series in a folder that the user names, or none.

    Attributes
    ----------
    absent
        messages about the series that were requested and are not available.
    """

    def __init__(self, folder: Path | None) -> None:
        if folder is not None and not folder.is_dir():
            raise InputError(f"--reference {folder}: there is no such folder; name the one that holds the series")
        self._folder = folder
        self.absent: list[str] = []

    def get(self, name: str, column: int | str = 1) -> xr.DataArray | None:
        """Return the series ``name``, or None if it is not available."""
        if self._folder is None:
            self._note(f"{name}: no --reference folder was given")
            return None
        try:
            return read_reference_series(self._folder, name, column)
        except InputError as error:
            self._note(f"{name}: {error}")
            return None

    def _note(self, text: str) -> None:
        if text not in self.absent:
            self.absent.append(text)


def ended(dataset: xr.Dataset) -> str:
    """Return "yes" for a run that reached its end, otherwise the time at which it stopped."""
    if dataset.attrs["completed"] == "yes":
        return "yes"
    end = float(dataset["probe_time"][-1]) if dataset.sizes["probe_time"] else 0.0
    return f"no, to {end:.3g} s"


def fallback_share(dataset: xr.Dataset) -> float:
    """Return the share of wet ghosts, in per cent, for which the method declined and its fallback was used.

    ::

        100 (TOO_FEW + SINGULAR) / (OK + TOO_FEW + SINGULAR)

    from the statuses of all samples of the run. Dry ghosts, which have no fluid in their support, are not counted.
    """
    statuses: dict[str, Any] = summary(dataset).get("statuses", {})
    declined = float(statuses.get("TOO_FEW", 0.0) + statuses.get("SINGULAR", 0.0))
    wet = declined + float(statuses.get("OK", 0.0))
    return 100.0 * declined / wet if wet else 0.0
