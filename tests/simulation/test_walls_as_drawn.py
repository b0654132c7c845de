"""The wall that is drawn is the wall that is felt: still water against hydrostatics, however its walls are drawn."""

import math

import numpy as np
import pytest

from sphframe import InputError, Simulation, load_case
from sphframe.cases.custom import Custom

RHO_G = 9810.0
SPACING = 0.02
WATER = {"shape": "box", "lower": (0, 0), "upper": (1, 0.3)}


def polygon(name, *points, **other):
    return {"shape": "polygon", "name": name, "points": points, **other}


def box(length, height):
    return {"shape": "box", "name": "tank", "lower": (0, 0), "upper": (length, height), "open_faces": ("+y",)}


def made(walls, fluid, probes=(), spacing=SPACING):
    probes = [{"name": name, "position": position} for name, position in probes]
    return load_case(Custom(particle_spacing=spacing, until=1.0, walls=walls, fluid=fluid, probes=probes))


def still(walls, fluid, probes=(), until=0.3):
    """Mean pressures at ``probes``, mean loads on walls, and the simulation, over the second half of a short time."""
    simulation = Simulation(made(walls, fluid, probes), threads=1)
    pressures, forces, by_pressure = [], [], []
    while simulation.time < until:
        simulation.advance()
        if simulation.time > 0.5 * until and simulation.step % 5 == 0:
            loads = simulation.wall_loads()
            pressures.append(simulation.probe_pressures())
            forces.append({name: load.force for name, load in loads.items()})
            by_pressure.append({name: load.force_by_pressure for name, load in loads.items()})
    assert simulation.particles_outside() == 0
    mean = [
        {name: np.mean([found[name] for found in series], axis=0) for name in series[0]}
        for series in (forces, by_pressure)
    ]
    return np.mean(pressures, axis=0), *mean


@pytest.mark.parametrize("segments", [1, 36, 75, 100])
def test_the_pressure_on_a_bed_does_not_depend_on_its_segments(segments):
    bed = [(k / segments, 0) for k in range(segments + 1)]
    (pressure,), forces, _ = still([polygon("tank", (0, 0.45), *bed, (1, 0.45))], [WATER], [("bed", (0.5, 0))])
    assert pressure == pytest.approx(RHO_G * 0.3, rel=0.01)
    assert forces["tank"] == pytest.approx([0.0, -RHO_G * 0.3], abs=0.01 * RHO_G * 0.3)


@pytest.mark.parametrize("height", [0.39, 0.40, 0.405])
def test_the_height_of_a_dry_wall_does_not_change_the_pressure(height):
    case = load_case("hydrostatic-tank", overrides={"particle_spacing": 0.03, "tank_height": height})
    simulation, found = Simulation(case, threads=1), []
    while simulation.time < 0.4:
        simulation.advance()
        if simulation.time > 0.2:
            found.append(simulation.probe_pressures()[0])
    assert np.mean(found) == pytest.approx(RHO_G * 0.3, rel=0.01)


def test_walls_that_share_their_ends():
    walls = [polygon("left", (0, 0.45), (0, 0)), polygon("bed", (0, 0), (1, 0)), polygon("right", (1, 0.45), (1, 0))]
    pressure, forces, by_pressure = still(walls, [WATER], [("bed", (0.5, 0)), ("corner", (1, 0))])
    assert pressure == pytest.approx(RHO_G * 0.3, rel=0.01)
    for found in (forces, by_pressure):
        assert found["left"][0] == pytest.approx(-0.5 * RHO_G * 0.3**2, rel=0.01)
        assert found["right"][0] == pytest.approx(0.5 * RHO_G * 0.3**2, rel=0.01)
        assert found["bed"][1] == pytest.approx(-RHO_G * 0.3, rel=0.01)


@pytest.mark.parametrize("angle", [15, 45, 75])
def test_the_toe_of_a_slope(angle):
    run = 1.0 / math.tan(math.radians(angle))
    tank = polygon("tank", (0, 0.5), (0, 0), (1, 0), (1 + 0.5 * run, 0.5))
    water = {"shape": "polygon", "points": ((0, 0), (1, 0), (1 + 0.3 * run, 0.3), (0, 0.3))}
    (pressure,), _, _ = still([tank], [water], [("toe", (1, 0))])
    assert pressure == pytest.approx(RHO_G * 0.3, rel=0.015)


@pytest.mark.parametrize("foot", [-0.08, 0.0])
def test_a_plate_on_the_bed_or_sunk_into_it(foot):
    plate = polygon("plate", (0.48, foot), (0.48, 0.52), (0.64, 0.52), (0.64, foot), closed=True)
    _, forces, by_pressure = still([box(1, 0.52), plate], [{"shape": "box", "lower": (0, 0), "upper": (0.48, 0.32)}])
    assert forces["plate"][0] == pytest.approx(502.3, rel=0.02)
    assert by_pressure["plate"][0] == pytest.approx(502.3, rel=0.02)


