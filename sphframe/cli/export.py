"""CLI: ``sphframe export``."""

from pathlib import Path

from rich.console import Console
from rich.progress import track

from sphframe.analysis import export_run
from sphframe.output import open_dataset


def export_command(path: Path, *, to: str, output: Path | None, surface: bool) -> None:
    """Write a run for ParaView, or its sampled series as a table."""
    folder = output or path.with_name(f"{path.stem}-{to}")
    console = Console(stderr=True, markup=False)
    with open_dataset(path) as dataset:
        files = export_run(
            dataset,
            folder,
            to,
            surface=surface,
            track=lambda times: track(times, "writing", console=console, disable=not console.is_terminal),
        )
    for file in files[:3]:
        print(f"wrote {file}")
    if len(files) > 3:
        print(f"and {len(files) - 3} more in {folder}")
