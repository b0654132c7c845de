"""CLI: the commands and their parameters.

Each command imports what it needs when it is called, so that ``sphframe --help`` answers at once.
"""

from pathlib import Path
from typing import Annotated

import typer

import sphframe
from sphframe.cli.failures import Commands
from sphframe.cli.parameters import (
    Assignments,
    CheckpointEvery,
    CheckpointInterval,
    Device,
    DrawnField,
    Oblique,
    OutputFile,
    Preset,
    Scheduler,
    Threads,
    Workers,
    seconds,
)

WELCOME = """\
sphframe {version}: a laboratory for wall boundaries in SPH free-surface flow

  sphframe run dam-break        simulate a case (about a minute)
  sphframe resume dam-break.nc  continue a run that was interrupted
  sphframe compare dam-break    several methods and resolutions side by side
  sphframe reproduce            a study, such as a whole paper, with a report
  sphframe rank                 every method on every benchmark: the league table
  sphframe plot dam-break.nc    pictures: particles, probes, energies
  sphframe animate dam-break.nc a film, .mp4 or .gif
  sphframe watch dam-break.nc   a page that shows a run while it is running
  sphframe export dam-break.nc  for ParaView (pvd, vtkhdf), csv or zarr
  sphframe list                 what is installed: cases, interpolation methods, ...
  sphframe show dam-break       a case's parameters, units, defaults and presets
  sphframe new-plugin           start a boundary interpolation method of your own
  sphframe verify METHOD        test a method against its declared traits
  sphframe evaluate FILE        judge methods on the particles of a file
  sphframe doctor               check this installation
  sphframe bench                measure its speed, memory and start-up on this machine

sphframe COMMAND --help explains a command."""


app = typer.Typer(
    name="sphframe",
    cls=Commands,
    help="A laboratory for wall boundaries in SPH free-surface flow.",
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def main() -> None:
    """Run the command line; raises SystemExit with 0, 1 (a defect), 2 (input, files), 3 (a run went wrong) or 130."""
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
    assignments: Assignments = None,
    until: Annotated[str | None, typer.Option(metavar="SECONDS", help="simulated time at which to stop")] = None,
    threads: Threads = None,
    device: Device = "cpu",
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="by default CASE.nc in this folder, or CASE-METHOD.nc"),
    ] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="replace files of an earlier run")] = False,
    checkpoint_every: CheckpointEvery = 60.0,
    checkpoint_interval: CheckpointInterval = None,
) -> None:
    """Simulate a case; write CASE.nc and a picture."""
    from sphframe.cli.run import run_command
    from sphframe.cli.values import read_assignments

    overrides = read_assignments(assignments or [], {"interpolator": interpolator, "until": until})
    run_command(
        case,
        preset=preset,
        overrides=overrides,
        threads=threads,
        device=device,
        output=output,
        overwrite=overwrite,
        checkpoint_every=checkpoint_every,
        checkpoint_interval=checkpoint_interval,
    )


@app.command("resume")
def _resume(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="output file (.nc) of a run that is not complete")],
    threads: Threads = None,
    device: Device = "cpu",
    trust: Annotated[bool, typer.Option("--trust", help="import code that the file names as module:attribute")] = False,
    checkpoint_every: CheckpointEvery = 60.0,
    checkpoint_interval: CheckpointInterval = None,
) -> None:
    """Continue a run from its last checkpoint; the result has the same bits as that of an uninterrupted run."""
    from sphframe.cli.resume import resume_command

    resume_command(
        file,
        threads=threads,
        device=device,
        trusted=trust,
        checkpoint_every=checkpoint_every,
        checkpoint_interval=checkpoint_interval,
    )


