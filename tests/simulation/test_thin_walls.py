"""Plates thinner than the support hold water on both sides: levels, forces, free ends, impacts."""

import numpy as np
import pytest

from sphframe import InputError, Simulation, load_case
from sphframe.cases.custom import Custom

RHO_G, SPACING = 9810.0, 0.02
TANK = {"shape": "box", "name": "tank", "lower": (0, 0), "upper": (1, 0.6), "open_faces": ("+y",)}


def region(lower, upper):
    return {"shape": "box", "lower": lower, "upper": upper}


def plate(*points, **other):
    return {"shape": "polygon", "name": "plate", "points": points, **other}


def solid(width):
    low, high = 0.5 - 0.5 * width, 0.5 + 0.5 * width
    return plate((low, 0), (low, 0.48), (high, 0.48), (high, 0), closed=True)


def made(walls, fluid, **other):
    case = Custom(particle_spacing=SPACING, until=1.0, walls=[TANK, *walls], fluid=fluid, **other)
    return Simulation(load_case(case), threads=1)


def basins(width=0.0, **other):
    wall = solid(width) if width else plate((0.5, 0), (0.5, 0.48))
    wall["body"] = next(iter(other.get("bodies", ())), None)
    edge = 0.5 * width
    return made([wall], [region((0, 0), (0.5 - edge, 0.4)), region((0.5 + edge, 0), (1, 0.2))], **other)


def advance(simulation, until):
    while simulation.time < until:
        simulation.advance()


def largest_speed(simulation):
    return float(np.hypot(*simulation.fields().velocity.T).max())


@pytest.mark.parametrize(("width", "held"), [(0.0, False), (0.01, False), (0.04, False), (0.0, True), (0.01, True)])
def test_two_basins_with_different_levels_beside_a_plate(tmp_path, width, held):
    path = tmp_path / "held.txt"
    path.write_text("0, 0, 0\n10, 0, 0\n")
    gate = {"bodies": {"gate": {"name": "displacement-series", "path": str(path)}}}  # a closed gate stands on the bed
    simulation = basins(width, **gate if held else {})
    left = simulation.fields().position[:, 0] < 0.5
    forces = []
    while simulation.time < 0.2:
        simulation.advance()
        if simulation.time > 0.1 and simulation.step % 10 == 0:
            load = simulation.wall_loads()["plate"]
            forces.append((load.force[0], load.force_by_pressure[0]))
            assert abs(load.force[1]) < 6.0
    np.testing.assert_array_equal(simulation.fields().position[:, 0] < 0.5, left)
    assert simulation.particles_outside() == 0
    assert largest_speed(simulation) < 0.02 * np.sqrt(9.81 * 0.4)
    np.testing.assert_allclose(np.mean(forces, axis=0), RHO_G * (0.4**2 - 0.2**2) / 2, rtol=0.01)


def mean_forces(simulation, name, until):
    """Mean forces on a wall, by reaction and by pressure, over the second half of the time."""
    forces = []
    while simulation.time < until:
        simulation.advance()
        if simulation.time > 0.5 * until and simulation.step % 10 == 0:
            load = simulation.wall_loads()[name]
            forces.append((load.force, load.force_by_pressure))
    return np.mean(forces, axis=0)


def test_a_bent_line_holds_water_on_both_sides():
    """A line with bends of 27 and 45 degrees between two levels, in each basin a polygon of fluid along it."""
    line = [(0.5, 0.0), (0.5, 0.1), (0.45, 0.2), (0.5, 0.35)]
    surface = 0.45 + 0.05 * 0.1 / 0.15
    left = {"shape": "polygon", "points": [(0, 0), *line[:3], (surface, 0.3), (0, 0.3)]}
    right = {"shape": "polygon", "points": [*line[:3], (1, 0.2), (1, 0)]}
    simulation = made([{"shape": "polyline", "name": "plate", "points": line}], [left, right])
    x, y = simulation.fields().position.T
    is_left = x < np.interp(y, *np.transpose(line)[::-1])
    by_reaction, by_pressure = mean_forces(simulation, "plate", 0.2)
    x, y = simulation.fields().position.T
    np.testing.assert_array_equal(x < np.interp(y, *np.transpose(line)[::-1]), is_left)
    assert by_reaction[0] == pytest.approx(RHO_G * (0.3**2 - 0.2**2) / 2, rel=0.01)
    assert by_pressure[0] == pytest.approx(RHO_G * (0.3**2 - 0.2**2) / 2, rel=0.01)


