"""CLI: ``sphframe plot``."""

from collections.abc import Sequence
from pathlib import Path

from sphframe.analysis import plot_run, references_for
from sphframe.output import open_dataset


def plot_command(
    path: Path,
    *,
    field: str,
    times: Sequence[float],
    references: Sequence[Path],
    surface: bool,
    oblique: bool,
    output: Path | None,
) -> None:
    """Draw a run that is complete or still running."""
    target = output or path.with_suffix(".png")
    with open_dataset(path) as dataset:
        series = [one for source in references for one in references_for(dataset, source)]
        plot_run(
            dataset,
            target,
            field=field,
            times=times or None,
            reference=series or None,
            surface=surface,
            oblique=oblique,
        )
    print(f"wrote {target}")
