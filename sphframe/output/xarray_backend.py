"""Output: files of runs in xarray: ``xarray.open_dataset(FILE, engine="sphframe")``, and the accessor ``dataset.sph``.

xarray imports this module when it opens the first dataset and is not told the engine: so the accessor is there, and
here nothing is imported that takes long.
"""

from collections.abc import Iterable
from typing import Any, final

import xarray as xr
from xarray.backends import BackendEntrypoint

import sphframe.output.accessor  # noqa: F401
from sphframe.output.reader import open_dataset


@final
class SphframeBackend(BackendEntrypoint):
    """Opens the file of a run that is complete, was stopped or is still running, as :func:`open_dataset` does."""

    description = "the output of sphframe, complete or not"
    url = "https://sphframe.readthedocs.io"
    open_dataset_parameters = ("filename_or_obj", "drop_variables")

    def open_dataset(self, filename_or_obj: Any, *, drop_variables: str | Iterable[str] | None = None) -> xr.Dataset:
        """Open the file with what has been written so far."""
        names = [drop_variables] if isinstance(drop_variables, str) else drop_variables or ()
        return open_dataset(filename_or_obj).drop_vars(names, errors="ignore")
