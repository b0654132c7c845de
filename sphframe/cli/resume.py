"""CLI: ``sphframe resume``."""

from pathlib import Path

from sphframe.cli.run import console_log, report_run, run_with_progress
from sphframe.output import CheckpointWriter
from sphframe.simulation.run import prepare_resume


def resume_command(
    path: Path,
    *,
    threads: int | None,
    device: str,
    trusted: bool,
    checkpoint_every: float,
    checkpoint_interval: float | None,
) -> None:
    """Continue a run from its last checkpoint; print its key figures and the files written."""
    log = console_log()
    simulation, writer = prepare_resume(path, trusted=trusted, threads=threads, device=device)
    checkpoints = CheckpointWriter(writer, every=checkpoint_every or None, interval=checkpoint_interval)
    log.print(
        f"{simulation.case.title}: continues at t = {simulation.time:.4g} of {simulation.case.until:.4g} s,"
        f" step {simulation.step:,}"
    )
    run_with_progress(simulation, writer, checkpoints, log)
    report_run(simulation.case, writer.path)
