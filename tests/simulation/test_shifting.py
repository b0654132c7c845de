"""Particle shifting, the free surface, and the control of the tensile instability."""

from typing import Any

import numba
import numpy as np
import pytest

from sphframe import InputError
from sphframe.cases import Custom
from sphframe.geometry import BoxRegion, BoxWall, PolygonRegion, PolygonWall
from sphframe.physics.shifting import smallest_eigenvalue
from sphframe.simulation.simulation import Simulation

DX = 0.05


def closed_box(**parameters: Any) -> Custom:
    corners = [(0, 0), (0.6, 0), (0.6, 0.6), (0, 0.6)]
    return Custom(
        **{"particle_spacing": DX, "until": 1.0, "gravity": 0.0, "sound_speed": 20.0, "shifting": 1.0, **parameters},
        walls=[PolygonWall(name="box", points=corners, closed=True)],
        fluid=[PolygonRegion(points=corners, pressure=500.0)],
    )


def tank(**parameters: Any) -> Custom:
    return Custom(
        **{"particle_spacing": DX, "until": 1.0, "shifting": 1.0, **parameters},
        walls=[PolygonWall(name="tank", points=[(0, 1), (0, 0), (0.8, 0), (0.8, 1)])],
        fluid=[PolygonRegion(points=[(0, 0), (0.8, 0), (0.8, 0.6), (0, 0.6)])],
    )


def found(simulation: Simulation) -> Any:
    system = simulation.system
    return system.loops.shifting.find(system.rows, system.lists, system.parameters)  # type: ignore[union-attr]


def jittered(simulation: Simulation, size: float) -> None:
    """Move the particles at random, by ``size`` spacings, and update lists, pressures and ghosts."""
    system = simulation.system
    random = np.random.default_rng(4)
    system.rows[: system.fluid_count, :2] += size * DX * random.uniform(-1.0, 1.0, (system.fluid_count, 2))
    system.find_neighbours()
    system.evaluate(0.0)


def crowding_of(simulation: Simulation) -> tuple[Any, Any, Any]:
    """Matrix, sum of gradients and sum of the shift by NumPy, from all pairs, for the Gaussian kernel."""
    system, p = simulation.system, simulation.parameters
    n, kernel = system.fluid_count, simulation.components.compiled_kernel
    x = system.rows[None, :, :2] - system.rows[:n, None, :2]
    r = np.linalg.norm(x, axis=2)
    q = np.where((r < p.support) & (r > 0.0), r / p.smoothing_length, 0.0)
    value = np.vectorize(kernel.value.py_func if hasattr(kernel.value, "py_func") else kernel.value)
    slope = np.vectorize(kernel.gradient.py_func if hasattr(kernel.gradient, "py_func") else kernel.gradient)
    inside = (r < p.support) & (r > 0.0)
    weight = np.where(inside, -p.gradient_scale * slope(q), 0.0) * system.rows[None, :, simulation.columns.volume]
    near = np.where(inside, value(q), 0.0) / value(DX / p.smoothing_length)
    matrix = np.einsum("ij,ija,ijb->iab", weight, x, x)
    crowded = np.einsum("ij,ija->ia", weight * (1.0 + 0.2 * near**4), x)
    return matrix, np.einsum("ij,ija->ia", weight, x), crowded


def test_a_lattice_is_not_shifted() -> None:
    simulation = Simulation(closed_box(), threads=1)
    before = simulation.fields().position
    simulation._shift(1.0, 0.01)
    assert np.abs(simulation.fields().position - before).max() < 1e-12 * DX
    assert found(simulation)[0] == pytest.approx(1.0, abs=0.02)


def test_the_shift_is_that_of_all_pairs_and_is_limited() -> None:
    simulation = Simulation(closed_box(), threads=1)
    jittered(simulation, 0.2)
    system, p = simulation.system, simulation.parameters
    matrix, sums, crowded = crowding_of(simulation)
    eigenvalues, own_sums, crowding, normals = found(simulation)
    np.testing.assert_allclose(eigenvalues, np.linalg.eigvalsh(matrix)[:, 0], rtol=1e-9)
    np.testing.assert_allclose(own_sums[:, :2], sums, atol=1e-9 * np.abs(sums).max())
    np.testing.assert_allclose(crowding[:, :2], crowded, atol=1e-9 * np.abs(crowded).max())
    assert not normals.any(), "there is no free surface in a closed box"
    speed, interval = 0.3, 0.01
    expected = -2.0 * p.smoothing_length * speed * crowded
    size = np.linalg.norm(expected, axis=1)
    expected *= np.minimum(1.0, 0.5 * speed / size)[:, None] * interval
    before = system.rows[: system.fluid_count].copy()
    simulation._shift(speed, interval)
    moved = system.rows[: system.fluid_count] - before
    np.testing.assert_allclose(moved[:, :2], expected, atol=1e-12)
    assert not moved[:, simulation.columns.mass].any(), "masses stay"