def test_a_half_full_drum():
    disc = {"shape": "circle", "centre": (0, 0), "radius": 0.3}
    lower_half = {"shape": "difference", "of": disc, "minus": [{"shape": "box", "lower": (-1, 0), "upper": (1, 1)}]}
    (pressure,), forces, by_pressure = still([{**disc, "name": "drum"}], [lower_half], [("bottom", (0, -0.3))])
    assert pressure == pytest.approx(RHO_G * 0.3, rel=0.01)
    for found in (forces, by_pressure):
        assert found["drum"][1] == pytest.approx(-RHO_G * 0.5 * math.pi * 0.3**2, rel=0.01)


def test_water_over_a_half_circle():
    disc = {"shape": "circle", "centre": (0.6, 0), "radius": 0.24}
    hump = {"shape": "difference", "of": disc, "minus": [{"shape": "box", "lower": (0, -1), "upper": (2, 0)}]}
    water = {"shape": "difference", "of": {"shape": "box", "lower": (0, 0), "upper": (1.2, 0.5)}, "minus": [disc]}
    _, forces, by_pressure = still([box(1.2, 0.8), {**hump, "name": "hump"}], [water])
    downward = RHO_G * (2 * 0.24 * 0.5 - 0.5 * math.pi * 0.24**2)
    for found in (forces, by_pressure):
        assert found["hump"][1] == pytest.approx(-downward, rel=0.01)


def test_water_over_a_wedge():
    """No particle beside the tip is taken for one behind the wedge's other face."""
    rise, half, middle = 0.24, 0.27733, 0.6
    corners = ((middle - half, 0), (middle, rise), (middle + half, 0))
    tank = {"shape": "box", "lower": (0, 0), "upper": (2 * middle, 0.5)}
    water = {"shape": "difference", "of": tank, "minus": [{"shape": "polygon", "points": corners}]}
    wedge = polygon("wedge", *corners, closed=True)
    pressure, forces, by_pressure = still([box(1.2, 0.8), wedge], [water], [("apex", corners[1]), ("base", corners[0])])
    assert pressure == pytest.approx([RHO_G * (0.5 - rise), RHO_G * 0.5], rel=0.01)
    for found in (forces, by_pressure):
        assert found["wedge"][1] == pytest.approx(-RHO_G * half * (2 * 0.5 - rise), rel=0.01)


def steps(rise, count):
    """A staircase of steps that are as wide as high."""
    corners = [(1.2 + rise * ((k + 1) // 2), rise * ((k + 2) // 2)) for k in range(2 * count)]
    return polygon("tank", (0, 1.2), (0, 0), (1.2, 0), *corners, (1.2 + rise * count, 1.2))


HALF = 0.3 * math.tan(math.radians(10))
OBSTACLES = {
    "a spike": [box(2, 1.2), polygon("spike", (1 - HALF, 0), (1, 0.3), (1 + HALF, 0), closed=True)],
    "a cylinder": [box(2, 1.2), {"shape": "circle", "name": "cylinder", "centre": (1, 0.2), "radius": 0.1}],
    "a staircase": [steps(0.05, 12)],
}


@pytest.mark.parametrize("obstacle", OBSTACLES)
def test_no_water_of_a_dam_break_is_ever_behind_a_wall(obstacle):
    column = {"shape": "box", "lower": (0, 0), "upper": (0.6, 0.6)}
    simulation = Simulation(made(OBSTACLES[obstacle], [column], spacing=0.025), threads=1)
    while simulation.time < 0.7:
        simulation.advance()
        assert simulation.step % 5 or not simulation.particles_outside()


@pytest.mark.parametrize(
    ("wall", "message"),
    [
        ({"shape": "ellipse", "name": "e", "centre": (0.8, 0.2), "semi_axes": (0.1, 0.02)}, "thinner than .* 0.078 m"),
        (polygon("plate", (0.3, 0), (0.3, 0.5)), "wall 'plate' runs through the fluid"),
        (polygon("cup", (0.6, 0.1), (0.6, 0.3), (0.8, 0.3), (0.8, 0.1)), "wall 'cup' .* draw a closed wall"),
    ],
)
def test_walls_that_cannot_hold_water_are_refused(wall, message):
    with pytest.raises(InputError, match=message):
        made([box(1, 0.5), wall], [{"shape": "box", "lower": (0, 0), "upper": (0.5, 0.3)}])
