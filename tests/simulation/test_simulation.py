"""The simulation as a whole: rest, sound, threads, stop rules, three dimensions."""

import math

import numba
import numpy as np
import pytest
from scipy.signal import find_peaks

import sphframe
from sphframe.cases import Custom, load_case
from sphframe.simulation import Simulation
from sphframe.simulation.rest_state import pressure_at_depth

SMALL = {"particle_spacing": 0.03, "until": 0.2}


def tank(**overrides):
    return load_case("hydrostatic-tank", preset=None, overrides={**SMALL, **overrides})


def advance_to(simulation, time):
    while simulation.time < time:
        simulation.advance()


def test_rest_pressure_is_the_closed_form_of_the_linear_equation_of_state():
    depth = np.linspace(-0.1, 0.3, 50)
    pressure = pressure_at_depth(depth, lambda p, rho0, c0: rho0 + p / c0**2, 1000.0, 20.0, 9.81)
    expected = np.where(depth > 0, 1000.0 * 400.0 * np.expm1(9.81 * depth / 400.0), 0.0)
    np.testing.assert_allclose(pressure, expected, rtol=1e-8, atol=1e-6)


@pytest.mark.parametrize("integrator", ["symplectic", "rk4"])
def test_still_water_stays_still(integrator):
    simulation = Simulation(tank(integrator=integrator, particle_spacing=0.025), threads=1)  # divides the tank
    advance_to(simulation, 0.2)
    fields = simulation.fields()
    assert np.abs(fields.velocity).max() < 0.02
    expected = pressure_at_depth(
        0.3 - fields.position[:, 1], lambda p, r, c: r + p / c**2, 1000.0, simulation.sound_speed, 9.81
    )
    assert np.sqrt(np.mean((fields.pressure - expected) ** 2)) < 0.02 * 2943.0
    assert simulation.particles_outside() == 0


@pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
def test_three_dimensions_rest():
    case = load_case(
        "hydrostatic-tank", preset=None, overrides={"dimension": 3, "particle_spacing": 0.05, "until": 0.1}
    )
    simulation = Simulation(case, threads=1)
    advance_to(simulation, 0.1)
    fields = simulation.fields()
    expected = 9810.0 * (0.3 - fields.position[:, 2])
    assert np.sqrt(np.mean((fields.pressure - expected) ** 2)) < 0.02 * 2943.0
    assert simulation.particles_outside() == 0


@pytest.mark.parametrize("dimension", [2, pytest.param(3, marks=pytest.mark.long)])
def test_threads_give_the_same_bits(dimension):
    threads = min(2, numba.config.NUMBA_NUM_THREADS)
    if threads < 2:
        pytest.skip("one core only: nothing to compare")
    states = []
    for count in (1, threads):
        overrides = {"particle_spacing": 0.06, "until": 0.05, "dimension": dimension}
        simulation = Simulation(load_case("dam-break", preset=None, overrides=overrides), threads=count)
        advance_to(simulation, 0.05)
        states.append((simulation.fields(), simulation.ghost_fields(), simulation.wall_forces()))
    for one, other in zip(states[0][:2], states[1][:2], strict=True):
        for a, b in zip(one, other, strict=True):
            np.testing.assert_array_equal(a, b)
    for wall in states[0][2]:
        np.testing.assert_array_equal(states[0][2][wall][0], states[1][2][wall][0])


