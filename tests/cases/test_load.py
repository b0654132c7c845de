"""Cases from names, files, presets and overrides."""

import contextlib
import json
import os
from pathlib import Path
from typing import Any

import netCDF4
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sphframe.cases import CaseWarning, Component, Custom, load_case, read_toml
from sphframe.cases.dam_break import DamBreak
from sphframe.cases.hydrostatic_tank import HydrostaticTank
from sphframe.errors import InputError, PluginError, SphframeError

TANK = """
particle_spacing = 0.02
until = 0.5
interpolator = "normalized"

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


def written(folder: Path, text: str) -> Path:
    path = folder / "case.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_name_preset_and_overrides_in_this_order() -> None:
    case = load_case("hydrostatic-tank", "paper", {"until": 1.0, "interpolator": "normalized"})
    assert isinstance(case, HydrostaticTank)
    assert (case.time_step, case.until, case.interpolator.name) == (1e-4, 1.0, "normalized")


def test_dotted_override_sets_an_option_of_the_chosen_component() -> None:
    by_default = load_case("dam-break", overrides={"interpolator.mu": 2.0})
    assert by_default.interpolator.model_dump() == {"name": "improved-shepard", "mu": 2.0}
    chosen = load_case("dam-break", overrides={"interpolator.form": "printed", "interpolator": "sfdi"})
    assert chosen.interpolator.model_dump() == {"name": "sfdi", "form": "printed"}


def test_a_component_is_a_name_a_table_or_an_object() -> None:
    table = {"name": "sfdi", "form": "printed"}
    for component in (table, Component(name="sfdi", options={"form": "printed"}), Component.model_validate(table)):
        assert load_case("dam-break", overrides={"interpolator": component}).interpolator.options == {"form": "printed"}
    assert load_case("dam-break", overrides={"interpolator": "sfdi"}).interpolator == Component(name="sfdi")


def test_custom_case_from_toml(tmp_path: Path) -> None:
    case = load_case(written(tmp_path, TANK))
    assert isinstance(case, Custom)
    scene = case.scene()
    assert scene.depth == pytest.approx(0.3)
    assert case.frame_interval == pytest.approx(0.005)
    assert [probe.name for probe in scene.probes] == ["toe"]
    assert load_case(written(tmp_path, TANK), overrides={"particle_spacing": 0.025}).particle_spacing == 0.025


def test_toml_names_a_case_and_a_preset(tmp_path: Path) -> None:
    path = written(tmp_path, 'case = "dam-break"\npreset = "paper"\nuntil = 0.5\n[interpolator]\nname = "sfdi"\n')
    case = load_case(path)
    assert isinstance(case, DamBreak)
    assert (case.particle_spacing, case.until, case.interpolator.name) == (0.004, 0.5, "sfdi")


def test_an_output_file_repeats_its_case(tmp_path: Path) -> None:
    original = load_case("dam-break", overrides={"particle_spacing": 0.02, "interpolator.mu": 2.0})
    path = tmp_path / "run.nc"
    with netCDF4.Dataset(path, "w", format="NETCDF3_64BIT_DATA") as dataset:
        dataset.case_name = "dam-break"
        dataset.case_parameters = original.model_dump_json()
    assert load_case(path) == original
    assert load_case(path, overrides={"until": 0.1}).until == 0.1


def test_a_case_is_taken_as_it_is_or_changed() -> None:
    case = DamBreak(water_height=0.5)
    assert load_case(case) == case
    assert load_case(case, overrides={"water_height": 0.4}).water_length == pytest.approx(0.8)


def test_a_case_cannot_be_changed_in_place() -> None:
    case: Any = DamBreak()
    with pytest.raises(ValueError, match="frozen"):
        case.until = 1.0


def test_round_trip_through_json(tmp_path: Path) -> None:
    case = load_case(written(tmp_path, TANK))
    assert Custom(**json.loads(case.model_dump_json())) == case


BAD_PARAMETERS: list[tuple[str, dict[str, Any], str]] = [
    ("dam-break", {"particle_spacing": 0.0}, "particle_spacing = 0.0 must be greater than 0 m"),
    ("dam-break", {"particle_spacing": -0.01}, "particle_spacing = -0.01 must be greater than 0 m"),
    ("dam-break", {"particle_spacing": "1cm"}, "give the number in m, without the unit"),
    ("dam-break", {"particle_spacing": True}, "must be a number"),
    ("dam-break", {"particle_spacing": float("nan")}, "particle_spacing = nan must be a finite number"),
    ("dam-break", {"particle_spacing": float("inf")}, "must be a finite number"),
    ("dam-break", {"particle_spacing": None}, "particle_spacing = None must be a valid number"),
    ("dam-break", {"particle_spacing": [0.01]}, "must be a valid number"),
    ("dam-break", {"particle_spacing": 0.3}, "more than a quarter of the water depth"),
    ("dam-break", {"particle_spacing": 1e-6}, "particle_spacing = 1e-06 m would need .* particles; choose a larger"),
    ("dam-break", {"partcle_spacing": 0.01}, "did you mean 'particle_spacing'"),
    ("dam-break", {"zzz": 1}, "zzz is not a parameter"),
    ("dam-break", {"dimension": 4}, "dimension = 4 must be 2 or 3"),
    ("dam-break", {"dimension": "2D"}, "dimension = '2D' must be 2 or 3"),
    ("dam-break", {"gravity": -9.81}, "gravity = -9.81 must be greater than or equal to 0"),
    ("dam-break", {"gravity": 0}, "gravity = 0 gives no default sound speed"),
    ("dam-break", {"slip": "half"}, "slip = 'half' must be 'free' or 'no'"),
    ("dam-break", {"hydrostatic_lift": 2}, "hydrostatic_lift = 2 must be 'balanced' or 'mirror'"),
    ("dam-break", {"smoothing_length_ratio": 0.5}, "smoothing_length_ratio = 0.5 must be greater than or equal to 1"),
    ("dam-break", {"smoothing_length_ratio": 30}, "must be less than or equal to 3"),
    ("dam-break", {"until": 0}, "until = 0 must be greater than 0 s"),
    ("dam-break", {"frame_interval": 1e-9}, "outputs; choose"),
    ("dam-break", {"probe_interval": 1e-12}, "outputs; choose"),
    ("dam-break", {"water_length": 5.0}, "wall 'tank' runs through the fluid"),
    ("dam-break", {"interpolator": "improved-shepherd"}, "did you mean 'improved-shepard'"),
    ("dam-break", {"interpolator": 3}, "interpolator = 3"),
    ("dam-break", {"interpolator": {"mu": 2}}, "interpolator.name is missing"),
    ("dam-break", {"interpolator.mu": "many"}, "mu"),
    ("dam-break", {"interpolator.nu": 2}, "no option 'nu'"),
    ("dam-break", {"interpolator.mu.x": 2}, "mu"),
    ("dam-break", {"kernel": "gausian"}, "did you mean 'gaussian'"),
    ("dam-break", {"kernel.width": 2}, "no option 'width'"),
    ("dam-break", {"equation_of_state": {"name": "tait", "gamma": 0.5}}, "at least 1"),
    ("dam-break", {"equation_of_state.gamma": 7}, "no option 'gamma'"),
    ("dam-break", {"integrator": "euler"}, "there is no integrator 'euler'"),
    ("dam-break", {"until.x": 1}, "nothing can be set inside until"),
    ("dam-break", {"interpolater.mu": 1}, "did you mean 'interpolator'"),
    ("hydrostatic-tank", {"water_height": 1}, "water_height is not a parameter"),
    ("hydrostatic-tank", {"tank_height": 0.2}, "fluid.0. reaches 0.295 m, above the rim of the walls at 0.2 m"),
    ("custom", {}, "walls is missing"),
    ("dam-brake", {}, "did you mean 'dam-break'"),
    ("", {}, "there is no case ''"),
]


@pytest.mark.parametrize(("source", "overrides", "message"), BAD_PARAMETERS, ids=str)
def test_bad_parameters_are_refused_with_a_remedy(source: str, overrides: dict[str, Any], message: str) -> None:
    with pytest.raises((InputError, PluginError), match=message):
        load_case(source, None, overrides)


BAD_FILES: list[tuple[str, str]] = [
    ("particle_spacing = ", "not valid TOML"),
    ("[[[", "not valid TOML"),
    ("a = 1\na = 2", "not valid TOML"),
    ("case = 3", "case = 3 must be a text"),
    ('case = "dam-break"\npreset = ["paper"]', "must be a text"),
    ('case = "dam-break"\npreset = "papper"', "did you mean 'paper'"),
    ('case = "nothing"', "there is no case 'nothing'"),
    ('case = "dam-break"\nuntil = 1979-05-27', "until = .*number"),
    ("x = " + "[" * 5000 + "]" * 5000, "nested too deeply|not valid TOML"),
    (TANK.replace("shape =", "form =", 1), r"walls\[0\] has no known shape; give it shape = 'polygon' or 'box'"),
    (TANK.replace('shape = "polygon"', 'shape = "potato"', 1), r"walls\[0\] has no known shape"),
    (
        TANK.replace("position = [1, 0]", "position = [1, 0, 0]"),
        r"position of probe 'toe' has 3 coordinates, but dimension = 2 needs 2",
    ),
    (TANK.replace("position = [0.5]", "position = [0.5, 0.2]"), "position of gauge 'G' has 2 coordinates"),
    ("dimension = 3" + TANK, "wall 'tank' has 2 coordinates, but dimension = 3 needs 3"),
    (TANK + '[[probes]]\nname = "toe"\nposition = [0, 0]', "2 probes are called 'toe'"),
    (TANK + '[[probes]]\nname = "far"\nposition = [9, 0]', "lies outside the domain"),
    (TANK + '[[probes]]\nname = "disc"\nposition = [0, 0]\nradius = 0.1', "give its tangent"),
    (TANK + '[[probes]]\nname = ""\nposition = [0, 0]', r"probes\[1\].name = ''"),
    (TANK + '[[probes]]\nnaem = "x"\nposition = [0, 0]', r"probes\[1\].naem = 'x' is not known here"),
    (TANK.replace('name = "tank"', 'name = "tank"\nbody = "paddle"'), "body 'paddle', which is not given"),
    (TANK + "[bodies.paddle]\nname = 'rocket'", "there is no rigid body 'rocket'"),
    (TANK.replace("[1.5, 0.5]", '["far", 0.5]'), r"walls\[0\].points\[3\]\[0\] = 'far' must be a valid number"),
    (
        TANK.replace("points = [[0, 0], [1, 0], [1.3, 0.3], [0, 0.3]]", "points = [[0, 0], [1, 0]]"),
        r"fluid\[0\].points",
    ),
    (TANK.replace("[1.5, 0.5]", "[1.5]"), r"walls\[0\].points\[3\]\[1\] is missing"),
    (TANK.replace("[1.5, 0.5]", "[1, 2, 3]"), r"walls\[0\].points\[3\] = \[1, 2, 3\] must have 2 or fewer entries"),
    (TANK.replace("[1.3, 0.3], [0, 0.3]]", "]"), r"fluid\[0\].points = .* must have 3 or more entries"),
    ("gravity = 1.34e154\n" + TANK, "more than 1e.10 steps"),
    (TANK.replace("particle_spacing = 0.02", "particle_spacing = 1e152"), "more than a quarter of the water depth"),
    (TANK.replace("until = 0.5", "until = 5e-324"), "until = 4.94066e-324 s is too short for any frame_interval"),
    ("walls = []\nfluid = []\nparticle_spacing = 0.1\nuntil = 1", "fluid = .* must have 1 or more entries"),
    ('case = "os:PathLike"', "is the address of code"),
    (
        'case = "dam-break"\ninterpolator = "my.module:Method"',
        "give it on the command line: --set interpolator=my.module:Method",
    ),
    ('case = "dam-break"\n[kernel]\nname = "my_module:Kernel"', "is the address of code"),
    (TANK + "[bodies.paddle]\nname = 'my_module:Body'", "bodies.paddle = 'my_module:Body' is the address"),
    (TANK.replace("until = 0.5", ""), "until is missing; give it a value: time at which the run ends"),
]


@pytest.mark.parametrize(("text", "message"), BAD_FILES, ids=lambda value: value[-40:])
def test_bad_case_files_are_refused_with_a_remedy(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises((InputError, PluginError), match=message):
        load_case(written(tmp_path, text))


def test_several_wrong_parameters_are_listed_together() -> None:
    with pytest.raises(InputError) as caught:
        load_case("dam-break", None, {"until": -1, "gravity": "down", "colour": "blue"})
    assert len(str(caught.value).splitlines()) == 4
    with pytest.raises(InputError) as caught:
        load_case("dam-break", None, {"kernel": "x", "integrator": "y"})
    assert "2 things are wrong" in str(caught.value)


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no such file"):
        load_case(tmp_path / "missing.toml")
    with pytest.raises(InputError, match="there is no such file"):
        load_case(tmp_path / "missing.nc")
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(InputError, match="is a directory"):
        load_case(tmp_path / "folder.toml")
    (tmp_path / "latin.toml").write_bytes(b'case = "d\xe9"')
    with pytest.raises(InputError, match="UTF-8"):
        load_case(tmp_path / "latin.toml")
    (tmp_path / "text.nc").write_text("no dataset", encoding="utf-8")
    with pytest.raises(InputError, match="not a NetCDF file"):
        load_case(tmp_path / "text.nc")
    with netCDF4.Dataset(tmp_path / "foreign.nc", "w"):
        pass
    with pytest.raises(InputError, match="not written by sphframe"):
        load_case(tmp_path / "foreign.nc")
    with netCDF4.Dataset(tmp_path / "damaged.nc", "w") as dataset:
        dataset.case_name = "dam-break"
        dataset.case_parameters = "{"
    with pytest.raises(InputError, match="damaged"):
        load_case(tmp_path / "damaged.nc")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_a_file_without_permission(tmp_path: Path) -> None:
    path = written(tmp_path, TANK)
    path.chmod(0)
    with pytest.raises(InputError, match="permission denied"):
        load_case(path)


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        ({"particle_spacing": 0.1}, "6 particles over the depth"),
        ({"time_step": 0.003}, r"stability limit 2.33 of symplectic; choose a time step below"),
        ({"courant_number": 5.0}, "courant_number = 5 gives"),
        ({"sound_speed": 10.0}, "sound_speed = 10 m/s is below"),
    ],
    ids=str,
)
def test_doubtful_parameters_warn_with_the_number(overrides: dict[str, Any], message: str) -> None:
    with pytest.warns(CaseWarning, match=message):
        load_case("dam-break", None, overrides)


json_values = st.recursive(
    st.none() | st.booleans() | st.integers(-10, 10) | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)


@pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.dictionaries(st.sampled_from(sorted(Custom.model_fields)), json_values, max_size=5))
def test_whatever_is_given_ends_in_a_case_or_an_error_of_sphframe(parameters: dict[str, Any]) -> None:
    try:
        load_case("dam-break", None, {"particle_spacing": 0.1, **parameters})
    except SphframeError as error:
        message = str(error)
    else:
        message = "a case"
    assert message


@given(st.text())
def test_any_text_is_a_case_file_or_an_input_error(tmp_path_factory: pytest.TempPathFactory, text: str) -> None:
    path = tmp_path_factory.mktemp("fuzz") / "case.toml"
    path.write_text(text, encoding="utf-8")
    with contextlib.suppress(InputError):
        read_toml(path)


DRUM = """
particle_spacing = 0.02
until = 0.1
[[walls]]
shape = "box"
name = "tank"
lower = [0, 0]
upper = [1, 1]
open_faces = ["+y"]
[[fluid]]
shape = "difference"
level = 0.3
of = { shape = "points", file = "bed.csv", closed = true }
minus = [{ shape = "circle", centre = [0.5, 0.3], radius = RADIUS }]
"""


def test_files_of_shapes_are_beside_the_case_file_and_stay_with_the_case(tmp_path: Path) -> None:
    (tmp_path / "bed.csv").write_text("0, 0\n1, 0\n1, 0.3\n0, 0.3\n", encoding="utf-8")
    case = load_case(written(tmp_path, DRUM.replace("RADIUS", "0.1")))
    assert case.scene().depth == 0.3
    (tmp_path / "bed.csv").unlink()
    again = Custom(**json.loads(case.model_dump_json()))
    assert again.scene().fluid == case.scene().fluid


def test_the_place_of_a_wrong_shape_within_a_shape_is_named(tmp_path: Path) -> None:
    (tmp_path / "bed.csv").write_text("0, 0\n1, 0\n1, 0.3\n0, 0.3\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"fluid\[0\].minus\[0\].radius = -1 must be greater than 0"):
        load_case(written(tmp_path, DRUM.replace("RADIUS", "-1")))
