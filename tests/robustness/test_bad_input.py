"""Bad input by command line, case file and library: each has its own message with the value and the remedy."""

import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import sphframe
from sphframe.cases import load_case
from sphframe.cli.app import app
from sphframe.errors import SphframeError

pytestmark = pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")

TANK = """\
particle_spacing = 0.02
until = 0.5

[[walls]]
name = "tank"
shape = "polygon"
points = [[0, 0.5], [0, 0], [1, 0], [1.5, 0.5]]

[[fluid]]
shape = "polygon"
points = [[0, 0], [1, 0], [1.3, 0.3], [0, 0.3]]

[[probes]]
name = "toe"
position = [1, 0]

[[gauges]]
name = "G"
position = [0.5]
"""
SHAPE = "[[0, 0.5], [0, 0], [1, 0], [1.5, 0.5]]"

COMMANDS: list[tuple[str, list[str]]] = [
    ("run", ["CASE"]),
    ("run dam-break surplus", ["surplus"]),
    ("run dam-brake", ["dam-brake", "did you mean 'dam-break'"]),
    ("run nothing.toml", ["nothing.toml", "no such file"]),
    ("run nothing.nc", ["nothing.nc", "no such file"]),
    ("run kept.nc", ["kept.nc", "not a NetCDF file"]),
    ("run dam-break --output folder", ["folder", ".nc"]),
    ("run dam-break --output folder.nc", ["folder.nc is a folder", "name a file in it"]),
    ("run dam-break --output absent/run.nc", ["absent", "mkdir -p"]),
    ("run dam-break --output kept.nc", ["kept.nc exists", "--overwrite"]),
    ("run dam-break --output left.nc", ["left.nc.restart exists", "--overwrite"]),
    ("run dam-break --output waiting.nc", ["waiting.nc and waiting.nc.restart exist", "sphframe resume waiting.nc"]),
    ("run dam-break --output pictured.nc", ["pictured.png exists", "--overwrite"]),
    ("run dam-break --output run.h5", ["run.h5", ".nc"]),
    ("run dam-break --threads 0", ["threads = 0", "offers 1 to"]),
    ("run dam-break --threads -3", ["threads = -3", "offers 1 to"]),
    ("run dam-break --threads many", ["'many'", "whole number"]),
    ("run dam-break --checkpoint-every -1", ["every = -1", "positive"]),
    ("run dam-break --checkpoint-every nan", ["every = nan", "positive"]),
    ("run dam-break --checkpoint-interval 0", ["interval = 0", "positive"]),
    ("run dam-break --checkpoint-interval soon", ["'soon'", "a number of seconds"]),
    ("run dam-break --until 0", ["until = 0", "greater than 0"]),
    ("run dam-break --until tomorrow", ["until = 'tomorrow'", "number"]),
    ("run dam-break --preset papper", ["papper", "did you mean 'paper'"]),
    ("run dam-break --set particle_spacing", ["particle_spacing", "KEY=VALUE"]),
    ("run dam-break --set particle_spacing=5mm", ["5mm", "without the unit"]),
    ("run dam-break --set interpolator.nu=2", ["'nu'", "Its options"]),
    ("run dam-break --interpolator improved-shepherd", ["improved-shepherd", "did you mean 'improved-shepard'"]),
    ("resume nothing.nc", ["nothing.nc does not exist", "check the name"]),
    ("resume kept.nc", ["kept.nc is not a readable NetCDF file"]),
    ("resume folder.nc", ["folder.nc is not a file", "name the .nc file"]),
    ("resume", ["FILE"]),
    ("show hydrostatic-tonk", ["hydrostatic-tonk", "did you mean 'hydrostatic-tank'"]),
    ("list method", ["method", "The kinds"]),
    ("list kernel", ["did you mean 'kernels'"]),
    ("ran dam-break", ["No such command 'ran'"]),
    ("run dam-break --colour blue", ["No such option: --colour"]),
    ("run dam-break --preset", ["requires an argument"]),
    ("run dam-break --set =3", ["=3", "KEY=VALUE"]),
    ("run dam-break --set interpolator.=3", ["interpolator.=3", "KEY=VALUE"]),
    ("run dam-break --set until=1 --until 1", ["until is given twice"]),
    ("run dam-break --set particle_spacing=nan", ["must be a finite number"]),
    ("run dam-break --set particle_spacing=", ["particle_spacing = ''"]),
    ("run dam-break --set particle_spacing=0.4", ["more than a quarter of the water depth"]),
    ("run dam-break --set spacing=0.01", ["did you mean 'particle_spacing'"]),
    ("run dam-break --set interpolator.mu=-1", ["mu"]),
    ("run dam-break --interpolator gaussian", ["'gaussian' is a name among kernels"]),
    ("run dam-break --interpolator nowhere:Method", ["nowhere"]),
    ("run dam-break --threads 100000", ["threads = 100000"]),
    ("run broken.toml", ["not valid TOML"]),
    ("run .", ["there is no case '.'"]),
    ("show missing.toml", ["there is no such file"]),
    ("show dam-break --preset x", ["has no preset 'x'"]),
    ("bench --particles many", ["--particles many: give whole numbers"]),
    ("bench --particles 3000,", ["give whole numbers"]),
    ("bench --particles 10", ["particles = 10: give at least 100"]),
    ("bench --threads 1,0", ["threads = 0"]),
    ("bench --only rest,speed", ["no section 'speed' to measure; the sections are peak, rest, developed, 3d"]),
    ("bench --json absent/bench.json", ["give a file in a folder that exists"]),
    ("bench --json .", ["give a file in a folder that exists"]),
]

