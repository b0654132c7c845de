"""CLI: the commands, and how errors leave them.

What a command needs is imported inside it, so that ``sphframe --help`` answers at once.
"""

import os
import sys
import traceback
import warnings
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.text import Text
from typer.core import TyperGroup

import sphframe
from sphframe.errors import SphframeError

__all__ = ["app", "main"]

WELCOME = """\
sphframe {version}: a laboratory for wall boundaries in SPH free-surface flow

  sphframe run dam-break        simulate a case (about a minute)
  sphframe resume dam-break.nc  continue a run that was interrupted
  sphframe compare dam-break    several methods and resolutions side by side
  sphframe reproduce            the whole paper, with a report of what it shows
  sphframe plot dam-break.nc    pictures: particles, probes, energies
  sphframe animate dam-break.nc a film, .mp4 or .gif
  sphframe watch dam-break.nc   a page that shows a run while it goes
  sphframe export dam-break.nc  for ParaView (vtkhdf, pvd), or csv
  sphframe list                 what is installed: cases, interpolation methods, ...
  sphframe show dam-break       a case's parameters, units, defaults and presets
  sphframe new-plugin           start a boundary interpolation method of your own
  sphframe verify METHOD        test a method against what it promises
  sphframe doctor               check this installation
  sphframe bench                measure its speed, memory and start-up on this machine

sphframe COMMAND --help explains a command."""


class _Commands(TyperGroup):
    """Ends every command with one clear message and an exit code, never with a traceback."""

    def invoke(self, ctx: Any) -> Any:
        with warnings.catch_warnings():
            warnings.showwarning = _print_warning  # type: ignore[assignment]
            try:
                return super().invoke(ctx)
            except (SphframeError, KeyboardInterrupt, MemoryError, OSError) as error:
                if os.environ.get("SPHFRAME_DEBUG") == "1":
                    raise
                raise typer.Exit(_ended_by(error)) from None
            except (typer.Exit, typer.Abort, typer.TyperException):
                raise
            except Exception as error:
                if os.environ.get("SPHFRAME_DEBUG") == "1":
                    raise
                *_, last = traceback.extract_tb(error.__traceback__)
                _print_error(
                    f"{type(error).__name__}: {error} (raised in {last.filename}, line {last.lineno})\n"
                    "this is not a mistake of yours but a defect of sphframe or of a"
                    " plugin; set SPHFRAME_DEBUG=1 to see where it comes from, and please report it"
                )
                raise typer.Exit(1) from None


app = typer.Typer(
    name="sphframe",
    cls=_Commands,
    help="A laboratory for wall boundaries in SPH free-surface flow.",
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)

Kind = Annotated[str | None, typer.Argument(metavar="KIND", help="interpolators, kernels, cases, ...; all by default")]
Preset = Annotated[str | None, typer.Option(metavar="NAME", help="one of the case's presets, such as paper")]


def _whole_number(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise typer.BadParameter(f"{text!r} is not a whole number, such as 4") from None


def _seconds(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise typer.BadParameter(f"{text!r} is not a number of seconds, such as 0.5") from None


Threads = Annotated[int | None, typer.Option(parser=_whole_number, metavar="N", help="threads; by default all cores")]
Every = Annotated[
    float,
    typer.Option(
        parser=_seconds, metavar="SECONDS", help="wall-clock time between checkpoints, beside the output; 0 for none"
    ),
]
Interval = Annotated[
    float | None, typer.Option(parser=_seconds, metavar="SECONDS", help="simulated time between checkpoints")
]


def main() -> None:
    """Run the command line; raises SystemExit with 0, 1 (a defect), 2 (input, files), 3 (a run gone wrong) or 130."""
    app()


@app.callback(invoke_without_command=True)
def _welcome(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="print the version and exit")] = False,
) -> None:
    if version:
        print(sphframe.__version__)
        raise typer.Exit
    if context.invoked_subcommand is None:
        print(WELCOME.format(version=sphframe.__version__))


@app.command("run")
def _run(
    case: Annotated[
        str, typer.Argument(metavar="CASE", help="a case's name, a TOML case file, or an output file (.nc) to repeat")
    ],
    preset: Preset = None,
    interpolator: Annotated[str | None, typer.Option(metavar="NAME", help="boundary interpolation method")] = None,
    assignments: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="a parameter, such as particle_spacing=0.01; repeatable"),
    ] = None,
    until: Annotated[str | None, typer.Option(metavar="SECONDS", help="simulated time at which to stop")] = None,
    threads: Threads = None,
    output: Annotated[Path | None, typer.Option(metavar="FILE", help="by default CASE.nc in this folder")] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="replace files of an earlier run")] = False,
    checkpoint_every: Every = 60.0,
    checkpoint_interval: Interval = None,
) -> None:
    """Simulate a case, and write CASE.nc and a picture."""
    from sphframe.cli.run import run_command
    from sphframe.cli.values import read_assignments

    overrides = read_assignments(assignments or [], {"interpolator": interpolator, "until": until})
    run_command(
        case,
        preset=preset,
        overrides=overrides,
        threads=threads,
        output=output,
        overwrite=overwrite,
        checkpoint_every=checkpoint_every,
        checkpoint_interval=checkpoint_interval,
    )


