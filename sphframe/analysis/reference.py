"""Analysis: reference series, in a folder of the user or shipped with a case."""

import os
import re
from pathlib import Path

import numpy as np
import xarray as xr

from sphframe.analysis.exact import case_that_ran
from sphframe.errors import InputError
from sphframe.input_files import text_of


def read_reference_series(folder: str | os.PathLike[str], name: str, column: int | str = 1) -> xr.DataArray:
    """Read the series ``folder/name.csv``.

    The file is comma-separated; lines that start with ``#`` are its header, of which ``# columns: a,b,c`` names the
    columns. The first column is the coordinate.

    Parameters
    ----------
    folder
        the folder that holds the file.
    name
        name of the file, without ``.csv``.
    column
        number (the coordinate is 0) or name of the column to read.

    Returns
    -------
    xr.DataArray
        The series, sorted by its coordinate ``t``, without missing values; the header's lines in the attribute
        ``header``, the columns' names in ``long_name`` of the series and its coordinate.

    Raises
    ------
    InputError
        the folder or the file is missing, or is not such a table.
    """
    folder = Path(folder)
    path = folder / f"{name}.csv"
    if not folder.is_dir():
        raise InputError(
            f"the folder of reference series {folder} does not exist: give the folder that holds {name}.csv"
        )
    if not path.is_file():
        present = ", ".join(sorted(p.stem for p in folder.glob("*.csv"))) or "no .csv file"
        raise InputError(f"{folder} holds no {name}.csv; it holds {present}")
    try:
        lines = text_of(path).splitlines()
        header = [line.lstrip("# ").rstrip() for line in lines if line.startswith("#")]
        rows = [line for line in lines if line.strip() and not line.startswith("#")]
        if not rows:
            raise ValueError("it has no rows")
        table = np.array([[float(cell) if cell.strip() else np.nan for cell in row.split(",")] for row in rows])
    except (OSError, ValueError) as error:
        raise InputError(
            f"{path} is not a reference series ({error}): expected comma-separated numbers below # headers"
        ) from None
    named = [line.removeprefix("columns:") for line in header if line.startswith("columns:")]
    names = [cell.strip() for cell in named[0].split(",")] if named else []
    names = [*names, *(f"column {k}" for k in range(len(names), table.shape[1]))]
    index = names.index(column) if isinstance(column, str) and column in names else column
    if isinstance(index, str) or not 0 <= index < table.shape[1]:
        raise InputError(f"{path} has no column {column!r}; it has {', '.join(names[: table.shape[1]])}")
    table = table[np.isfinite(table[:, index])]
    table = table[np.argsort(table[:, 0], kind="stable")]
    series = xr.DataArray(
        table[:, index], coords={"t": table[:, 0]}, name=name, attrs={"long_name": names[index], "header": header}
    )
    series["t"].attrs["long_name"] = names[0]
    return series


def references_for(dataset: xr.Dataset, source: str | os.PathLike[str]) -> list[xr.DataArray]:
    """Read the reference series for the probes of a run.

    Parameters
    ----------
    dataset
        the run.
    source
        a file ``NAME.csv``; or a folder, of which each file is read whose name has a probe's name between
        underscores, such as ``buchner_P1.csv``.

    Raises
    ------
    InputError
        the file is missing or no such table, or the folder has no series for a probe of the run.
    """
    source = Path(source)
    if not source.is_dir():
        return [read_reference_series(source.parent, source.stem)]
    probes = {str(name) for name in dataset["probe"].values} if "probe_pressure" in dataset else set()
    names = sorted(path.stem for path in source.glob("*.csv") if probes & set(re.split("_", path.stem)))
    if not names:
        raise InputError(
            f"{source} holds no series for a probe of this run ({', '.join(sorted(probes)) or 'it has none'}): name a"
            " file, or give it the name of the probe, as in measured_P1.csv"
        )
    return [read_reference_series(source, name) for name in names]


def shipped_references(dataset: xr.Dataset) -> list[xr.DataArray]:
    """Return the reference series that the case of a run ships, by the names to show; none if it is not installed."""
    case = case_that_ran(dataset)
    files = {} if case is None or "probe_pressure" not in dataset else case.references()
    return [read_reference_series(path.parent, path.stem).rename(name) for name, path in files.items()]