PARAMETERS: list[tuple[str, dict[str, Any], list[str]]] = [
    ("dam-break", {"particle_spacing": 0}, ["particle_spacing = 0", "greater than 0 m"]),
    ("dam-break", {"particle_spacing": -0.5}, ["particle_spacing = -0.5", "greater than 0 m"]),
    ("dam-break", {"particle_spacing": math.nan}, ["particle_spacing = nan", "finite"]),
    ("dam-break", {"particle_spacing": math.inf}, ["particle_spacing = inf", "finite"]),
    ("dam-break", {"particle_spacing": True}, ["particle_spacing = True", "must be a number"]),
    ("dam-break", {"particle_spacing": 5.0}, ["particle_spacing = 5 m", "choose"]),
    ("dam-break", {"particle_spacing": 1e-7}, ["particle_spacing = 1e-07 m", "choose a larger spacing"]),
    ("dam-break", {"spacing": 0.01}, ["spacing", "did you mean 'particle_spacing'"]),
    ("dam-break", {"dimension": 1}, ["dimension = 1", "2 or 3"]),
    ("dam-break", {"gravity": -9.81}, ["gravity = -9.81", "greater than or equal to 0"]),
    ("dam-break", {"gravity": 0.0}, ["gravity = 0", "give sound_speed"]),
    ("dam-break", {"sound_speed": 1e300}, ["sound speed 1e+300", "more than 1e+10 steps"]),
    ("dam-break", {"time_step": 1e9}, ["time_step = 1e+09 s is above until", "stability limit 2.33"]),
    ("dam-break", {"courant_number": 24.0}, ["courant_number = 24 gives c0 dt/h = 24, above the stability limit"]),
    ("dam-break", {"time_step": 1e-300}, ["time_step = 1e-300", "choose a time step of"]),
    ("dam-break", {"courant_number": 1e-200}, ["courant_number = 1e-200", "choose a time step of"]),
    ("dam-break", {"time_step": "fast"}, ["time_step = 'fast'", "without the unit"]),
    ("dam-break", {"smoothing_length_ratio": 9}, ["smoothing_length_ratio = 9", "less than or equal to 3"]),
    ("dam-break", {"slip": "partial"}, ["slip = 'partial'", "'free' or 'no'"]),
    ("dam-break", {"frame_interval": 1e-12}, ["frame_interval = 1e-12 s", "choose"]),
    ("dam-break", {"probe_interval": 1e-15}, ["probe_interval = 1e-15 s", "choose"]),
    ("dam-break", {"water_length": 7.0}, ["wall 'tank'", "draw the fluid within the walls"]),
    ("dam-break", {"tank_height": 0.1}, ["0.1 m", "raise the walls"]),
    ("dam-break", {"tank_length": 1e9}, ["1000000000.01", "smaller walls"]),
    ("dam-break", {"kernel": "gausian"}, ["gausian", "did you mean 'gaussian'"]),
    ("dam-break", {"kernel": "symplectic"}, ["symplectic", "a name among integrators"]),
    ("dam-break", {"integrator": 7}, ["integrator = 7"]),
    ("dam-break", {"equation_of_state": {"name": "tait", "gamma": -1}}, ["gamma", "-1", "at least 1"]),
    ("dam-break", {"interpolator": {"name": "improved-shepard", "mu": math.inf}}, ["mu = inf", "finite"]),
    ("dam-break", {"interpolator": "no.such.module:Method"}, ["no.such.module:Method", "check its spelling"]),
    ("dam-break", {"guards": {"domain": "ignore"}}, ["guards.domain = 'ignore'", "'stop' or 'remove'"]),
    ("dam-break", {"guards": {"density_band": (1.2, 1.5)}}, ["(1.2, 1.5)", "must hold 1"]),
    ("dam-break", {"guards": {"densities": "stop"}}, ["guards.densities", "leave it out"]),
    ("dam-break", {"guards": {"fallback_limit": 7}}, ["guards.fallback_limit = 7", "less than or equal to 1"]),
    ("dam-break", {"output": "absent/run.nc"}, ["absent", "create it"]),
    ("dam-break", {"output": "kept.nc"}, ["kept.nc exists", "overwrite=True"]),
    ("dam-break", {"checkpoint_every": 0.0}, ["every = 0 s", "positive"]),
    ("dam-break", {"checkpoint_interval": math.inf}, ["interval = inf s", "positive"]),
    ("dam-break", {"threads": 10**6}, ["threads = 1000000", "offers 1 to"]),
    ("dam-break", {"preset": "fast"}, ["'fast'", "its presets: paper"]),
    ("nothing", {}, ["there is no case 'nothing'", "installed:"]),
    ("kept.nc", {}, ["kept.nc", "not a NetCDF file"]),
]