@app.command("resume")
def _resume(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="output file (.nc) of a run that did not end")],
    threads: Threads = None,
    trust: Annotated[bool, typer.Option("--trust", help="import code that the file names as module:attribute")] = False,
    checkpoint_every: Every = 60.0,
    checkpoint_interval: Interval = None,
) -> None:
    """Continue a run from its last checkpoint, to the same bits as if it had never been interrupted."""
    from sphframe.cli.resume import resume_command

    resume_command(
        file,
        threads=threads,
        trusted=trust,
        checkpoint_every=checkpoint_every,
        checkpoint_interval=checkpoint_interval,
    )


Workers = Annotated[
    int | None,
    typer.Option(parser=_whole_number, metavar="N", help="processes on this machine; by default one a core"),
]
Scheduler = Annotated[
    str | None,
    typer.Option(metavar="ADDRESS", help="run on a dask cluster that is there, such as tcp://127.0.0.1:8786"),
]


@app.command("compare")
def _compare(
    case: Annotated[str, typer.Argument(metavar="CASE", help="a case's name or a TOML case file")],
    interpolators: Annotated[
        str, typer.Option(metavar="NAME,...", help="methods, such as improved-shepard,mls-linear")
    ] = "improved-shepard",
    preset: Preset = None,
    assignments: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="a parameter; repeatable. particle_spacing=0.02,0.01,0.005 gives the resolutions",
        ),
    ] = None,
    reference: Annotated[
        Path | None, typer.Option(metavar="FILE", help="a series p/(rho g H) over t sqrt(g/H) to compare with")
    ] = None,
    probe: Annotated[
        str | None, typer.Option(metavar="NAME", help="the probe to compare; by default the first")
    ] = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    output: Annotated[Path, typer.Option(metavar="DIR", help="folder for the dataset, report and runs")] = Path(
        "comparison"
    ),
) -> None:
    """Run a case with several methods and resolutions: one dataset, errors, costs, observed orders."""
    from sphframe.cli.compare import compare_command
    from sphframe.cli.values import read_assignments

    compare_command(
        case,
        interpolators=interpolators,
        preset=preset,
        parameters=read_assignments(assignments or [], {}),
        reference=reference,
        probe=probe,
        workers=workers,
        scheduler=scheduler,
        output=output,
    )


@app.command("reproduce")
def _reproduce(
    output: Annotated[Path, typer.Option(metavar="DIR", help="folder for the report, figures, tables and runs")],
    only: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SECTION",
            help="hydrostatic-tank, dam-break, fixed-wall, movable-wall or cost; repeatable, or with commas",
        ),
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="coarse and short, ten minutes on two cores")] = False,
    reference: Annotated[Path | None, typer.Option(metavar="DIR", help="folder of reference series")] = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
) -> None:
    """Reproduce the paper: all its runs, a report with every figure and table, and what became of its claims."""
    from sphframe.cli.reproduce import reproduce_command

    reproduce_command(
        only=only or [],
        quick=quick,
        reference=reference,
        workers=workers,
        scheduler=scheduler,
        output=output,
    )


OutputFile = Annotated[Path, typer.Argument(metavar="FILE", help="output file (.nc) of a run, finished or still going")]
DrawnField = Annotated[str, typer.Option(metavar="NAME", help="pressure, speed or density")]


@app.command("plot")
def _plot(
    file: OutputFile,
    field: DrawnField = "pressure",
    times: Annotated[
        list[float] | None,
        typer.Option("--time", parser=_seconds, metavar="SECONDS", help="repeatable; by default four times"),
    ] = None,
    references: Annotated[
        list[Path] | None,
        typer.Option("--reference", metavar="PATH", help="a .csv of p/(rho g H) over t sqrt(g/H), or a folder of them"),
    ] = None,
    surface: Annotated[bool, typer.Option("--surface", help="draw the free surface")] = False,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help=".png, .pdf or .svg; by default FILE.png")
    ] = None,
) -> None:
    """Draw a run: particles at several times, probes beside reference series, energies."""
    from sphframe.cli.plot import plot_command

    plot_command(file, field=field, times=times or [], references=references or [], surface=surface, output=output)


@app.command("animate")
def _animate(
    file: OutputFile,
    field: DrawnField = "pressure",
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILM", help=".mp4 or .gif; by default FILE.mp4")
    ] = None,
    frames_per_second: Annotated[
        float, typer.Option("--fps", metavar="N", help="frames a second that the film plays")
    ] = 25.0,
) -> None:
    """Write a film of a run."""
    from sphframe.cli.animate import animate_command

    animate_command(file, field=field, output=output, frames_per_second=frames_per_second)