def test_sound_runs_up_and_down_the_tank():
    """Started without pressure, the bottom pressure is a triangle wave of period 4 H / c0 between 0 and 2 rho g H."""
    depth, spacing, speed = 0.4, 0.02, 20.0
    case = Custom(
        particle_spacing=spacing,
        walls=[{"shape": "polygon", "points": [(0, 0.8), (0, 0), (0.2, 0), (0.2, 0.8)]}],
        fluid=[{"shape": "box", "lower": (0, 0), "upper": (0.2, depth)}],
        probes=[{"name": "bottom", "position": (0.1, 0.0)}],
        sound_speed=speed,
        until=0.45,
        frame_interval=1.0,
        probe_interval=0.001,
    )
    simulation = Simulation(case, threads=1)
    fluid, columns = simulation.system.rows[: simulation.fluid_count], simulation.columns
    fluid[:, columns.density] = 1000.0
    fluid[:, columns.mass] = 1000.0 * spacing**2
    times, pressures = [], []
    simulation.system.evaluate(0.0)
    while simulation.time < case.until:
        simulation.advance()
        times.append(simulation.time)
        pressures.append(simulation.probe_pressures()[0])
    peaks, _ = find_peaks(pressures, distance=len(times) // 8)
    period = np.mean(np.diff(np.array(times)[peaks]))
    assert period == pytest.approx(4 * depth / speed, rel=0.02)
    assert max(pressures) == pytest.approx(2 * 9810 * depth, rel=0.1)


def test_runaway_state_stops_with_its_place():
    simulation = Simulation(tank(), threads=1)
    simulation.system.rows[5, simulation.columns.velocity] = np.nan
    with pytest.raises(sphframe.SimulationError) as caught:
        advance_to(simulation, 0.01)
    assert caught.value.step is not None
    assert "finite" in str(caught.value)


def test_fields_keep_the_original_order():
    simulation = Simulation(tank(), threads=1)
    before = simulation.fields().position
    simulation.system.find_neighbours()
    np.testing.assert_array_equal(simulation.fields().position, before)


def test_reading_a_simulation_changes_no_step():
    one, other = Simulation(tank(), threads=1), Simulation(tank(), threads=1)
    for _ in range(20):
        one.advance()
        other.advance()
        other.probe_pressures(), other.energies(), other.wall_forces(), other.gauge_readings()
    np.testing.assert_array_equal(one.fields().position, other.fields().position)
    np.testing.assert_array_equal(one.fields().pressure, other.fields().pressure)


def test_a_particle_behind_a_wall_is_put_back_on_it():
    simulation = Simulation(tank(), threads=1)
    rows, c = simulation.system.rows, simulation.columns
    left = int(np.argmin(rows[: simulation.fluid_count, 0]))
    rows[left, c.position.start], rows[left, c.velocity] = -0.004, (-1.0, 0.5)
    assert simulation.system.put_back() == 1
    np.testing.assert_allclose(rows[left, c.position.start], 0.0, atol=1e-15)
    np.testing.assert_allclose(rows[left, c.velocity], [0.0, 0.5], atol=1e-12)
    assert simulation.system.put_back() == 0


def test_many_particles_are_put_back_by_several_threads_with_the_same_bits(monkeypatch):
    """From ``LONG`` rows on, pressures and the particles behind walls are computed by several threads."""
    found = []
    for least in (10**9, 0):
        monkeypatch.setattr("sphframe.simulation.system.LONG", least)
        simulation = Simulation(tank())
        rows = simulation.system.rows
        fluid = rows[: simulation.fluid_count]
        fluid[fluid[:, 0] < 0.03, 0] = -0.004
        simulation.system.update_pressure()
        assert simulation.system.put_back() > 5
        found.append(rows.copy())
    np.testing.assert_array_equal(*found)


def test_wall_force_of_still_water():
    simulation = Simulation(tank(particle_spacing=0.01), threads=1)
    walls = simulation.wall_forces()
    reaction = np.sum([force[0] for force in walls.values()], axis=0)
    integral = np.sum([force[1] for force in walls.values()], axis=0)
    weight = 1000.0 * 9.81 * 0.3 * 1.0
    np.testing.assert_allclose([reaction[1], integral[1]], -weight, rtol=0.01)
    assert math.isclose(reaction[0], 0.0, abs_tol=0.01 * weight)


def test_run_returns_its_dataset(tmp_path):
    run = sphframe.run("hydrostatic-tank", output=tmp_path / "tank.nc", threads=1, **SMALL | {"until": 0.06})
    assert run.dataset.probe_pressure.sizes["probe_time"] == run.dataset.probe_time.size > 5
    assert float(run.dataset.time[-1]) == pytest.approx(0.06, abs=run.case.frame_interval)
    again = sphframe.run(run.path, output=tmp_path / "again.nc", threads=1)
    for name in ("position", "velocity", "density", "pressure", "probe_pressure"):
        np.testing.assert_array_equal(run.dataset[name], again.dataset[name])
    run.dataset.close()
    again.dataset.close()
