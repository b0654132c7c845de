"""CLI: ``sphframe run``."""

import contextlib
import signal
import time
import warnings
from collections.abc import Iterator, Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from sphframe.analysis import summary
from sphframe.cases import Case, CaseWarning, load_case
from sphframe.cli.progress import ProgressDisplay
from sphframe.errors import InputError, OutputError
from sphframe.hooks import hook_manager
from sphframe.output import NetCDFWriter, open_dataset
from sphframe.simulation import Simulation

__all__ = ["run_command"]


def run_command(
    source: str,
    *,
    preset: str | None,
    overrides: Mapping[str, Any],
    threads: int | None,
    output: Path | None,
    overwrite: bool,
) -> None:
    """Run a case and say what happened and what was written."""
    screen = Console(highlight=False, soft_wrap=True)
    log = Console(stderr=True, highlight=False, soft_wrap=True)
    warnings.simplefilter("always", CaseWarning)
    case = load_case(source, preset=preset, overrides=overrides)
    path = output or Path(f"{_stem(source)}.nc")
    picture = path.with_suffix(".png")
    if path.suffix != ".nc":
        raise InputError(f"--output {path}: give it the ending .nc, since a NetCDF file is written")
    if picture.exists() and not overwrite and find_spec("matplotlib"):
        raise OutputError(f"{picture} exists; give --overwrite to replace it, or --output FILE to write elsewhere")
    writer = NetCDFWriter(path, overwrite=overwrite)

    log.print(f"{case.title}: {_described(case)}")
    log.print("compiling (seconds the first time, then read from a cache) ...")
    began = time.monotonic()
    simulation = Simulation(case, threads=threads)
    log.print(
        f"{simulation.fluid_count:,} fluid and {simulation.ghost_count:,} ghost particles, {simulation.threads}"
        f" thread{'s' * (simulation.threads > 1)}, ready after {time.monotonic() - began:.1f} s"
    )
    with _stopped_by_termination(), _saying_what_is_left(path, simulation, log):
        simulation.run(hook_manager([writer, ProgressDisplay(log)]))

    with open_dataset(path) as dataset:
        screen.print(_table(case, summary(dataset)))
        screen.print(f"wrote {path}")
        if find_spec("matplotlib"):
            from sphframe.analysis import plot_run

            plot_run(dataset, picture)
            screen.print(f"wrote {picture}")
        else:
            screen.print("no picture: matplotlib is missing (python -m pip install 'sphframe[plot]')")


def _stem(source: str) -> str:
    """The name of the output for a case's name, ``module:Class`` or file."""
    return Path(source.rpartition(":")[2]).stem


def _described(case: Case) -> str:
    return (
        f"{case.interpolator.name} interpolation, {case.hydrostatic_lift} lift, particle spacing"
        f" {case.particle_spacing:g} m, {case.dimension}-D, until {case.until:.4g} s"
    )


@contextlib.contextmanager
def _stopped_by_termination() -> Iterator[None]:
    """Let SIGTERM end a run as Ctrl-C does: the files are closed."""
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


@contextlib.contextmanager
def _saying_what_is_left(path: Path, simulation: Simulation, log: Console) -> Iterator[None]:
    try:
        yield
    except BaseException:
        if path.exists() and simulation.step:
            log.print(f"{path} holds the run up to t = {simulation.time:.4g} s")
        raise


def _table(case: Case, figures: Mapping[str, Any]) -> Table:
    """What happened, from :func:`sphframe.analysis.summary`."""
    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_column(style="bold")
    table.add_column()
    table.add_row("simulated", f"{figures['time']:.4g} s in {figures['steps']:,} steps")
    arrival = figures["front_arrival"]
    if arrival is not None:
        table.add_row("front arrival", f"{arrival['time']:.4g} s, t sqrt(g/H) = {arrival['dimensionless']:.3f}")
    for probe, peak in figures["peaks"].items():
        scaled = f", {peak['dimensionless_pressure']:.3f} rho g H" if case.gravity else ""
        table.add_row(f"peak at {probe}", f"{peak['pressure']:.4g} Pa{scaled} at {peak['time']:.4g} s")
    table.add_row("total energy", f"at most {100 * figures['energy_excess']:+.2f} % above its initial value")
    if figures["particles_outside"]:
        table.add_row("behind walls", f"up to {figures['particles_outside']} particles")
    statuses = ", ".join(f"{name} {100 * share:.2f} %" for name, share in figures["statuses"].items() if share)
    table.add_row("ghosts", statuses)
    table.add_row(
        "speed",
        f"{figures['wall_clock']:.1f} s, {figures['steps_per_second']:.0f} steps/s,"
        f" {figures['particle_updates_per_second']:.3g} particle-steps/s",
    )
    return table
