"""CLI: ``sphframe bench``."""

import json
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.table import Table

from sphframe.benchmark import BenchmarkReport, bench, check_request
from sphframe.benchmark.stopwatch import PARTS
from sphframe.benchmark.timing import Spread
from sphframe.cli.run import console_log
from sphframe.errors import InputError, OutputError


def bench_command(
    *, particles: Sequence[str], threads: Sequence[str], only: Sequence[str], json_file: Path | None
) -> None:
    """Measure, print tables, and write JSON if a file is given."""
    counts = _whole_numbers("--particles", particles) or [45_000]
    parallel = _whole_numbers("--threads", threads)
    sections = [name for text in only for name in text.split(",") if name]
    check_request(counts, parallel, sections)
    if json_file is not None:
        _check_target(json_file)
    with _shown_progress() as tell:
        report = bench(counts, parallel, sections, tell=tell)
    console = Console(markup=False, highlight=False, soft_wrap=True, width=None if sys.stdout.isatty() else 240)
    for table in _tables(report):
        console.print(table, "")
    if json_file is not None:
        try:
            json_file.write_text(json.dumps(report.as_data(), indent=1) + "\n", encoding="utf-8")
        except OSError as error:
            raise OutputError(f"cannot write {json_file}: {error.strerror}; the tables above are complete") from error
        console.print(f"wrote {json_file}", markup=False)


def _whole_numbers(option: str, texts: Sequence[str]) -> list[int]:
    try:
        return [int(part) for text in texts for part in text.split(",")]
    except ValueError:
        raise InputError(f"{option} {','.join(texts)}: give whole numbers, such as {option} 1,2") from None


def _check_target(path: Path) -> None:
    if path.is_dir() or not path.parent.is_dir():
        raise InputError(f"--json {path}: give a file in a folder that exists")
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise InputError(f"--json {path}: it cannot be written; choose another place")


@contextmanager
def _shown_progress() -> Iterator[Callable[[str, float | None], None]]:
    """Show what is being measured: on a terminal continuously, elsewhere a line for each new measurement."""
    log = console_log()
    if log.is_terminal:
        with log.status("starting") as status:
            yield lambda text, part: status.update(text if part is None else f"{text} {100.0 * part:.0f}%")
        return
    shown = ""

    def tell(text: str, part: float | None) -> None:
        nonlocal shown
        if text != shown:
            shown = text
            log.print(text, markup=False)

    yield tell


def _tables(report: BenchmarkReport) -> Iterator[Table]:
    machine = Table(box=None, show_header=False, pad_edge=False)
    for name, value in report.machine.items():
        machine.add_row(name, value)
    if report.peak is not None:
        machine.add_row("multiply-adds of a thread, G/s", _text(report.peak.multiply_adds, 1e-9))
        machine.add_row("memory read by a thread, GB/s", _text(report.peak.bytes_read, 1e-9))
    yield machine
    if report.steps:
        yield _steps(report)
        yield _single_parts(report)
    if report.methods:
        yield _methods(report)
    if report.walls:
        yield _walls(report)
    if report.memory:
        yield _memory(report)
    if report.start_up is not None:
        yield _start_up(report)


def _steps(report: BenchmarkReport) -> Table:
    parts = (*PARTS, "output")
    table = _table(
        "Dam break: median (lowest-highest) of a step with its share of lists and output;"
        " M/s: fluid-particle right-hand sides, millions per second; the parts in %",
        *("flow", "particles", "threads", "step, ms", "M/s", "speed-up", *parts),
    )
    for cost in report.steps:
        key = (cost.dimension, cost.state, cost.particles)
        first = next(c for c in report.steps if (c.dimension, c.state, c.particles) == key)
        table.add_row(
            _flow(cost.dimension, cost.state), f"{cost.particles:,}", str(cost.threads), _text(cost.whole, 1e3),
            _text(cost.rate, 1e-6), "" if cost is first else _text(first.whole.over(cost.whole)),
            *(f"{100.0 * cost.parts[part].over(cost.whole).median:.1f}" for part in parts),
        )  # fmt: skip
    return table


