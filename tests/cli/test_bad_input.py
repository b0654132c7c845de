"""Bad input over the command line: a message with the value and the remedy, exit code 2, no file changed."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from sphframe.cli.app import app

BAD: list[tuple[list[str], str]] = [
    (["run"], "Missing argument 'CASE'"),
    (["ran", "dam-break"], "No such command 'ran'"),
    (["run", "dam-brake"], "did you mean 'dam-break'"),
    (["run", "dam-break", "extra"], "unexpected extra argument"),
    (["run", "missing.toml"], "missing.toml: there is no such file"),
    (["run", "missing.nc"], "missing.nc: there is no such file"),
    (["run", "dam-break", "--colour", "blue"], "No such option: --colour"),
    (["run", "dam-break", "--preset"], "requires an argument"),
    (["run", "dam-break", "--preset", "papper"], "did you mean 'paper'"),
    (["run", "dam-break", "--set", "particle_spacing"], "give it as KEY=VALUE"),
    (["run", "dam-break", "--set", "=3"], "give it as KEY=VALUE"),
    (["run", "dam-break", "--set", "interpolator.=3"], "give it as KEY=VALUE"),
    (["run", "dam-break", "--set", "until=1", "--set", "until=2"], "until is given twice"),
    (["run", "dam-break", "--set", "until=1", "--until", "1"], "until is given twice"),
    (["run", "dam-break", "--set", "particle_spacing=1cm"], "give the number in m, without the unit"),
    (["run", "dam-break", "--set", "particle_spacing=nan"], "must be a finite number"),
    (["run", "dam-break", "--set", "particle_spacing="], "particle_spacing = ''"),
    (["run", "dam-break", "--set", "particle_spacing=0.4"], "more than a quarter of the water depth"),
    (["run", "dam-break", "--set", "spacing=0.01"], "did you mean 'particle_spacing'"),
    (["run", "dam-break", "--set", "interpolator.nu=2"], "no option 'nu'"),
    (["run", "dam-break", "--set", "interpolator.mu=-1"], "mu"),
    (["run", "dam-break", "--interpolator", "shepherd"], "did you mean 'shepard'"),
    (["run", "dam-break", "--interpolator", "gaussian"], "'gaussian' is a name among kernels"),
    (["run", "dam-break", "--interpolator", "nowhere:Method"], "nowhere"),
    (["run", "dam-break", "--until", "-1"], "until = -1 must be greater than 0 s"),
    (["run", "dam-break", "--until", "soon"], "until = 'soon' must be a valid number"),
    (["run", "dam-break", "--threads", "0"], "threads = 0"),
    (["run", "dam-break", "--threads", "100000"], "threads = 100000"),
    (["run", "dam-break", "--threads", "two"], "--threads"),
    (["run", "dam-break", "--output", "run.png"], "ending .nc"),
    (["run", "dam-break", "--output", "no/such/folder/run.nc"], "no/such/folder"),
    (["run", "dam-break", "--output", "kept.nc"], "--overwrite"),
    (["run", "dam-break", "--output", "picture.nc"], "picture.png exists; give --overwrite"),
    (["run", "kept.nc"], "kept.nc"),
    (["run", "broken.toml"], "not valid TOML"),
    (["run", "."], "there is no case '.'"),
    (["show", "dam-brake"], "did you mean 'dam-break'"),
    (["show", "missing.toml"], "there is no such file"),
    (["show", "dam-break", "--preset", "x"], "has no preset 'x'"),
    (["bench", "--particles", "many"], "--particles many: give whole numbers"),
    (["bench", "--particles", "3000,"], "give whole numbers"),
    (["bench", "--particles", "10"], "particles = 10: give at least 100"),
    (["bench", "--threads", "1,0"], "threads = 0"),
    (
        ["bench", "--only", "rest,speed"],
        "there is no section 'speed' to measure; the sections are peak, rest, developed, 3d",
    ),
    (["bench", "--json", "no/such/folder/bench.json"], "give a file in a folder that exists"),
    (["bench", "--json", "."], "give a file in a folder that exists"),
    (["list", "methods"], "'methods' is not a kind of component"),
    (["list", "kernel"], "did you mean 'kernels'"),
]


@pytest.mark.parametrize(
    ("arguments", "message"), BAD, ids=lambda value: " ".join(value) if isinstance(value, list) else ""
)
def test_bad_input_is_refused(
    arguments: list[str], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("kept.nc", "picture.png", "broken.toml"):
        (tmp_path / name).write_text("= not to be touched")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    result = CliRunner().invoke(app, arguments, env={"COLUMNS": "200", "NO_COLOR": "1", "TERM": "dumb"})

    assert result.exit_code == 2, result.output
    assert message in result.stderr
    assert "Traceback" not in result.output
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
