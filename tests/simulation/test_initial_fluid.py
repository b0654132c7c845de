"""The initial state of the fluid: levels, pressures and velocities of regions, and their mass."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sphframe import InputError, Simulation, load_case
from sphframe.cases import CaseWarning
from sphframe.cases.custom import Custom

TANK = {"shape": "box", "name": "tank", "lower": (0, 0), "upper": (1, 1.5), "open_faces": ("+y",)}
RHO_G = 9810.0


def case(*fluid: dict[str, Any], walls: tuple[dict[str, Any], ...] = (TANK,), dx: float = 0.02, **other: Any) -> Custom:
    return load_case(Custom(particle_spacing=dx, until=0.1, fluid=fluid, walls=walls, **other))


def box(*corners: tuple[float, float], **state: Any) -> dict[str, Any]:
    return {"shape": "box", "lower": corners[0], "upper": corners[1], **state}


def start(made: Custom) -> tuple[np.ndarray, np.ndarray, Simulation]:
    simulation = Simulation(made, threads=1)
    fields = simulation.fields()
    return fields.position, fields.pressure, simulation


def test_a_block_above_a_pool_falls_freely_and_the_pool_is_at_rest() -> None:
    position, pressure, _ = start(case(box((0, 0), (1, 0.2)), box((0.4, 0.8), (0.6, 1.0))))
    block = position[:, 1] > 0.5
    assert np.all(pressure[block] == 0.0)
    np.testing.assert_allclose(pressure[~block], RHO_G * (0.2 - position[~block, 1]), rtol=2e-3)


def test_jitter_displaces_all_particles_at_random_by_no_more_than_it_says() -> None:
    pool = box((0, 0), (1, 0.2))
    rest, _, _ = start(case(pool))
    moved = [start(case(pool, jitter=0.05, seed=seed))[0] for seed in (1, 1, 2)]
    assert np.array_equal(moved[0], moved[1])
    assert not np.any(moved[0] == moved[2])
    nearest = np.abs(moved[0][:, None] - rest[None]).max(axis=2).min(axis=1)
    assert nearest.min() > 0.0
    assert 0.95 * 0.05 * 0.02 < nearest.max() <= 0.05 * 0.02 + 1e-12


def test_fluid_beside_a_wall_or_below_a_lid_falls_freely_too() -> None:
    closed = {**TANK, "open_faces": ()}
    _, pressure, _ = start(case(box((0, 1.2), (0.4, 1.5)), walls=(closed,)))
    assert np.all(pressure == 0.0)


def test_touching_regions_share_the_highest_surface() -> None:
    position, pressure, _ = start(case(box((0, 0), (0.5, 0.2)), box((0.5, 0), (1, 0.4))))
    np.testing.assert_allclose(pressure, RHO_G * (0.4 - position[:, 1]), rtol=2e-3)


def test_a_wall_between_two_regions_separates_their_surfaces() -> None:
    plate = {"shape": "polygon", "name": "plate", "points": ((0.5, 0), (0.5, 1)), "closed": False}
    regions = box((0, 0), (0.5, 0.2)), box((0.5, 0), (1, 0.4))
    from sphframe.geometry import fill, wall_groups
    from sphframe.simulation.rest_state import still_levels

    scene = Custom(particle_spacing=0.02, until=1.0, walls=(TANK, plate), fluid=regions).scene()
    groups = [group for _, group in wall_groups(scene.walls[:1], scene.fluid, 0.02)]
    found = still_levels(
        scene, [fill(region, 0.02).position for region in scene.fluid], 0.02, groups, np.array([0.0, 1.0])
    )
    np.testing.assert_allclose(found, [0.2, 0.4])


def test_level_pressure_and_velocity_of_a_region() -> None:
    position, pressure, simulation = start(
        case(box((0, 0), (0.4, 0.2), level=0.5), box((0.6, 0), (1, 0.2), pressure=700.0, velocity=(1.0, -0.5)))
    )
    left = position[:, 0] < 0.5
    np.testing.assert_allclose(pressure[left], RHO_G * (0.5 - position[left, 1]), rtol=2e-3)
    np.testing.assert_allclose(pressure[~left], 700.0, rtol=1e-9)
    velocity = simulation.fields().velocity
    assert np.all(velocity[left] == 0.0)
    assert np.all(velocity[~left] == [1.0, -0.5])
    assert case(box((0, 0), (0.4, 0.2), level=0.5)).scene().depth == 0.5


def test_the_rest_state_of_a_level_is_that_of_water_up_to_there() -> None:
    """The bottom half of a column has the pressure of the bottom half of the whole column, bit for bit."""
    position, pressure, _ = start(case(box((0, 0), (1, 0.2), level=0.4)))
    whole_position, whole, _ = start(case(box((0, 0), (1, 0.4))))
    below = whole_position[:, 1] < 0.2
    by_place = np.lexsort(position.T), np.lexsort(whole_position[below].T)
    np.testing.assert_allclose(pressure[by_place[0]], whole[below][by_place[1]], rtol=1e-9)


@pytest.mark.parametrize("dx", [0.02, 0.017, 0.013])
def test_a_polygon_has_the_mass_of_its_area(dx: float) -> None:
    slope = {"shape": "polygon", "points": ((0, 0), (1, 0), (1.3, 0.3), (0, 0.3))}
    wall = {"shape": "polygon", "name": "tank", "points": ((0, 0.5), (0, 0), (1, 0), (1.5, 0.5))}
    simulation = Simulation(case(slope, walls=(wall,), dx=dx), threads=1)
    mass = simulation.masses()
    assert np.sum(mass / simulation.fields().density) == pytest.approx(0.345, rel=1e-12)
    # the density averages 1 + g y / c0^2 over the depth: a little more than that at the surface
    assert 1.0 < mass.sum() / 345.0 < 1.0013


@pytest.mark.parametrize(
    ("regions", "message"),
    [
        ((box((0, 0), (0.6, 0.3)), box((0.4, 0), (1, 0.3))), r"fluid\[0\] and fluid\[1\] overlap in 0.06 m2 around"),
        ((box((0, 0), (1, 0.3)), box((0, 0), (1, 0.3))), r"fluid\[0\] and fluid\[1\] overlap in 0.3 m2"),
        (
            (box((0, 0), (1, 0.3)), {"shape": "circle", "centre": (0.5, 0.4), "radius": 0.2}),
            r"fluid\[0\] and fluid\[1\] overlap in .* around \(0.5, 0.25",
        ),
    ],
)
def test_overlapping_regions_are_refused(regions: tuple[dict[str, Any], ...], message: str) -> None:
    with pytest.raises(InputError, match=message):
        case(*regions)


def test_overlapping_boxes_are_refused_in_three_dimensions() -> None:
    tank = {"shape": "box", "name": "tank", "lower": (0, 0, 0), "upper": (1, 1, 1), "open_faces": ("+z",)}
    regions = (
        {"shape": "box", "lower": (0, 0, 0), "upper": (0.6, 1, 0.5)},
        {"shape": "box", "lower": (0.5, 0, 0), "upper": (1, 1, 0.5)},
    )
    with pytest.raises(InputError, match=r"fluid\[0\] and fluid\[1\] overlap in 0.05 m3 around \(0.55, 0.5, 0.25\)"):
        case(*regions, walls=(tank,), dx=0.05, dimension=3)


@pytest.mark.parametrize(
    ("lower", "message"),
    [(0.006, r"ends 0.006 m at \(0.\d+, 0.006\) before a wall"), (-0.004, "reaches 0.004 m .* behind a wall")],
)
def test_a_sliver_between_fluid_and_wall_is_reported(lower: float, message: str) -> None:
    with pytest.warns(CaseWarning, match=message):
        case(box((0, lower), (1, 0.3)))


def test_fluid_up_to_a_leaning_wall_leaves_no_sliver(tmp_path: Path) -> None:
    slope = {"shape": "polygon", "points": ((0, 0), (1, 0), (1.3, 0.3), (0, 0.3))}
    overhang = {"shape": "polygon", "points": ((0, 0), (1, 0), (0.7, 0.3), (0, 0.3))}
    for fluid, top in ((slope, 1.5), (overhang, 0.5)):
        wall = {"shape": "polygon", "name": "tank", "points": ((0, 0.5), (0, 0), (1, 0), (top, 0.5))}
        case(fluid, walls=(wall,))


@pytest.mark.parametrize("spacing", [0.02, 0.005])
def test_fluid_that_fills_a_curved_wall_leaves_no_gap_at_any_spacing(spacing: float) -> None:
    disc = {"shape": "circle", "centre": (0, 0), "radius": 0.3}
    lower_half = {"shape": "difference", "of": disc, "minus": [{"shape": "box", "lower": (-1, 0), "upper": (1, 1)}]}
    case(lower_half, walls=({**disc, "name": "drum"},), dx=spacing)  # a CaseWarning is an error here
