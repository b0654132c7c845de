"""CLI: ``sphframe run``."""

import time
import warnings
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from sphframe.analysis import summary
from sphframe.analysis.progress import ProgressDisplay
from sphframe.cases import Case, CaseWarning, load_case
from sphframe.cli.values import allow_imports_from_here
from sphframe.console import log_console, result_console
from sphframe.errors import InputError, OutputError, ResumeWarning
from sphframe.hooks import hook_manager
from sphframe.output import CheckpointWriter, NetCDFWriter, open_dataset
from sphframe.output.checkpoint import checkpoint_path
from sphframe.simulation import Simulation


def run_command(
    source: str,
    *,
    preset: str | None,
    overrides: Mapping[str, Any],
    threads: int | None,
    device: str,
    output: Path | None,
    overwrite: bool,
    checkpoint_every: float,
    checkpoint_interval: float | None,
) -> None:
    """Run a case; print its key figures and the files written."""
    log = console_log()
    allow_imports_from_here([source, *overrides.values()])
    case = load_case(source, preset=preset, overrides=overrides)
    path = output or Path(f"{_stem(source)}{_changed(case, preset, overrides)}.nc")
    if path.suffix != ".nc":
        raise InputError(f"--output {path}: give it the ending .nc, since a NetCDF file is written")
    if path.exists() and Path(source).exists() and path.samefile(source):
        raise OutputError(
            f"{path} is the run to repeat, and would be replaced: give another --output, such as again.nc"
        )
    picture = picture_of(path)
    there = [str(one) for one in (path, checkpoint_path(path), picture) if one.exists() and not one.is_dir()]
    if there and not overwrite and (there != [str(picture)] or find_spec("matplotlib")):
        resume = f", sphframe resume {path} to continue the run" if checkpoint_path(path).exists() else ""
        exist = "exists" if len(there) == 1 else "exist"
        raise OutputError(
            f"{' and '.join(there)} {exist}: give --overwrite to replace{' all' * (len(there) > 1)}{resume}, or another"
            " --output"
        )
    writer = NetCDFWriter(path, overwrite=overwrite)
    checkpoints = CheckpointWriter(writer, every=checkpoint_every or None, interval=checkpoint_interval)

    log.print(f"{case.title}: {_described(case)}")
    log.print("compiling (seconds the first time, then read from a cache) ...")
    began = time.monotonic()
    simulation = Simulation(case, threads=threads, device=device)
    log.print(
        f"{simulation.fluid_count:,} fluid and {simulation.ghost_count:,} ghost particles,"
        f"{f' device {device},' * (device != 'cpu')} {simulation.threads}"
        f" thread{'s' * (simulation.threads > 1)}, ready after {time.monotonic() - began:.1f} s"
    )
    run_with_progress(simulation, writer, checkpoints, log)
    report_run(case, path)


def console_log() -> Console:
    """Return the console on which a command reports its progress; show repeated warnings too."""
    warnings.simplefilter("always", CaseWarning)
    warnings.simplefilter("always", ResumeWarning)
    return log_console()


def picture_of(path: Path) -> Path:
    """Return the path of the picture of the run in ``path``."""
    return path.with_suffix(".png")


def run_with_progress(
    simulation: Simulation, writer: NetCDFWriter, checkpoints: CheckpointWriter, log: Console
) -> None:
    """Run with a progress display; if the run does not complete, print which files remain."""
    try:
        simulation.run(hook_manager([writer, checkpoints, ProgressDisplay(log)]))
    except BaseException:
        if writer.run_id and writer.path.exists() and simulation.step:
            log.print(f"{writer.path} holds the run up to t = {simulation.time:.4g} s")
        if checkpoints.path.exists():
            log.print(f"to continue from the last checkpoint: sphframe resume {writer.path}")
        raise


def report_run(case: Case, path: Path) -> None:
    """Print the key figures of the run in ``path`` and draw its picture."""
    picture = "no picture: matplotlib is missing (python -m pip install 'sphframe[plot]')"
    with open_dataset(path) as dataset:
        figures = summary(dataset)
        if find_spec("matplotlib"):
            from sphframe.analysis import plot_run

            plot_run(dataset, picture_of(path))
            picture = f"wrote {picture_of(path)}"
    screen = result_console()
    screen.print(_table(case, figures))
    screen.print(f"wrote {path}\n{picture}")


def _stem(source: str) -> str:
    """The output's name, without its suffix, for a case given by name, ``module:Class`` or file."""
    if Path(source).suffix.lower() in (".toml", ".nc"):
        return Path(source).stem
    return source.rpartition(":")[2]


def _changed(case: Case, preset: str | None, overrides: Mapping[str, Any]) -> str:
    """What tells runs of one case apart, for the name of the output: the preset, and the method if one was chosen."""
    chosen = [preset] if preset else []
    for name in ("wall_treatment", "interpolator"):
        if name in overrides or f"{name}.name" in overrides:
            chosen += [str(getattr(case, name).name).rpartition(":")[2]]
    return "".join(f"-{name}" for name in chosen)


def _described(case: Case) -> str:
    return (
        f"{case.wall_method}, particle spacing"
        f" {case.particle_spacing:g} m, {case.dimension}-D, until {case.until:.4g} s"
    )


def _table(case: Case, figures: Mapping[str, Any]) -> Table:
    """The key figures of :func:`sphframe.analysis.summary`."""
    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_column(style="bold")
    table.add_column()
    table.add_row("simulated", f"{figures['time']:.4g} s in {figures['steps']:,} steps")
    arrival = figures["front_arrival"]
    if arrival is not None:
        table.add_row("front arrival", f"{arrival['time']:.4g} s, t sqrt(g/H) = {arrival['dimensionless']:.3f}")
    for probe, peak in figures["peaks"].items():
        scaled = f", {peak['dimensionless_pressure']:.3f} rho g H" if case.weight else ""
        table.add_row(f"peak at {probe}", f"{peak['pressure']:.4g} Pa{scaled} at {peak['time']:.4g} s")
    for name, error in figures.get("errors", {}).items():
        table.add_row(f"error of {name.replace('_', ' ')}", f"{100 * error:.3g} %")
    work, unit = figures["work_of_bodies"], "J/m" if case.dimension == 2 else "J"
    less = f", less the work of bodies, {work:.4g} {unit} until the end" if work else ""
    table.add_row("total energy", f"at most {100 * figures['energy_excess']:+.2f} % above its initial value{less}")
    if figures["particles_outside"]:
        table.add_row("behind walls", f"up to {figures['particles_outside']} particles")
    if figures["particles_removed"]:
        table.add_row("left the domain", f"{figures['particles_removed']} particles, removed")
    if figures["densities_outside"]:
        table.add_row("densities out of range", f"up to {figures['densities_outside']} particles")
    statuses = ", ".join(f"{name} {100 * share:.2f} %" for name, share in figures["statuses"].items() if share)
    table.add_row("ghosts", statuses)
    table.add_row(
        "speed",
        f"{figures['wall_clock']:.1f} s, output included ({figures['processor_time']:.1f} s of processor time),"
        f" {figures['steps_per_second']:.0f} steps/s, {figures['particle_updates_per_second']:.3g} particle-steps/s"
        + ("; the machine was not idle: the run had to wait" if figures["waited"] else ""),
    )
    return table