def test_a_shifted_particle_takes_the_fields_of_its_new_place() -> None:
    simulation = Simulation(closed_box(), threads=1)
    jittered(simulation, 0.1)
    system, p, columns = simulation.system, simulation.parameters, simulation.columns
    n, density = system.fluid_count, columns.density
    fluid = system.rows[:n]
    fluid[:, density] += 20.0 * fluid[:, 0]
    fluid[:, columns.u] = 3.0 * fluid[:, 1]
    before = fluid.copy()
    simulation._shift(0.3, 0.001)
    shift = (fluid - before)[:, :2]
    half = before[:, :2] + 0.5 * shift  # the sums are those half way
    x = np.vstack([half, system.rows[n:, :2]])[None] - half[:, None]
    r = np.linalg.norm(x, axis=2)
    inside = (r < p.support) & (r > 0.0)
    kernel = simulation.components.compiled_kernel.gradient
    slope = np.vectorize(kernel.py_func if hasattr(kernel, "py_func") else kernel)
    weight = np.where(inside, -p.gradient_scale * slope(np.where(inside, r / p.smoothing_length, 0.0)), 0.0)
    gradient = (weight * system.rows[None, :, columns.volume])[..., None] * x
    moves = np.vstack([shift, np.zeros((simulation.ghost_count, 2))])
    for column in (density, columns.u):
        f = np.concatenate([before[:, column], system.rows[n:, column]])[None], before[:, column, None]
        flux = np.einsum("ija,ija->i", gradient, f[0][..., None] * moves[None] + f[1][..., None] * shift[:, None])
        carried = f[1][:, 0] * np.einsum("ija,ija->i", gradient, moves[None] - shift[:, None])
        np.testing.assert_allclose((fluid - before)[:, column], flux - carried, atol=1e-9 * np.abs(flux).max())


@pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
@pytest.mark.parametrize("tensile_control", ["off", "on"])
def test_water_beyond_a_plate_does_not_count(tensile_control: str) -> None:
    """Shifts and fields of the water on the left are the same with and without water on the right."""
    ends = []
    for right in (0.3, 0.5):
        case = Custom(
            particle_spacing=DX, until=1.0, shifting=1.0, tensile_control=tensile_control, tension="free",
            walls=[
                PolygonWall(name="tank", points=[(0, 1), (0, 0), (1.2, 0), (1.2, 1)]),
                PolygonWall(name="plate", points=[(0.6, 0), (0.6, 0.9)]),
            ],
            fluid=[
                PolygonRegion(points=[(0, 0), (0.6, 0), (0.6, 0.5), (0, 0.5)]),
                PolygonRegion(points=[(0.6, 0), (1.2, 0), (1.2, right), (0.6, right)]),
            ],
            time_step=1e-3, sound_speed=20.0,
        )  # fmt: skip
        simulation = Simulation(case, threads=1)
        left = simulation.fields().position[:, 0] < 0.6
        rows = simulation.system.rows[: simulation.fluid_count]
        beside = rows[:, 0] < 0.6
        rows[beside, :2] += 0.1 * DX * np.sin(40.0 * rows[beside, :2] + 3.0 * rows[beside, 1::-1])
        simulation.system.find_neighbours()
        simulation.system.evaluate(0.0)
        for _ in range(3):
            simulation.advance()
        fields = simulation.fields()
        ends.append(np.column_stack([fields.position, fields.velocity, fields.density])[left])
    np.testing.assert_allclose(*ends, rtol=0.0, atol=1e-9)


def test_a_lattice_that_repeats_itself_is_not_shifted() -> None:
    case = Custom(
        particle_spacing=DX, until=1.0, gravity=0.0, sound_speed=20.0, shifting=1.0, periodic=("x", "y"), depth=0.6,
        kinematic_viscosity=0.01,  # as in periodic flows, whose loops are compiled for other tests as well
        domain=((0.0, 0.0), (0.6, 0.6)), walls=[],
        fluid=[BoxRegion(lower=(0, 0), upper=(0.6, 0.6), pressure=500.0)],
    )  # fmt: skip
    simulation = Simulation(case, threads=1)
    eigenvalues, sums, crowding, normals = found(simulation)
    assert eigenvalues == pytest.approx(1.0, abs=0.02)
    assert np.abs(sums).max() * DX < 1e-12
    assert np.abs(crowding).max() * DX < 1e-12
    assert not normals.any()