@app.command("compare")
def _compare(
    case: Annotated[str, typer.Argument(metavar="CASE", help="a case's name or a TOML case file")],
    interpolators: Annotated[
        str,
        typer.Option(
            "--methods",
            "--interpolators",
            metavar="NAME,...",
            help="interpolators or wall treatments, such as improved-shepard,mls-linear,adami-2012",
        ),
    ] = "improved-shepard",
    preset: Preset = None,
    assignments: Assignments = None,
    reference: Annotated[
        Path | None, typer.Option(metavar="FILE", help="a series p/(rho g H) over t sqrt(g/H) to compare with")
    ] = None,
    probe: Annotated[
        str | None, typer.Option(metavar="NAME", help="the probe to compare; by default the first")
    ] = None,
    repeats: Annotated[
        int, typer.Option(metavar="N", help="runs with displaced particles: 95 % bands of peaks and impulses")
    ] = 1,
    workers: Workers = None,
    scheduler: Scheduler = None,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="DIR", help="folder for the dataset, report and runs")
    ] = Path("comparison"),
) -> None:
    """Run a case with several methods and resolutions: one dataset, errors, costs, observed orders.

    The resolutions are given by --set particle_spacing=0.02,0.01,0.005.
    """
    from sphframe.cli.compare import compare_command
    from sphframe.cli.values import read_assignments

    compare_command(
        case,
        interpolators=interpolators,
        preset=preset,
        parameters=read_assignments(assignments or [], {}),
        reference=reference,
        probe=probe,
        repeats=repeats,
        workers=workers,
        scheduler=scheduler,
        output=output,
    )


@app.command("reproduce")
def _reproduce(
    study: Annotated[
        str | None,
        typer.Argument(metavar="STUDY", help="an installed study, such as huang2019; by default the only one"),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="DIR", help="folder for the report, figures, tables and runs; required"),
    ] = None,
    only: Annotated[
        list[str] | None,
        typer.Option(metavar="SECTION", help="a section of the study, such as cost; repeatable, or with commas"),
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="coarse and short, ten minutes on two cores")] = False,
    reference: Annotated[Path | None, typer.Option(metavar="DIR", help="folder of reference series")] = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
) -> None:
    """Carry out a study: all its runs, and a report with every figure, every table and a verdict on each claim.

    Without STUDY and with several studies installed, the command lists them.
    """
    from sphframe.cli.reproduce import reproduce_command

    reproduce_command(
        study, only=only or [], quick=quick, reference=reference, workers=workers, scheduler=scheduler, output=output
    )


@app.command("rank")
def _rank(
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="DIR", help="folder for the pages, tables and runs")
    ] = Path("league"),
    methods: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME", help="an interpolator or wall treatment; repeatable, or with commas; default: all"
        ),
    ] = None,
    cases: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME", help="a benchmark, such as drum-rotation; repeatable, or with commas; default: all"
        ),
    ] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="the coarsest resolution of each benchmark alone, once")
    ] = False,
    repeats: Annotated[
        int | None, typer.Option(metavar="N", help="runs with displaced particles; default: 3, with --quick 1")
    ] = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
) -> None:
    """Run every installed method on every benchmark: errors, ranks, orders and costs on pages that can be sorted."""
    from sphframe.cli.rank import rank_command

    rank_command(
        output=output,
        methods=methods or [],
        benchmarks=cases or [],
        quick=quick,
        repeats=repeats,
        workers=workers,
        scheduler=scheduler,
    )


@app.command("plot")
def _plot(
    file: OutputFile,
    field: DrawnField = "pressure",
    times: Annotated[
        list[float] | None,
        typer.Option("--time", parser=seconds, metavar="SECONDS", help="repeatable; by default four times"),
    ] = None,
    references: Annotated[
        list[Path] | None,
        typer.Option("--reference", metavar="PATH", help="a .csv of p/(rho g H) over t sqrt(g/H), or a folder of them"),
    ] = None,
    surface: Annotated[
        bool, typer.Option("--surface", help="draw the free surface; with --oblique it replaces the particles")
    ] = False,
    oblique: Oblique = False,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help=".png, .pdf or .svg; by default FILE.png")
    ] = None,
) -> None:
    """Draw a run: particles at several times, probes with reference series, energies."""
    from sphframe.cli.plot import plot_command

    plot_command(
        file, field=field, times=times or [], references=references or [], surface=surface, oblique=oblique,
        output=output,
    )  # fmt: skip


