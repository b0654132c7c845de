"""Output: opens the file of a run that is complete, has failed or is still running."""

import os
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from sphframe.errors import InputError
from sphframe.output.check import fault_of
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
    path
        the file.

    Returns
    -------
    xr.Dataset
        A dataset with dimensions ``time`` (frames), ``probe_time`` (samples), ``particle``, ``ghost``, ``space``,
        ``probe``, ``gauge``, ``wall``, ``body`` and ``status``, as far as the case has them; units in the attribute
        ``units`` of each variable, SI throughout.

    Raises
    ------
    InputError
        the file is missing, was not written by sphframe, or is truncated.
    """
    import xarray as xr  # slower to import than all of sphframe, and a run does not need it to start

    import sphframe.output.accessor  # noqa: F401

    path = Path(path)
    if not path.exists():
        raise InputError(f"{path} does not exist: check the name, or write it with sphframe run CASE --output {path}")
    if path.is_dir() and path.suffix != ".zarr":
        raise InputError(f"{path} is not a file: name the .nc file of a run")
    try:
        dataset = xr.open_dataset(path, engine="zarr" if path.is_dir() else "netcdf4", decode_times=False)
    except PermissionError:
        raise InputError(f"{path} cannot be read: check its permissions") from None
    except (OSError, ValueError, KeyError, RuntimeError) as error:
        raise InputError(
            f"{path} is not a readable NetCDF file ({error}): it is not an output of sphframe, or it was truncated; run"
            " again"
        ) from error
    try:
        found = prepared(dataset, str(path))
        if "run_status" not in dataset:
            _check(dataset, str(path))  # prepared and saved before
        return found
    except BaseException:
        dataset.close()
        raise


def prepared(dataset: "xr.Dataset", name: str = "the dataset") -> "xr.Dataset":
    """Return the dataset of a file, however xarray opened it, without padding and with the status in its attributes.

    A dataset that has been prepared before is returned as it is, also if it was saved and opened meanwhile.

    Raises
    ------
    InputError
        it is not that of a run, or the file is truncated.
    """
    if "case_parameters" not in dataset.attrs or "particle_mass" not in dataset:
        raise InputError(
            f"{name} is a NetCDF file, but not the output of a sphframe run: it has no case_parameters. Name another,"
            " or copy it again if it was truncated"
        )
    if "processor_time" not in dataset:
        raise InputError(
            f"{name} was written by an earlier version of sphframe: repeat the run, sphframe run FILE --output NEW.nc"
        )
    if "run_status" not in dataset:
        return dataset
    _check(dataset, name)
    try:
        last_values = [dataset["particle_mass"][-1], *([dataset["density"][-1, -1]] if dataset.sizes["time"] else [])]
        whole = all(float(value) != 0.0 for value in last_values)  # what lies beyond the end is read as zero
    except (OSError, RuntimeError):
        whole = False
    if not whole:
        raise InputError(f"{name} is truncated: part of it is missing; copy it again, or run again")
    samples = int(np.isfinite(dataset["probe_time"].values).sum())
    status = RunStatus(int(dataset["run_status"]))
    message = str(dataset["run_message"].astype(str).values)
    file = dataset
    dataset = file.isel(probe_time=slice(samples)).drop_vars(["run_status", "run_message"])
    dataset.set_close(file.close)
    for variable in dataset.variables.values():  # of the file: another one has other lengths
        for key in ("original_shape", "char_dim_name"):
            variable.encoding.pop(key, None)
    dataset.attrs["run_status"] = status.name.lower()
    dataset.attrs["run_message"] = message
    dataset.attrs["completed"] = "yes" if status is RunStatus.COMPLETED else "no"
    return dataset


def _check(dataset: "xr.Dataset", name: str) -> None:
    fault = fault_of(dataset)
    if fault:
        raise InputError(
            f"{name} is not the whole output of a sphframe run: it has {fault}; it is damaged, or of another program."
            " Copy it again, or run again"
        )
