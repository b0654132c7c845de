"""Force and moment on walls and parts of walls, against hydrostatics."""

import numpy as np
import pytest

from sphframe import InputError, Simulation, load_case, open_dataset, run
from sphframe.cases import Custom

pytestmark = pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")

DEPTH, LENGTH = 0.4, 0.6
WEIGHT = 9810.0 * DEPTH * LENGTH
WALLS = [
    {"shape": "polygon", "name": "bed", "points": [[-0.2, 0.0], [0.8, 0.0]]},
    {"shape": "polygon", "name": "left", "points": [[0.0, 0.6], [0.0, 0.0]], "one_sided": True},
    {"shape": "polygon", "name": "right", "points": [[LENGTH, 0.0], [LENGTH, 0.6]], "one_sided": True},
]


def basin(**options) -> Custom:
    """Still water between two walls that stand on a bed; the right one is cut into a lower and an upper half."""
    common = {
        "particle_spacing": 0.02,
        "until": 0.02,
        "probe_interval": 0.01,
        "walls": WALLS,
        "fluid": [{"shape": "box", "lower": [0, 0], "upper": [LENGTH, DEPTH]}],
        "wall_parts": [
            {"name": "lower half", "wall": "right", "lower": [0.5, 0.0], "upper": [0.7, 0.2]},
            {"name": "upper half", "wall": "right", "lower": [0.5, 0.2], "upper": [0.7, 0.6]},
        ],
    }
    return Custom(**{**common, **options})


@pytest.fixture(scope="module")
def loads():
    return Simulation(basin(), threads=1).wall_loads()


def test_moments_of_still_water_about_the_origin(loads):
    sideways = 9810.0 * DEPTH**2 / 2.0
    # M = x F_y - y F_x, with the pressure rho g (H - y) on the side and rho g H on the bed
    for name, exact in (
        ("left", sideways * DEPTH / 3.0),
        ("right", -sideways * DEPTH / 3.0),
        ("bed", -WEIGHT * LENGTH / 2.0),
    ):
        scale = 0.03 * abs(exact)
        assert loads[name].moment[0] == pytest.approx(exact, abs=scale), name
        if name != "bed":  # the bed's panels behind the walls are the walls' affair
            assert loads[name].moment_by_pressure[0] == pytest.approx(exact, abs=scale), name


def test_parts_add_up_to_their_wall(loads):
    lower, upper, whole = (loads[name] for name in ("lower half", "upper half", "right"))
    assert lower.force_by_pressure + upper.force_by_pressure == pytest.approx(whole.force_by_pressure, rel=1e-12)
    assert lower.moment_by_pressure + upper.moment_by_pressure == pytest.approx(whole.moment_by_pressure, rel=1e-12)
    assert lower.force_by_pressure[0] == pytest.approx(9810.0 * 0.2 * 0.3, rel=0.02)
    assert upper.force_by_pressure[0] == pytest.approx(9810.0 * 0.2**2 / 2.0, rel=0.04)
    # by reaction the halves miss only the ghosts of the bed behind the wall
    assert lower.force[0] == pytest.approx(9810.0 * 0.2 * 0.3, rel=0.08)
    assert upper.force[0] == pytest.approx(9810.0 * 0.2**2 / 2.0, rel=0.08)


def test_a_body_feels_the_moment_about_its_centre():
    walls = [wall | {"body": "flap"} if wall["name"] == "right" else wall for wall in WALLS]
    still = {"name": "displacement-series", "contents": "0 0\n1 0\n", "centre": [LENGTH, 0.0]}
    moment = Simulation(basin(walls=walls, bodies={"flap": still}), threads=1).wall_loads()["right"].moment
    assert moment[0] == pytest.approx(-9810.0 * DEPTH**3 / 6.0, rel=0.03)
    higher = {**still, "centre": [LENGTH, DEPTH]}
    moment = Simulation(basin(walls=walls, bodies={"flap": higher}), threads=1).wall_loads()["right"].moment
    assert moment[0] == pytest.approx(9810.0 * DEPTH**3 / 3.0, rel=0.03)


def test_the_moment_refers_to_the_reference_point():
    foot = [wall | ({"reference_point": [LENGTH, 0.0]} if wall["name"] == "right" else {}) for wall in WALLS]
    at_rest = Simulation(basin(walls=foot), threads=1).wall_loads()
    assert at_rest["right"].moment[0] == pytest.approx(-9810.0 * DEPTH**3 / 6.0, rel=0.03)
    assert at_rest["right"].moment_by_pressure[0] == pytest.approx(-9810.0 * DEPTH**3 / 6.0, rel=0.03)
    halves = at_rest["lower half"].moment_by_pressure + at_rest["upper half"].moment_by_pressure
    assert halves == pytest.approx(at_rest["right"].moment_by_pressure, rel=1e-12)
    walls = [wall | {"body": "flap"} if wall["name"] == "right" else wall for wall in foot]
    body = {"name": "displacement-series", "contents": "0 0\n1 0\n", "centre": [LENGTH, DEPTH]}
    carried = Simulation(basin(walls=walls, bodies={"flap": body}), threads=1).wall_loads()["right"].moment
    assert carried[0] == pytest.approx(-9810.0 * DEPTH**3 / 6.0, rel=0.03)


def test_a_reference_point_has_the_coordinates_of_its_case():
    walls = [wall | {"reference_point": [0.0, 0.0, 0.0]} if wall["name"] == "bed" else wall for wall in WALLS]
    with pytest.raises(InputError, match="reference_point of wall 'bed' has 3 coordinates, but dimension = 2 needs 2"):
        load_case(basin(walls=walls))


def test_in_space_moments_are_vectors(tmp_path):
    case = Custom(
        dimension=3, particle_spacing=0.05, until=0.01, probe_interval=0.005,
        walls=[{"shape": "box", "name": "tank", "lower": [0, 0, 0], "upper": [0.4, 0.3, 0.4], "open_faces": ["+z"]}],
        fluid=[{"shape": "box", "lower": [0, 0, 0], "upper": [0.4, 0.3, 0.25]}],
    )  # fmt: skip
    dataset = run(case, output=tmp_path / "run.nc", threads=1).dataset
    weight = float(dataset["mass"][0]) * 9.81
    exact = [-0.15 * weight, 0.2 * weight, 0.0]  # of the weight at the centre of the bed
    for name in ("wall_moment", "wall_moment_by_pressure"):
        assert dataset[name].dims == ("probe_time", "wall", "space")
        assert dataset[name].values[0, 0] == pytest.approx(exact, abs=0.05 * 0.2 * weight), name


def test_moments_and_parts_are_in_the_file(tmp_path):
    run(basin(), output=tmp_path / "run.nc", threads=1)
    with open_dataset(tmp_path / "run.nc") as dataset:
        assert dataset["wall_moment"].dims == ("probe_time", "wall")
        assert dataset["wall_moment"].attrs["units"] == "N m m-1"
        assert list(dataset["part"].values) == ["lower half", "upper half"]
        assert list(dataset["part_wall"].values) == [2, 2]
        halves = dataset["part_force_by_pressure"].sum("part")
        np.testing.assert_allclose(halves, dataset["wall_force_by_pressure"].sel(wall="right"), rtol=1e-9)


def test_a_part_of_an_unknown_wall_is_refused():
    part = {"name": "toe", "wall": "seawall", "lower": [0, 0], "upper": [1, 1]}
    with pytest.raises(
        InputError, match="part 'toe' is of wall 'seawall', which is not given; walls: bed, left, right"
    ):
        load_case(basin(wall_parts=[part]))
