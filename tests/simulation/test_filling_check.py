"""The check before a run that fluid and ghosts fill the kernel beside the walls."""

import math

import numpy as np
import pytest

import sphframe
from sphframe.analysis import plot_walls
from sphframe.cases import Case, CaseWarning, Custom, load_case
from sphframe.cases.case import Guards
from sphframe.cases.placement import placed_scene
from sphframe.errors import InputError
from sphframe.simulation.components import Components
from sphframe.simulation.filling_check import check_filling, filling_beside_walls
from sphframe.simulation.initial_state import drawn, loop_parameters

TANK = {"shape": "polygon", "name": "tank", "points": [[0, 0.6], [0, 0], [1, 0], [1, 0.6]]}
SPIKE = {"shape": "polygon", "points": [[0.5, 0.3], [0.44, 0], [0.56, 0]]}
DISC = {"shape": "circle", "centre": [0.5, 0.2], "radius": 0.1}
SLOPE = {"shape": "polygon", "points": [[0.6, 0], [1, 0], [1, 0.4]]}


def case_of(*walls, low=0.0, minus=(), **parameters):
    water = {"shape": "box", "lower": [0, low], "upper": [1, 0.4]}
    fluid = {"shape": "difference", "of": water, "minus": list(minus)} if minus else water
    return Custom(walls=[TANK, *walls], fluid=[fluid], particle_spacing=0.02, until=0.001, **parameters)


def start_of(case: Case):
    scene, components = placed_scene(case), Components.of_case(case)
    parameters = loop_parameters(case, scene, components)
    return drawn(case, scene, components, parameters), scene, components, parameters


@pytest.mark.parametrize("shape", [SPIKE, DISC, SLOPE], ids=["spike", "disc", "slope"])
def test_walls_that_are_filled_give_no_alarm(shape):
    closed = {"closed": True} if "points" in shape else {}
    start, scene, _, _ = start_of(case_of({**shape, "name": "solid", **closed}, minus=[shape]))
    filling = start.filling
    assert {scene.walls[k].name for k in np.unique(filling.wall[filling.full])} == {"tank", "solid"}
    assert np.abs(filling.value[filling.full] - 1.0).max() < 0.025
    surface = filling.points[~filling.full]
    assert len(surface)
    assert np.all(surface[:, 1] > 0.4 - 0.079), "only below the surface, within the kernel's support"
    check_filling(filling, scene.walls, refuse=True)


def test_the_filling_in_three_dimensions_and_a_free_end():
    start, scene, _, _ = start_of(load_case("hydrostatic-tank", overrides={"dimension": 3, "particle_spacing": 0.03}))
    assert start.filling.full.any()
    check_filling(start.filling, scene.walls, refuse=True)
    bed = {"shape": "polyline", "name": "bed", "points": [[0, 0], [1, 0]]}
    heap = Custom(
        walls=[bed], fluid=[{"shape": "box", "lower": [0.3, 0], "upper": [1, 0.3]}], particle_spacing=0.02, until=0.01
    )
    start, scene, _, _ = start_of(heap)
    assert start.filling.full.any()
    assert not start.filling.full[start.filling.points[:, 0] > 0.98].any()
    check_filling(start.filling, scene.walls, refuse=True)


MESSAGE = r"beside wall 'tank', fluid and ghosts fill the kernel by \d+% at \(0.3[678]"


def test_ghosts_that_lack_volume_are_reported_with_wall_and_place():
    """F changes by the share of the Gaussian kernel that lies behind a straight wall, erfc(d/h)/2 at the distance d."""
    start, scene, components, parameters = start_of(case_of())
    share = 0.5 * math.erfc(0.5 / 1.3)
    for factor in (0.6, 1.4):
        start.boundary.volume *= factor
        filling = filling_beside_walls(start.boundary, start.position, start.volume, 0.02, components, parameters)
        start.boundary.volume /= factor
        bed = filling.full & (np.abs(filling.points - [0.5, 0.01]) < [0.3, 0.001]).all(axis=1)
        assert bed.any()
        np.testing.assert_allclose(filling.value[bed], 1.0 + (factor - 1.0) * share, atol=0.005)
        with pytest.warns(CaseWarning, match=r"beside wall 'tank', .* by \d+% at \("):
            check_filling(filling, scene.walls, refuse=True)


def test_a_gap_between_fluid_and_wall_is_refused_or_reported():
    with pytest.warns(CaseWarning, match="a gap that no particle fills"):
        case = load_case(case_of(low=0.013))
    with pytest.raises(
        InputError, match=r"beside wall 'tank', fluid and ghosts fill the kernel by 7\d% at \(0\.\d+, 0"
    ):
        sphframe.Simulation(case, threads=1)
    with pytest.warns(CaseWarning, match="beside wall 'tank'"):
        sphframe.Simulation(case.model_copy(update={"guards": Guards(filling="report")}), threads=1)


def test_a_gap_in_three_dimensions_is_refused_or_reported():
    tank = {"shape": "box", "name": "tank", "lower": (0, 0, 0), "upper": (0.4, 0.4, 0.5), "open_faces": ("+z",)}
    for gap, refused in ((0.02, True), (0.01, False)):
        water = {"shape": "box", "lower": (0, 0, 0), "upper": (0.4 - gap, 0.4, 0.4)}
        case = load_case(Custom(dimension=3, particle_spacing=0.04, until=1.0, walls=[tank], fluid=[water]))
        expected = pytest.raises(InputError, match=MESSAGE) if refused else pytest.warns(CaseWarning, match=MESSAGE)
        with expected:
            sphframe.Simulation(case, threads=1)


def test_the_picture_shows_everything(tmp_path):
    case = case_of({**DISC, "name": "disc"}, minus=[DISC])
    figure = plot_walls(case, tmp_path / "walls.png")
    assert (tmp_path / "walls.png").stat().st_size > 10_000
    start = start_of(case)[0]
    axes = figure.axes[0]
    counts = [len(collection.get_offsets()) for collection in axes.collections]
    assert len(start.position) in counts
    assert start.boundary.count in counts
    assert start.filling.full.sum() in counts