@app.command("animate")
def _animate(
    file: OutputFile,
    field: DrawnField = "pressure",
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILM", help=".mp4 or .gif; by default FILE.mp4")
    ] = None,
    speed: Annotated[
        float, typer.Option(metavar="FACTOR", help="how many times as fast as in reality the film plays")
    ] = 1.0,
    frames_per_second: Annotated[
        float | None, typer.Option("--fps", metavar="N", help="play all frames at this rate, in place of --speed")
    ] = None,
    oblique: Oblique = False,
    surface: Annotated[
        bool, typer.Option("--surface", help="with --oblique: show the surface of the water in place of particles")
    ] = False,
) -> None:
    """Write a film of a run, in real time."""
    from sphframe.cli.animate import animate_command

    animate_command(
        file, field=field, output=output, speed=speed, frames_per_second=frames_per_second, oblique=oblique,
        surface=surface,
    )  # fmt: skip


@app.command("export")
def _export(
    file: OutputFile,
    to: Annotated[str, typer.Option(metavar="FORMAT", help="pvd, vtkhdf, csv or zarr")] = "pvd",
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FOLDER", help="by default FILE-FORMAT")
    ] = None,
    surface: Annotated[
        bool, typer.Option("--surface", help="for ParaView: add the surface of the water of a run in 3-D, as triangles")
    ] = False,
) -> None:
    """Write a run for ParaView with walls and ghosts, its sampled series as a table, or all of it as Zarr."""
    from sphframe.cli.export import export_command

    export_command(file, to=to, output=output, surface=surface)


@app.command("watch")
def _watch(
    file: OutputFile,
    field: DrawnField = "pressure",
    port: Annotated[
        int, typer.Option(min=0, max=65535, metavar="N", help="port of the page on this machine; 0 for any free one")
    ] = 8765,
    open_browser: Annotated[bool, typer.Option("--open/--no-open", help="open the page in your browser")] = True,
) -> None:
    """Show the newest frame and the probes of a run on a page that refreshes itself."""
    from sphframe.cli.watch import watch_command

    watch_command(file, field=field, port=port, open_browser=open_browser)


@app.command("list")
def _list(
    kind: Annotated[
        str | None, typer.Argument(metavar="KIND", help="interpolators, kernels, cases, ...; all by default")
    ] = None,
) -> None:
    """List what is installed, without loading it."""
    from sphframe.cli.list import list_command

    list_command(kind)


@app.command("show")
def _show(
    name: Annotated[str, typer.Argument(metavar="NAME", help="a case, a case file, an output file, or any component")],
    preset: Preset = None,
    walls: Annotated[bool, typer.Option("--walls", help="draw a case's walls, ghosts and how they are filled")] = False,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="picture; by default NAME-walls.png")] = None,
) -> None:
    """Show a case's parameters, units, defaults and presets, a component's options, or draw a case's walls."""
    if walls:
        from sphframe.cli.show_walls import show_walls_command

        show_walls_command(name, preset, output)
    else:
        from sphframe.cli.show import show_command

        show_command(name, preset)


@app.command("verify")
def _verify(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="NAME...", help="by default interpolators wall_treatments")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="print JSON instead of tables")] = False,
    as_markdown: Annotated[bool, typer.Option("--markdown", help="print tables in Markdown")] = False,
    order: Annotated[bool, typer.Option("--order", help="measure orders of convergence near walls instead")] = False,
    junit: Annotated[Path | None, typer.Option(metavar="FILE", help="also write JUnit XML")] = None,
) -> None:
    """Test interpolation methods, wall treatments and other components against their declared traits."""
    from sphframe.cli.verify import verify_command

    verify_command(names or [], as_json=as_json, as_markdown=as_markdown, order=order, junit=junit)