def test_a_slender_tip_bears_the_weight_of_the_water():
    half, height = 0.2 * np.tan(np.radians(4)), 0.2  # eight degrees
    tip = ((0.5 - half, 0), (0.5, height), (0.5 + half, 0))
    water = {"shape": "difference", "of": region((0, 0), (1, 0.3)), "minus": [{"shape": "polygon", "points": tip}]}
    simulation = made([plate(*tip, closed=True)], [water])
    by_reaction, by_pressure = mean_forces(simulation, "plate", 0.2)
    assert simulation.particles_outside() == 0
    exact = -RHO_G * (2 * half * 0.3 - half * height)
    assert by_pressure == pytest.approx([0.0, exact], abs=0.04 * abs(exact))
    assert by_reaction == pytest.approx([0.0, exact], abs=0.1 * RHO_G * 0.3 * SPACING)  # of a tenth of a spacing


@pytest.mark.parametrize(
    ("wall", "fluid"),
    [
        (
            plate((0.5, 0), (0.5, 0.2)),
            [region((0, 0), (0.5, 0.2)), region((0.5, 0), (1, 0.2)), region((0, 0.2), (1, 0.3))],
        ),
        (
            plate((0.5, 0.04), (0.5, 0.5)),
            [region((0, 0), (1, 0.04)), region((0, 0.04), (0.5, 0.3)), region((0.5, 0.04), (1, 0.3))],
        ),
    ],
    ids=["weir", "plate that hangs into the water"],
)
def test_water_round_a_free_end_stays_at_rest(wall, fluid):
    simulation = made([wall], fluid)
    advance(simulation, 0.3)
    assert largest_speed(simulation) < 0.02 * np.sqrt(9.81 * 0.3)
    load = simulation.wall_loads()["plate"]
    np.testing.assert_allclose([load.force[0], load.force_by_pressure[0]], 0.0, atol=1.0)


def assert_momentum_is_conserved(simulation):
    system = simulation.system
    system.evaluate(simulation.time)
    system.update_loads()
    columns = system.columns
    masses = system.rows[: system.fluid_count, columns.mass]
    rate = masses @ system.rates[:, columns.u : columns.u + 2]
    weight = np.array([0.0, -9.81 * masses.sum()])
    np.testing.assert_allclose(rate, weight - system.loads[:, :2].sum(axis=0), rtol=0.0, atol=1e-11 * abs(weight[1]))


def test_fluid_and_walls_together_conserve_momentum():
    simulation = made([plate((0.6, 0), (0.6, 0.1))], [region((0, 0), (0.3, 0.4))])
    advance(simulation, 0.3)  # the water hits the plate and runs over it
    assert_momentum_is_conserved(simulation)


def test_a_dam_break_does_not_cross_a_plate():
    simulation = made([plate((0.6, 0), (0.6, 0.58))], [region((0, 0), (0.3, 0.4))])
    highest = 0.0
    while simulation.time < 0.4:
        simulation.advance()
        if simulation.step % 20 == 0:
            position = simulation.fields().position
            assert position[:, 0].max() <= 0.6
            highest = max(highest, position[position[:, 0] > 0.5, 1].max(initial=0.0))
    assert highest > 0.4
    assert simulation.particles_outside() == 0


def test_a_restored_run_has_the_same_bits():
    one, other = basins(), basins()
    advance(one, 0.02)
    other.restore(one.state())
    for simulation in (one, other):
        advance(simulation, 0.05)
    for name in ("position", "velocity", "density"):
        np.testing.assert_array_equal(getattr(one.fields(), name), getattr(other.fields(), name))


def gate(tmp_path, **other):
    path = tmp_path / "lift.txt"
    path.write_text("0, 0, 0\n0.05, 0, 0\n0.25, 0, 0.4\n")
    wall = {**plate((0.5, 0), (0.5, 0.48)), "body": "gate"}
    body = {"name": "displacement-series", "path": str(path)}
    fluid = [region((0, 0), (0.5, 0.4)), region((0.5, 0), (1, 0.1))]
    return made([wall], fluid, bodies={"gate": body}, **other)


def test_a_gate_is_lifted(tmp_path):
    simulation = gate(tmp_path)
    left = simulation.fields().position[:, 0] < 0.5
    while simulation.time < 0.25:
        simulation.advance()
        right_of = simulation.fields().position[:, 0] > 0.5
        if simulation.time < 0.05:
            np.testing.assert_array_equal(right_of, ~left)
            load = simulation.wall_loads()["plate"] if simulation.step % 100 == 0 else None
            if load is not None:
                exact = RHO_G * (0.4**2 - 0.1**2) / 2
                np.testing.assert_allclose([load.force[0], load.force_by_pressure[0]], exact, rtol=0.03)
        bottom = simulation.body_motions()["gate"].position[1]
        crossed = simulation.fields().position[right_of & left]
        assert np.all(crossed[crossed[:, 0] < 0.51, 1] < bottom + 0.5 * SPACING)
    assert simulation.particles_outside() == 0
    assert (right_of & left).sum() > 20


