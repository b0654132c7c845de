"""CLI: the parameters that several commands share, each declared once."""

from pathlib import Path
from typing import Annotated

import typer


def seconds(text: str) -> float:
    """Return the number of seconds that ``text`` gives; typer's own message would not say what was expected."""
    try:
        return float(text)
    except ValueError:
        raise typer.BadParameter(f"{text!r} is not a number of seconds, such as 0.5") from None


def _whole_number(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise typer.BadParameter(f"{text!r} is not a whole number, such as 4") from None


Assignments = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="a parameter, such as particle_spacing=0.01; repeatable"),
]
CheckpointEvery = Annotated[
    float,
    typer.Option(
        parser=seconds, metavar="SECONDS", help="wall-clock time between checkpoints, beside the output; 0 for none"
    ),
]
CheckpointInterval = Annotated[
    float | None, typer.Option(parser=seconds, metavar="SECONDS", help="simulated time between checkpoints")
]
DrawnField = Annotated[str, typer.Option(metavar="NAME", help="pressure, speed or density")]
Oblique = Annotated[bool, typer.Option("--oblique", help="show a run in 3-D obliquely from above instead of a slice")]
OutputFile = Annotated[
    Path, typer.Argument(metavar="FILE", help="output file (.nc) of a run, finished or still running")
]
Preset = Annotated[str | None, typer.Option(metavar="NAME", help="one of the case's presets, such as paper")]
Scheduler = Annotated[
    str | None, typer.Option(metavar="ADDRESS", help="run on an existing dask cluster, such as tls://127.0.0.1:8786")
]
Device = Annotated[
    str, typer.Option(metavar="NAME", help="where the steps are computed: cpu, or an installed one such as cuda")
]
Threads = Annotated[int | None, typer.Option(parser=_whole_number, metavar="N", help="threads; by default all cores")]
Workers = Annotated[
    int | None,
    typer.Option(parser=_whole_number, metavar="N", help="processes on this machine; by default one per core"),
]