FILES: list[tuple[str, list[str]]] = [
    ("particle_spacing = ", ["not valid TOML"]),
    (TANK.replace("until = 0.5", "until = 0.5\nuntil = 1"), ["not valid TOML", "overwrite"]),
    (TANK.replace("until = 0.5", ""), ["until is missing", "give it a value"]),
    (TANK.replace("0.02", '"2 cm"'), ["particle_spacing = '2 cm'", "without the unit"]),
    (TANK.replace("until", "untill"), ["untill is not a parameter", "did you mean 'until'"]),
    ('case = "dambreak"', ["there is no case 'dambreak'", "did you mean 'dam-break'"]),
    ('case = ["dam-break"]', ["case = ['dam-break']", "must be a text"]),
    ('case = "dam-break"\npreset = "papier"', ["'papier'", "did you mean 'paper'"]),
    ('case = "os:system"', ["'os:system'", "is the address of code"]),
    ('case = "dam-break"\ninterpolator = "evil:Method"', ["'evil:Method'", "--set interpolator=evil:Method"]),
    (TANK + '[bodies.b]\nname = "evil:Body"', ["bodies.b = 'evil:Body'", "is the address of code"]),
    (TANK + '[bodies.b]\nname = "rocket"', ["'rocket'", "installed:"]),
    (TANK + '[bodies.b]\nname = "spring-mass"', ["needs 'mass'", "Its options"]),
    (TANK + '[bodies.b]\nname = "prescribed"\nfunction = "os.system"', ["function = 'os.system'", "callable"]),
    (TANK.replace('shape = "polygon"', 'shape = "potato"', 1), ["walls[0]", "'polygon'"]),
    (TANK.replace(SHAPE, "[[0, 0]]"), ["walls[0].points = [[0, 0]]", "2 or more entries"]),
    (TANK.replace(SHAPE, SHAPE[:-1] + ', ["a", 1]]'), ["walls[0].points[4][0] = 'a'", "number"]),
    (
        TANK + '[[walls]]\nname = "plate"\nshape = "polygon"\npoints = [[0.5, 0], [0.5, 0.5]]',
        ["wall 'plate'", "runs through the fluid", "(0.5, "],
    ),
    (TANK.replace("[1.5, 0.5]", "[1e9, 0.5]"), ["1000000000.02", "draw smaller walls"]),
    ("dimension = 3\n" + TANK, ["wall 'tank' has 2 coordinates", "needs 3"]),
    (TANK.replace("position = [1, 0]", "position = [7, 7]"), ["probe 'toe' at (7.0, 7.0)", "move it to a wall"]),
    (TANK.replace("position = [0.5]", "position = [0.5, 0.5, 1]"), ["gauges[0].position", "2 or fewer"]),
    (
        TANK + '[[probes]]\nname = "toe"\nposition = [0, 0]',
        ["2 probes are called 'toe'", "each needs a different name"],
    ),
    (TANK.replace('name = "tank"', 'name = "tank"\nbody = "ship"'), ["body 'ship'", "bodies: none"]),
    ("domain = [[1, 1], [0, 0]]\n" + TANK, ["domain", "lower one"]),
    (TANK + "[guards]\ndomain = 'forget'", ["guards.domain = 'forget'", "'stop' or 'remove'"]),
    (TANK + "[guards]\ndensity_band = [0.9]", ["guards.density_band"]),
]


@pytest.fixture
def folder(here: Path) -> Path:
    """A folder with files and folders that must not be changed."""
    for name in ("kept.nc", "left.nc.restart", "waiting.nc", "waiting.nc.restart", "pictured.png", "broken.toml"):
        (here / name).write_text("= not to be touched")
    (here / "folder.nc").mkdir()
    return here


