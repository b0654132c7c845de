"""CLI: ``sphframe doctor``."""

import importlib.metadata
import os
import platform
import sys
import tempfile
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
from sphframe.compiled.cache import TEMPORARY
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
    cache, problem = _cache()
    table.add_row("compiled code", cache)
    console.print(table)
    if problem:
        console.print(Text.assemble(("broken: ", "bold red"), problem))

    broken, usable = int(bool(problem)), set()
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


def _cache() -> tuple[str, str]:
    """Folder and size of the cache of compiled loops, and what is wrong with it."""
    used = Path(numba.njit(cache=True)(_cache_probe)._cache.cache_path)
    folder = Path(sphframe.__file__).parent
    if not used.is_relative_to(folder):
        folder = used.parent
    files = [file for pattern in ("*.nbi", "*.nbc") for file in folder.rglob(pattern)]
    megabytes = sum(file.stat().st_size for file in files) / 1e6
    return f"{len(files)} files, {megabytes:.1f} MB below {folder}; set NUMBA_CACHE_DIR for another", _fault(
        used, files
    )


def _fault(folder: Path, files: list[Path]) -> str:
    """Return why compiled loops are not kept in ``folder``, or which of ``files`` are damaged; or nothing."""
    remedy = "set NUMBA_CACHE_DIR to a folder that can be written to"
    if TEMPORARY in str(folder):
        return f"no folder for compiled loops can be written to, so that each process compiles all of them: {remedy}"
    try:
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(bytes(1_000_000))
    except OSError as error:
        return f"compiled loops cannot be kept in {folder} ({error.strerror}): make room there, or {remedy}"
    damaged = [file for file in files if not os.access(file, os.R_OK) or not file.stat().st_size]
    if damaged:
        return f"{len(damaged)} files of compiled loops are empty or cannot be read, such as {damaged[0]}: remove them"
    return ""


def _cache_probe() -> None:
    """Stand for the loops: Numba chooses the folder of a function by its file."""