@app.command("evaluate")
def _evaluate(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help=".nc of a run; .vtk or .vtu of other programs; .hdf5 of PySPH")
    ],
    methods: Annotated[
        list[str] | None,
        typer.Option("--method", metavar="NAME", help="interpolation method; repeatable; by default all"),
    ] = None,
    kernel: Annotated[str, typer.Option(metavar="NAME", help="kernel")] = "gaussian",
    smoothing_length: Annotated[
        float | None, typer.Option(metavar="METRES", help="h; by default that of the file, or 1.3 spacings")
    ] = None,
    spacing: Annotated[
        float | None, typer.Option(metavar="METRES", help="particle spacing; by default from the file")
    ] = None,
    time: Annotated[float | None, typer.Option(metavar="SECONDS", help="frame of a run; by default the last")] = None,
    array: Annotated[str | None, typer.Option(metavar="NAME", help="particle array of a file of PySPH")] = None,
    fields: Annotated[
        list[str] | None, typer.Option("--field", metavar="KIND=NAME", help="such as pressure=Press; repeatable")
    ] = None,
    walls: Annotated[
        str | None, typer.Option(metavar="NAME", help="wall particles: array of a file of PySPH, or another file")
    ] = None,
    gravity: Annotated[
        float | None, typer.Option(metavar="M/S2", help="downwards, for walls; by default that of the run, or 0")
    ] = None,
    sample: Annotated[int, typer.Option(min=1, metavar="N", help="number of particles that are left out")] = 2000,
    as_json: Annotated[bool, typer.Option("--json", help="print JSON instead of a table")] = False,
) -> None:
    """Judge interpolation methods on the particles of a file: error, noise, weights and statuses."""
    from sphframe.cli.evaluate import evaluate_command
    from sphframe.cli.values import read_assignments
    from sphframe.registry import available

    evaluate_command(
        file,
        methods or [entry.name for entry in available("interpolators")],
        kernel=kernel,
        smoothing_length=smoothing_length,
        as_json=as_json,
        reading={"time": time, "spacing": spacing, "array": array, "fields": read_assignments(fields or [], {})},
        sample=sample,
        walls=walls,
        gravity=gravity,
    )


@app.command("new-plugin")
def _new_plugin(
    name: Annotated[str, typer.Argument(metavar="NAME", help="name of the component: lower-case words and hyphens")],
    kind: Annotated[
        str,
        typer.Option(
            metavar="KIND",
            help="interpolator, wall-treatment, kernel, equation-of-state, integrator, rigid-body or case",
        ),
    ] = "interpolator",
    part: Annotated[
        str | None,
        typer.Option(
            metavar="PART", help="of a wall treatment: seen (default), assign, force, rate or surface; see docs/walls"
        ),
    ] = None,
    folder: Annotated[Path, typer.Option(help="folder in which sphframe-NAME is made")] = Path(),
    licence: Annotated[str, typer.Option(help="BSD-3-Clause, MIT or none")] = "BSD-3-Clause",
    author: Annotated[str, typer.Option(help="named in pyproject.toml and in the licence")] = "",
) -> None:
    """Start a component of your own: a distribution that installs, verifies and runs."""
    from sphframe.cli.new_plugin import new_plugin_command

    new_plugin_command(name, kind=kind, part=part, folder=folder, licence=licence, author=author)


@app.command("bench")
def _bench(
    json_file: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="also write all results to this file")
    ] = None,
    particles: Annotated[
        list[str] | None,
        typer.Option(metavar="N", help="fluid particles; repeatable, or with commas; by default 45000"),
    ] = None,
    threads: Annotated[
        list[str] | None, typer.Option(metavar="N", help="threads; repeatable, or with commas; by default 1 and 2")
    ] = None,
    only: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SECTION",
            help="peak, rest, developed, 3d, developed-3d (minutes, only if asked for), methods, walls, memory or"
            " start-up; repeatable, or with commas",
        ),
    ] = None,
) -> None:
    """Measure speed, memory and start-up on this machine, beside bare reference loops (about four minutes)."""
    from sphframe.cli.bench import bench_command

    bench_command(particles=particles or [], threads=threads or [], only=only or [], json_file=json_file)


@app.command("doctor")
def _doctor() -> None:
    """Check this installation: versions, threads, compiler cache, plugins."""
    from sphframe.cli.doctor import doctor_command

    doctor_command()
