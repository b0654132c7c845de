"""CLI: ``sphframe animate``."""

import time
from pathlib import Path

from rich.console import Console
from rich.progress import track

from sphframe.analysis import animate_run
from sphframe.output import open_dataset


def animate_command(
    path: Path,
    *,
    field: str,
    output: Path | None,
    speed: float,
    frames_per_second: float | None,
    oblique: bool,
    surface: bool,
) -> None:
    """Write a film of a run that is complete or still running."""
    target = output or path.with_suffix(".mp4")
    console = Console(stderr=True, markup=False)
    began = time.monotonic()
    with open_dataset(path) as dataset:
        count = animate_run(
            dataset,
            target,
            field=field,
            speed=speed,
            frames_per_second=frames_per_second,
            oblique=oblique,
            surface=surface,
            track=lambda times: track(times, "drawing", console=console, disable=not console.is_terminal),
        )
    playing = f"{frames_per_second:g} per second" if frames_per_second else f"{speed:g} times as fast as in reality"
    elapsed = max(time.monotonic() - began, 1e-9)
    print(f"wrote {target}: {count} frames, {playing}, drawn at {count / elapsed:.2g} per second")