def test_disorder_decreases() -> None:
    simulation = Simulation(closed_box(), threads=1)
    jittered(simulation, 0.25)
    unevenness = []
    for _ in range(30):
        unevenness.append(float(np.square(found(simulation)[1]).mean()))
        simulation._shift(1.0, 0.005)
        simulation.system.find_neighbours()
    assert unevenness[-1] < 0.1 * unevenness[0]


def test_a_free_surface_is_found_and_not_blurred() -> None:
    simulation = Simulation(tank(), threads=1)
    system = simulation.system
    order = np.argsort(system.ids)
    height = simulation.fields().position[:, 1]
    eigenvalues, _, _, normals = (array[order] for array in found(simulation))
    top = height > 0.6 - DX
    assert np.all(eigenvalues[top] < 0.75)
    assert np.all(eigenvalues[~top & (height < 0.5)] > 0.9)
    middle = np.abs(simulation.fields().position[:, 0] - 0.4) < 0.06
    upward = np.broadcast_to([0.0, 1.0], (np.sum(top & middle), 2))
    np.testing.assert_allclose(normals[top & middle, :2], upward, atol=1e-9)
    assert not normals[height < 0.25].any()
    before = simulation.fields().position
    simulation._shift(1.0, 0.01)
    shift = simulation.fields().position - before
    assert np.abs(shift[middle]).max() < 1e-9, "across the surface nothing moves"


def test_eigenvalues_in_three_dimensions() -> None:
    random = np.random.default_rng(1)
    for _ in range(20):
        a = random.normal(size=(3, 3))
        a = a @ a.T
        lowest = smallest_eigenvalue(a[0, 0], a[0, 1], a[1, 1], a[0, 2], a[1, 2], a[2, 2])
        assert lowest == pytest.approx(np.linalg.eigvalsh(a)[0], abs=1e-9)
    assert smallest_eigenvalue(2.0, 0.0, 2.0, 0.0, 0.0, 2.0) == 2.0


def test_a_block_in_three_dimensions() -> None:
    case = Custom(
        particle_spacing=0.1, until=1.0, dimension=3, shifting=1.0, gravity=0.0, sound_speed=20.0,
        walls=[BoxWall(name="box", lower=(0, 0, 0), upper=(0.8, 0.8, 1.0))],
        fluid=[BoxRegion(lower=(0, 0, 0), upper=(0.8, 0.8, 0.8))],
    )  # fmt: skip
    simulation = Simulation(case, threads=1)
    eigenvalues, _, _, normals = found(simulation)
    height = simulation.system.rows[: simulation.fluid_count, 2]
    assert np.all(eigenvalues[height > 0.7] < 0.75)
    assert np.all(eigenvalues[height < 0.5] > 0.9)
    np.testing.assert_allclose(normals[height > 0.7][:, 2], 1.0, atol=0.05)


def test_tensile_control_takes_differences_where_the_pressure_is_negative() -> None:
    rates = []
    for control in ("off", "on"):
        simulation = Simulation(closed_box(tensile_control=control), threads=1)
        system, columns = simulation.system, simulation.columns
        system.rows[: system.fluid_count, columns.density] -= 5.0 * (system.rows[: system.fluid_count, 0] > 0.3)
        jittered(simulation, 0.1)
        rates.append(system.rates[np.argsort(system.ids), 2:4].copy())
    pressure = system.rows[: system.fluid_count, columns.pressure]
    assert (pressure < 0.0).any()
    assert (pressure > 0.0).any()
    _, sums, _ = crowding_of(simulation)
    density = system.rows[: system.fluid_count, columns.density]
    change = np.where(pressure < 0.0, 2.0 * pressure / density, 0.0)[:, None] * sums
    np.testing.assert_allclose(rates[1] - rates[0], change[np.argsort(system.ids)], atol=1e-9 * np.abs(change).max())


@pytest.mark.parametrize("threads", [1, pytest.param(2, marks=pytest.mark.long)])
def test_the_same_bits_with_threads_and_after_a_restart(threads: int) -> None:
    case = tank(tensile_control="on", acceleration=[2.0, 0.0])
    states = []
    for count in sorted({1, min(threads, numba.config.NUMBA_NUM_THREADS)}):  # type: ignore[attr-defined]
        simulation = Simulation(case, threads=count)
        for _ in range(10):
            simulation.advance()
        saved = simulation.state()
        for _ in range(10):
            simulation.advance()
        states.append(simulation.state())
    other = Simulation(case, threads=1)
    other.restore(saved)
    for _ in range(10):
        other.advance()
    states.append(other.state())
    for state in states[1:]:
        for name, array in states[0].items():
            if name != "clocks":
                assert np.array_equal(array, state[name]), name


def test_walls_without_layers_are_refused() -> None:
    with pytest.raises(InputError, match="shifting and tensile_control need walls with layers of ghosts"):
        Simulation(tank(wall_treatment="lennard-jones"))