def _single_parts(report: BenchmarkReport) -> Table:
    table = _table(
        "Single parts, ms: all rates once with their share of lists, and the bare reference loops, alternately",
        *("flow", "particles", "threads", "evaluation", "bare gradient", "bare rates", "evaluation / bare"),
        *("list build", "steps per list", "probe sample", "frame"),
    )
    for cost in report.steps:
        served = f"{cost.steps / cost.builds:.1f}" if cost.builds else f"over {cost.steps}"
        spreads = (cost.evaluation, cost.bare_gradient, cost.bare_rates)
        table.add_row(
            _flow(cost.dimension, cost.state), f"{cost.particles:,}", str(cost.threads),
            *("" if spread is None else _text(spread, 1e3) for spread in spreads),
            "" if cost.ratio is None else _text(cost.ratio),
            _text(cost.list_build, 1e3), served, _text(cost.sample, 1e3), _text(cost.frame, 1e3),
        )  # fmt: skip
    return table


def _methods(report: BenchmarkReport) -> Table:
    names = "method", "flow", "particles", "wet points", "neighbours", "us per point", "filling, ms", "step, ms"
    table = _table("Interpolation methods, dam break at rest, one thread, processor time", *names, "boundary, %")
    for cost in report.methods:
        table.add_row(
            cost.method, f"{cost.dimension}-D", f"{cost.particles:,}", f"{cost.points:,}", f"{cost.neighbours:.1f}",
            _text(cost.point, 1e6), _text(cost.fill, 1e3), _text(cost.step, 1e3), _text(cost.share, 100.0),
        )  # fmt: skip
    return table


def _walls(report: BenchmarkReport) -> Table:
    table = _table(
        "Wall treatments, developed dam break, all rates once, one thread, processor time",
        *("treatment", "particles", "wall particles", "rates, ms", "over fixed ghosts"),
    )
    for cost in report.walls:
        table.add_row(
            cost.treatment, f"{cost.particles:,}", f"{cost.wall_particles:,}", _text(cost.evaluation, 1e3),
            _text(cost.ratio),
        )  # fmt: skip
    return table


def _memory(report: BenchmarkReport) -> Table:
    names = list(report.memory[0].arrays)
    table = _table("Memory, bytes per particle", "dimension", "particles", *names, "all arrays", "resident growth")
    for cost in report.memory:
        resident = "unknown" if cost.resident is None else f"{cost.resident:.0f}"
        table.add_row(
            f"{cost.dimension}-D", f"{cost.particles:,}", *(f"{cost.arrays[name]:.0f}" for name in names),
            f"{cost.total:.0f}", resident,
        )  # fmt: skip
    return table


def _start_up(report: BenchmarkReport) -> Table:
    found = report.start_up
    assert found is not None
    table = _table("Start-up, s, fresh processes", "what", "time")
    table.add_row("import numpy, numba", _text(found.libraries))
    table.add_row("import sphframe, after them", _text(found.sphframe))
    table.add_row("first step of the dam break, nothing compiled", f"{found.first_compile:.3g}")
    table.add_row("first step of the dam break, cached", _text(found.cached))
    table.add_row("the same with start and end of Python", _text(found.cached_process))
    return table


def _table(title: str, *columns: str) -> Table:
    table = Table(title=title, title_justify="left", box=None, pad_edge=False)
    for k, column in enumerate(columns):
        table.add_column(column, justify="left" if k == 0 else "right")
    return table


def _text(spread: Spread, unit: float = 1.0) -> str:
    lowest, middle, highest = (f"{unit * x:.3g}" for x in (spread.minimum, spread.median, spread.maximum))
    return f"{middle} ({lowest}-{highest})"


def _flow(dimension: int, state: str) -> str:
    return f"{dimension}-D, {state}"
