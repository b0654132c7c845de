"""CLI: ``sphframe resume``."""

from pathlib import Path

from sphframe.cli.run import console_log, finish, go
from sphframe.output import CheckpointWriter
from sphframe.simulation.run import prepare_resume

__all__ = ["resume_command"]


def resume_command(
    path: Path, *, threads: int | None, trusted: bool, checkpoint_every: float, checkpoint_interval: float | None
) -> None:
    """Continue a run from its last checkpoint, and say what happened and what was written."""
    log = console_log()
    simulation, writer = prepare_resume(path, trusted=trusted, threads=threads)
    checkpoints = CheckpointWriter(writer, every=checkpoint_every or None, interval=checkpoint_interval)
    log.print(
        f"{simulation.case.title}: continues at t = {simulation.time:.4g} of {simulation.case.until:.4g} s,"
        f" step {simulation.step:,}"
    )
    go(simulation, writer, checkpoints, log)
    finish(simulation.case, writer.path)
