"""Simulation: one call from a case to its dataset."""

import os
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from sphframe.cases import Case, load_case
from sphframe.hooks import hook_manager
from sphframe.output import NetCDFWriter, open_dataset
from sphframe.simulation.simulation import Simulation

__all__ = ["Run", "run"]


@dataclass(frozen=True)
class Run:
    """A finished run: its ``case``, and the file at ``path`` as an open ``dataset``."""

    case: Case
    path: Path
    dataset: xr.Dataset


def run(
    case: Case | str | os.PathLike[str],
    *,
    preset: str | None = None,
    output: str | os.PathLike[str] | None = None,
    threads: int | None = None,
    overwrite: bool = False,
    hooks: Sequence[object] = (),
    **parameters: Any,
) -> Run:
    """Run a case to its end and return its dataset.

    Parameters
    ----------
    case: a case, the name of one (``"dam-break"``), a TOML case file, or a NetCDF file of an earlier run to repeat.
    preset: a named set of the case's parameters, such as ``"paper"``.
    output: NetCDF file to write; by default a temporary file that lasts as long as the operating system keeps it.
    threads: threads of the compiled loops; by default all cores.
    overwrite: whether an existing ``output`` may be replaced.
    hooks: listeners to the run's events, see :mod:`sphframe.hooks`.
    **parameters: parameters of the case by name, ``interpolator="mls-linear"``, ``particle_spacing=0.01``.

    Raises
    ------
    InputError, PluginError: when the case or a component is not valid; nothing has been run.
    OutputError: when the output cannot be written.
    SimulationError: when the run goes wrong; what was computed until then is in the file.
    """
    if isinstance(case, Case):
        ready = load_case(case, preset=preset, overrides=parameters)
    else:
        ready = load_case(os.fspath(case), preset=preset, overrides=parameters)
    if output is None:
        path = Path(tempfile.mkdtemp(prefix="sphframe-")) / "run.nc"
    else:
        path = Path(output)
    writer = NetCDFWriter(path, overwrite=overwrite)
    Simulation(ready, threads=threads).run(hook_manager([writer, *hooks]))
    return Run(ready, path, open_dataset(path))
