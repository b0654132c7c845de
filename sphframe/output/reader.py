"""Output: opens the file of a run that is complete, has failed or is still running."""

import os
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from sphframe.errors import InputError
from sphframe.output.schema import RunStatus

if TYPE_CHECKING:
    import xarray as xr


def open_dataset(path: str | os.PathLike[str]) -> "xr.Dataset":
    """Open a file written by :class:`~sphframe.output.NetCDFWriter`.

    Arrays are read when they are used. The dataset of a run that is still running, or was killed, contains the frames
    and samples written so far. The attribute ``completed`` is "yes" or "no", ``run_status`` is "running", "completed"
    or "failed", and ``run_message`` is the reason why a run failed.

    Parameters
    ----------
    path: the file.

    Returns
    -------
    A dataset with dimensions ``time`` (frames), ``probe_time`` (samples), ``particle``, ``ghost``, ``space``,
    ``probe``, ``gauge``, ``wall``, ``body`` and ``status``, as far as the case has them; units in the attribute
    ``units`` of each variable, SI throughout.

    Raises
    ------
    InputError: the file is missing, was not written by sphframe, or is truncated.
    """
    import xarray as xr  # slower to import than all of sphframe, and a run does not need it to start

    path = Path(path)
    if not path.exists():
        raise InputError(f"{path} does not exist: check the name, or write it with sphframe run CASE --output {path}")
    if not path.is_file():
        raise InputError(f"{path} is not a file: name the .nc file of a run")
    try:
        dataset = xr.open_dataset(path, engine="netcdf4", decode_times=False)
    except PermissionError:
        raise InputError(f"{path} cannot be read: check its permissions") from None
    except (OSError, ValueError, KeyError, RuntimeError) as error:
        raise InputError(
            f"{path} is not a readable NetCDF file ({error}): it is not an output of sphframe, or it was truncated; run"
            " again"
        ) from error
    try:
        return _prepared(dataset, path)
    except BaseException:
        dataset.close()
        raise


def _prepared(dataset: "xr.Dataset", path: Path) -> "xr.Dataset":
    if "case_parameters" not in dataset.attrs or "particle_mass" not in dataset:
        raise InputError(
            f"{path} is a NetCDF file, but not the output of a sphframe run: it has no case_parameters. Name another,"
            " or copy it again if it was truncated"
        )
    if "processor_time" not in dataset:
        raise InputError(
            f"{path} was written by an earlier version of sphframe: repeat the run, sphframe run {path} --output NEW.nc"
        )
    try:
        last_values = [dataset["particle_mass"][-1]]
        if dataset.sizes["time"]:
            last_values.append(dataset["density"][-1, -1])
        whole = all(float(value) != 0.0 for value in last_values)  # what lies beyond the end is read as zero
    except (OSError, RuntimeError):
        whole = False
    if not whole:
        raise InputError(f"{path} is truncated: part of it is missing; copy it again, or run again")
    samples = int(np.isfinite(dataset["probe_time"].values).sum())
    status = RunStatus(int(dataset["run_status"]))
    message = str(dataset["run_message"].astype(str).values)
    file = dataset
    dataset = file.isel(probe_time=slice(samples)).drop_vars(["run_status", "run_message"])
    dataset.set_close(file.close)
    dataset.attrs["run_status"] = status.name.lower()
    dataset.attrs["run_message"] = message
    dataset.attrs["completed"] = "yes" if status is RunStatus.COMPLETED else "no"
    return dataset
