"""CLI: ``sphframe doctor``."""

import importlib.metadata
import os
import platform
import sys
import warnings
from pathlib import Path
from typing import Any

import numba as typed_numba
import numpy as np
import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

import sphframe
from sphframe.compiled import default_threads
from sphframe.registry import KINDS, check

numba: Any = typed_numba  # the types of its settings and its threading layer are unknown
_PACKAGES = ("numpy", "scipy", "numba", "llvmlite", "xarray", "netCDF4", "pydantic", "matplotlib")


def doctor_command() -> None:
    """Print versions, threads, the compiler's cache and the state of all plugins; exit with 1 if one is broken."""
    console = Console(markup=False, highlight=False, soft_wrap=True)
    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_row("sphframe", f"{sphframe.__version__} in {Path(sphframe.__file__).parent}")
    table.add_row("Python", f"{platform.python_version()} in {sys.prefix}, {platform.platform()}")
    for package in _PACKAGES:
        table.add_row(package, _version(package))
    table.add_row("threads", f"{default_threads()} of {os.cpu_count()} cores; choose others by --threads")
    table.add_row("threading layer", _threading_layer())
    table.add_row("compiled code", _cache())
    console.print(table)

    broken, usable = 0, set()
    for kind in KINDS:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            entries = check(kind)
        for entry in entries:
            if entry.error is not None:
                broken += 1
                console.print(Text.assemble(("broken: ", "bold red"), f"{entry.label}: {entry.error}"))
        usable |= {kind for entry in entries if entry.error is None}
        console.print(f"{kind}: {', '.join(entry.name for entry in entries if entry.error is None) or 'none'}")
    missing = [kind for kind in ("cases", "kernels", "wall_treatments", "interpolators") if kind not in usable]
    if missing:
        console.print(
            Text.assemble(("broken: ", "bold red"), f"no {' and no '.join(missing)}: nothing can run; pip install ")
            + "sphframe-shepard, or 'sphframe[methods]'"
        )
    if broken or missing:
        raise typer.Exit(1)
    console.print("no problem found")


def _version(package: str) -> str:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return "missing"


def _threading_layer() -> str:
    """The layer that Numba chooses once a parallel loop runs."""

    @numba.njit(parallel=True)  # type: ignore[untyped-decorator]
    def add_up(values: Any) -> float:
        total = 0.0
        for i in numba.prange(len(values)):
            total += values[i]
        return total

    try:
        add_up(np.ones(8))
        layer = str(numba.threading_layer())
        return layer if layer == "tbb" else f"{layer}; runs side by side are faster with tbb (pip install tbb)"
    except Exception as error:  # report whatever a broken installation raises
        return f"broken: {type(error).__name__}: {error}"


def _cache() -> str:
    """Folder and size of the cache of compiled loops."""
    folder = Path(numba.config.CACHE_DIR or Path(sphframe.__file__).parent)
    files = [file for pattern in ("*.nbi", "*.nbc") for file in folder.rglob(pattern)]
    megabytes = sum(file.stat().st_size for file in files) / 1e6
    writable = "" if os.access(folder, os.W_OK) else ", read-only: Numba uses a folder of the user instead"
    return f"{len(files)} files, {megabytes:.1f} MB below {folder}{writable}; set NUMBA_CACHE_DIR"