def test_nothing_crosses_a_curved_plate_that_moves(tmp_path):
    """A bowed line is pushed through still water, which flows past its lower end; by 1.5 spacings within 0.3 s."""
    low, path = 0.06, tmp_path / "push.txt"
    times = np.linspace(0.0, 0.6, 61)
    shifts = 0.06 * np.sin(0.5 * np.pi * times / 0.6) ** 2
    np.savetxt(path, np.column_stack([times, shifts, 0.0 * times]), delimiter=",")
    heights = np.linspace(low, 0.46, 24)
    across = 0.5 + 0.06 * np.sin(np.pi * (heights - low) / 0.4)
    line = [(float(x), float(y)) for x, y in zip(across, heights, strict=True)]
    wet = [*(point for point in line if point[1] < 0.3), (float(np.interp(0.3, heights, across)), 0.3)]
    fluid = [{"shape": "polygon", "points": [(x, low), *wet, (x, 0.3)]} for x in (0, 1)]
    wall = {"shape": "polyline", "name": "plate", "points": line, "body": "plate"}
    bodies = {"plate": {"name": "displacement-series", "path": str(path)}}
    simulation = made([wall], [*fluid, region((0, 0), (1, low))], bodies=bodies)

    def is_left():
        x, y = simulation.fields().position.T
        return x < np.interp(simulation.time, times, shifts) + np.interp(y, heights, across)

    left, above = is_left(), simulation.fields().position[:, 1] > low + 2 * SPACING
    while simulation.time < 0.3:
        simulation.advance()
        if simulation.step % 20 == 0:
            np.testing.assert_array_equal(is_left()[above], left[above])
            assert_momentum_is_conserved(simulation)
    assert simulation.particles_outside() == 0
    load = simulation.wall_loads()["plate"]
    assert load.force[0] < -20.0  # the water resists
    assert load.force_by_pressure[0] == pytest.approx(load.force[0], abs=0.1 * RHO_G * 0.3 * SPACING)


def test_a_restored_run_with_a_moving_gate_has_the_same_bits(tmp_path):
    one, other = gate(tmp_path), gate(tmp_path)
    advance(one, 0.08)
    other.restore(one.state())
    for simulation in (one, other):
        advance(simulation, 0.1)
    np.testing.assert_array_equal(one.fields().position, other.fields().position)


def test_bodies_under_load_beside_lines_and_probes_on_lines_are_refused():
    hull = {"shape": "polygon", "name": "hull", "body": "hull", "closed": True}
    hull["points"] = ((0.7, 0.25), (0.8, 0.25), (0.8, 0.4), (0.7, 0.4))
    body = {"name": "free", "mass": 8.0, "inertia": 0.1, "centre": (0.75, 0.32)}
    below = [region((0, 0), (0.5, 0.2)), region((0.5, 0), (1, 0.2))]
    with pytest.raises(InputError, match="'plate' is a line without thickness, and body 'hull'"):
        made([plate((0.5, 0), (0.5, 0.48)), hull], below, bodies={"hull": body})
    with pytest.raises(InputError, match=r"probe 'p' .* is on a wall without thickness"):
        basins(probes=[{"name": "p", "position": (0.5, 0.1)}])


def test_treatments_with_particles_on_the_walls_refuse_thin_walls():
    with pytest.raises(InputError, match=r"the wall at \(0.5, .* is thinner than the kernel's support"):
        basins(wall_treatment="lennard-jones")


def test_ghosts_that_are_filled_where_they_are_see_their_own_side():
    simulation = basins(interpolator="adami")
    advance(simulation, 0.05)
    assert largest_speed(simulation) < 0.05 * np.sqrt(9.81 * 0.4)


@pytest.mark.parametrize(
    ("wall", "message"),
    [
        (plate((0.5, 0.1), (0.5, 0.5), (0.6, 0.5)), "wall 'plate' has fluid on both sides.*a polyline"),
        (plate((0.2, 0), (0.2, 0.5)), "wall 'plate' runs through the fluid"),
        (
            {"shape": "ellipse", "name": "plate", "centre": (0.7, 0.2), "semi_axes": (0.1, 0.02)},
            "thinner than .* 0.078 m",
        ),
    ],
)
def test_walls_that_cannot_hold_water_are_refused(wall, message):
    with pytest.raises(InputError, match=message):
        made([wall], [region((0, 0), (0.4, 0.3))])