@app.command("export")
def _export(
    file: OutputFile,
    to: Annotated[str, typer.Option(metavar="FORMAT", help="vtkhdf, pvd or csv")] = "vtkhdf",
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FOLDER", help="by default FILE-FORMAT")
    ] = None,
) -> None:
    """Write a run for ParaView with walls and ghosts, or its sampled series as a table."""
    from sphframe.cli.export import export_command

    export_command(file, to=to, output=output)


@app.command("watch")
def _watch(
    file: OutputFile,
    field: DrawnField = "pressure",
    port: Annotated[
        int, typer.Option(min=0, max=65535, metavar="N", help="of the page, on this machine; 0 for any that is free")
    ] = 8765,
    open_browser: Annotated[bool, typer.Option("--open/--no-open", help="open the page in your browser")] = True,
) -> None:
    """Show the newest frame and the probes of a run while it goes, on a page that refreshes itself."""
    from sphframe.cli.watch import watch_command

    watch_command(file, field=field, port=port, open_browser=open_browser)


@app.command("list")
def _list(kind: Kind = None) -> None:
    """List what is installed, without loading it."""
    from sphframe.cli.list import list_command

    list_command(kind)


@app.command("show")
def _show(
    name: Annotated[str, typer.Argument(metavar="NAME", help="a case, a case file, an output file, or any component")],
    preset: Preset = None,
) -> None:
    """Show a case's parameters, units, defaults and presets, or a component's options."""
    from sphframe.cli.show import show_command

    show_command(name, preset)


@app.command("verify")
def _verify(
    names: Annotated[list[str] | None, typer.Argument(metavar="NAME...", help="by default all methods")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="print JSON in place of a table")] = False,
) -> None:
    """Test interpolation methods against what they promise."""
    from sphframe.cli.verify import verify

    raise typer.Exit(verify(names or [], as_json=as_json))


@app.command("new-plugin")
def _new_plugin(
    name: Annotated[str, typer.Argument(metavar="NAME", help="of the method: lower-case words joined by hyphens")],
    folder: Annotated[Path, typer.Option(help="where the folder sphframe-NAME is made")] = Path(),
    licence: Annotated[str, typer.Option(help="BSD-3-Clause, MIT or none")] = "BSD-3-Clause",
    author: Annotated[str, typer.Option(help="named in pyproject.toml and in the licence")] = "",
) -> None:
    """Start a boundary interpolation method of your own: a distribution that installs, verifies and runs."""
    from sphframe.cli.new_plugin import new_plugin

    root = new_plugin(name, folder=folder, licence=licence, author=author)
    print(f"written: {root}\n")
    print(f'  pip install -e "{root}[test]"')
    print(f"  sphframe verify {name}")
    print(f"  sphframe run dam-break --interpolator {name}")


@app.command("bench")
def _bench(
    json_file: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="write everything to this file as well")
    ] = None,
    particles: Annotated[
        list[str] | None,
        typer.Option(metavar="N", help="fluid particles; repeatable, or with commas; by default 45000"),
    ] = None,
    threads: Annotated[
        list[str] | None,
        typer.Option(metavar="N", help="threads; repeatable, or with commas; by default 1 and 2"),
    ] = None,
    only: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SECTION",
            help="peak, rest, developed, 3d, methods, memory or start-up; repeatable, or with commas",
        ),
    ] = None,
) -> None:
    """Measure speed, memory and start-up on this machine, beside bare reference loops (some four minutes)."""
    from sphframe.cli.bench import bench_command

    bench_command(particles=particles or [], threads=threads or [], only=only or [], json_file=json_file)


@app.command("doctor")
def _doctor() -> None:
    """Check this installation: versions, threads, compiler cache, plugins."""
    from sphframe.cli.doctor import doctor_command

    doctor_command()


def _ended_by(error: BaseException) -> int:
    """Print what ended a command; return its exit code."""
    if isinstance(error, SphframeError):
        _print_error(str(error))
        return error.exit_code
    if isinstance(error, KeyboardInterrupt):
        _print_error("interrupted")
        return 130
    if isinstance(error, BrokenPipeError):  # the reader of a pipe, such as head, has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    if isinstance(error, MemoryError):
        _print_error("not enough memory; choose a larger particle_spacing, or fewer threads")
        return 2
    _print_error(str(error))
    return 2


def _print_error(message: str) -> None:
    first, *rest = message.splitlines() or [""]
    console = Console(stderr=True, highlight=False, soft_wrap=True)
    console.print(Text.assemble(("error: ", "bold red"), first))
    for line in rest:
        console.print(Text(line))


def _print_warning(message: Warning | str, category: type[Warning], *_: Any) -> None:
    Console(stderr=True, highlight=False, soft_wrap=True).print(
        Text.assemble(("warning: ", "bold yellow"), " ".join(str(message).split()))
    )