def snapshot(folder: Path) -> dict[str, bytes]:
    """The content of a folder."""
    return {str(path): path.read_bytes() if path.is_file() else b"folder" for path in folder.rglob("*")}


MESSAGES: dict[str, tuple[object, ...]] = {}
"""each message with the row of the tables that caused it"""


def own(message: str, *row: object) -> None:
    """Check that no other row has caused this message."""
    assert MESSAGES.setdefault(message, row) == row


def check_refused(arguments: list[str], fragments: list[str], folder: Path) -> str:
    """Check that the command prints all ``fragments``, exits with 2, shows no traceback and changes no file."""
    before = snapshot(folder)
    result = CliRunner().invoke(app, arguments, env={"COLUMNS": "400", "NO_COLOR": "1", "TERM": "dumb"})
    assert result.exit_code == 2, result.output
    for fragment in fragments:
        assert fragment in result.stderr
    assert "Traceback" not in result.output
    assert snapshot(folder) == before
    return result.stderr


@pytest.mark.parametrize(("command", "fragments"), COMMANDS, ids=[command for command, _ in COMMANDS])
def test_over_the_command_line(command: str, fragments: list[str], folder: Path) -> None:
    own(check_refused(command.split(), fragments, folder), command)


@pytest.mark.parametrize(("case", "parameters", "fragments"), PARAMETERS, ids=[str(row[:2]) for row in PARAMETERS])
def test_over_the_library(case: str, parameters: dict[str, Any], fragments: list[str], folder: Path) -> None:
    before = snapshot(folder)
    with pytest.raises(SphframeError) as caught:
        sphframe.run(case, **{"output": folder / "run.nc", **parameters})
    for fragment in fragments:
        assert fragment in str(caught.value)
    own(str(caught.value), case, str(parameters))
    assert caught.value.exit_code == 2
    assert snapshot(folder) == before


@pytest.mark.parametrize(("text", "fragments"), FILES, ids=[fragments[0] for _, fragments in FILES])
def test_over_case_files(text: str, fragments: list[str], folder: Path) -> None:
    (folder / "case.toml").write_text(text)
    own(check_refused(["run", "case.toml"], fragments, folder), text)


def test_the_tables_are_long() -> None:
    assert len(COMMANDS) + len(PARAMETERS) + len(FILES) >= 60


def test_a_good_file_is_not_refused(folder: Path) -> None:
    (folder / "case.toml").write_text(TANK)
    assert load_case("case.toml").particle_spacing == 0.02


values = st.one_of(
    st.sampled_from(
        ["", "-1", "0", "nan", "inf", "1e308", "1e-308", "true", '"x"', "[]", "{}", "[[]]", "[[0, 0]]", "'a:b'",
         "99999999999999999999999", "[nan, nan]", "0x10", "1979-05-27", '"""']
    ),
    st.integers().map(str),
    st.floats().map(repr),
)  # fmt: skip


@st.composite
def broken_case_files(draw: st.DrawFn) -> str:
    """A valid case file with characters or lines removed, inserted, doubled or swapped, and values replaced."""
    lines = TANK.splitlines()
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, len(lines) - 1))
        change = draw(st.sampled_from(["value", "lose", "double", "swap", "cut", "insert", "guard"]))
        if change == "value" and "=" in lines[at]:
            lines[at] = f"{lines[at].partition('=')[0]}= {draw(values)}"
        elif change == "lose" and len(lines) > 1:
            del lines[at]
        elif change == "double":
            lines.insert(at, lines[at])
        elif change == "swap":
            lines[at], lines[0] = lines[0], lines[at]
        elif change == "cut":
            lines[at] = lines[at][: draw(st.integers(0, len(lines[at])))]
        elif change == "insert":
            cut = draw(st.integers(0, len(lines[at])))
            lines[at] = lines[at][:cut] + draw(st.text(max_size=3)) + lines[at][cut:]
        else:
            key = draw(
                st.sampled_from(["gravity", "sound_speed", "time_step", "depth", "domain", "interpolator", "guards"])
            )
            lines.insert(0, f"{key} = {draw(values)}")
    return "\n".join(lines)


@settings(deadline=None, max_examples=120, suppress_health_check=list(HealthCheck))
@given(text=broken_case_files())
def test_a_broken_case_file_is_a_case_or_an_error_with_a_message(tmp_path: Path, text: str) -> None:
    path = tmp_path / "case.toml"
    path.write_text(text, encoding="utf-8", errors="replace")
    try:
        load_case(path)
    except SphframeError:
        result = CliRunner().invoke(app, ["run", str(path), "--output", str(tmp_path / "run.nc")])
        assert result.exit_code == 2, result.output
        assert result.stderr
        assert "Traceback" not in result.output
    assert [file.name for file in tmp_path.iterdir()] == ["case.toml"]
