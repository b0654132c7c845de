"""``sphframe bench``: tables and JSON from the same measurements."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from sphframe.benchmark import bench as benchmark
from sphframe.benchmark.memory import MemoryCost
from sphframe.benchmark.methods import MethodCost
from sphframe.benchmark.peak import Peak
from sphframe.benchmark.report import BenchmarkReport
from sphframe.benchmark.start_up import StartUp
from sphframe.benchmark.timing import Spread
from sphframe.benchmark.walls import WallCost
from sphframe.cli import bench as command
from sphframe.cli.app import app


def test_tables_and_json_say_the_same(tmp_path: Path) -> None:
    file = tmp_path / "bench.json"
    arguments = ["bench", "--particles", "300", "--threads", "1", "--only", "rest", "--json", str(file)]
    result = CliRunner().invoke(app, arguments, env={"NO_COLOR": "1"})
    assert result.exit_code == 0, result.output
    (cost,) = json.loads(file.read_text())["steps"]
    row = next(line for line in result.stdout.splitlines() if line.startswith("2-D, rest"))
    assert f" {cost['particles']} " in row
    assert f" {1e3 * cost['whole']['median']:.3g} (" in row
    for text in ("median (lowest-highest)", "neighbour list", "evaluation / bare", "processor", "threading layer"):
        assert text in result.stdout
    assert "2-D, 300 particles, rest: measuring" in result.stderr
    assert str(file) in result.stdout


def test_every_table_is_printed(monkeypatch: pytest.MonkeyPatch) -> None:
    two = Spread((0.25, 0.75))
    whole = BenchmarkReport(
        {"processor": "abacus"},
        (300,),
        (1, 2),
        Peak(two, two),
        benchmark([300], [1], ["rest"], repeats=1).steps,
        [MethodCost("nearest", 2, 300, 10, 20.0, two, two, two.times(1e-6), two)],
        [WallCost("mirrors", 300, 50, two, two)],
        [MemoryCost(2, 300, 100, {"lists": 111.0, "system": 222.0}, 333.0, None)],
        StartUp(two, two, 12.5, two, two),
    )
    asked: list[tuple[object, ...]] = []

    def measured(particles, threads, only, tell):  # type: ignore[no-untyped-def]
        asked.append((particles, threads, only))
        tell("at work", 0.5)
        return whole

    monkeypatch.setattr(command, "bench", measured)
    result = CliRunner().invoke(app, ["bench", "--threads", "1", "--only", "rest,memory", "--only", "3d"])
    assert result.exit_code == 0, result.output
    assert asked == [([45_000], [1], ["rest", "memory", "3d"])]
    for text in ("abacus", "nearest", "mirrors", "0.5 (0.25-0.75)", "333", "unknown", "12.5", "import sphframe"):
        assert text in result.stdout
