"""Gravity of any direction, and accelerations of the fluid."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sphframe import BodyForce, InputError, load_case
from sphframe.bodies import Prescribed
from sphframe.cases import Case, Custom, Scene
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe.simulation.simulation import Simulation

G = 9.81
TANK = ((0.0, 0.3), (0.0, 0.0), (0.4, 0.0), (0.4, 0.3))
WATER = ((0.0, 0.0), (0.4, 0.0), (0.4, 0.2), (0.0, 0.2))


def custom(tank: Any = TANK, water: Any = WATER, **parameters: Any) -> Custom:
    return Custom(
        **{"particle_spacing": 0.02, "until": 1.0, "sound_speed": 30.0, "time_step": 4e-4, "depth": 0.2, **parameters},
        walls=[PolygonWall(name="tank", points=tank)],
        fluid=[PolygonRegion(points=water)],
    )


def advanced(case: Case, steps: int) -> Simulation:
    simulation = Simulation(case, threads=1)
    for _ in range(steps):
        simulation.advance()
    return simulation


def test_a_tank_and_its_gravity_may_be_turned() -> None:
    """(x, y) -> (-y, x) of tank and gravity, for water that is not level; the pressure at a point turns, too."""
    slope = (*WATER[:2], (0.4, 0.1), (0.0, 0.2))
    upright = advanced(custom(water=slope), 60)
    turned = [[(-y, x) for x, y in points] for points in (TANK, slope)]
    lying = advanced(custom(*turned, gravity=(G, 0.0)), 60)
    one, other = upright.fields(), lying.fields()
    assert np.abs(one.velocity).max() > 0.02
    _, nearest = np.unique(
        np.round(np.column_stack([-one.position[:, 1], one.position[:, 0]]), 6), axis=0, return_index=True
    )
    _, order = np.unique(np.round(other.position, 6), axis=0, return_index=True)
    np.testing.assert_allclose(-one.velocity[nearest, 1], other.velocity[order, 0], atol=1e-9)
    np.testing.assert_allclose(one.pressure[nearest], other.pressure[order], atol=1e-4)
    assert upright.energies()["potential"] == pytest.approx(lying.energies()["potential"], rel=1e-9)
    points = np.array([[0.1, 0.02], [0.39, 0.05]])
    for k in range(2):
        seen = lying.sample(np.column_stack([-points[:, 1], points[:, 0]]))[k]
        np.testing.assert_allclose(upright.sample(points)[k], seen, rtol=1e-9)


def test_water_rests_below_a_surface_across_an_oblique_gravity() -> None:
    """p = rho g d below the surface, whose normal is (1, 2): nothing moves, and the walls bear the weight."""
    down = -np.array([1.0, 2.0]) / np.sqrt(5.0)
    water = ((0.0, 0.0), (0.4, 0.0), (0.4, 0.05), (0.0, 0.25))
    simulation = Simulation(custom(water=water, gravity=tuple(G * down)), threads=1)
    fields = simulation.fields()
    depth = (fields.position - (0.0, 0.25)) @ down
    np.testing.assert_allclose(fields.pressure, 1000.0 * 900.0 * np.expm1(G * depth / 900.0), rtol=1e-6, atol=1e-3)
    while simulation.time < 0.3:
        simulation.advance()
    weight = simulation.masses().sum() * G
    assert simulation.energies()["kinetic"] < 1e-4 * weight * 0.2
    np.testing.assert_allclose(simulation.wall_forces()["tank"][0], weight * down, atol=0.02 * weight)


class MovedTank(Case):
    """A tank that moves by ``motion``."""

    motion: Any = None
    particle_spacing: float = 0.02
    until: float = 1.0
    sound_speed: float = 30.0
    time_step: float = 4e-4
    frame_interval: float = 1.0
    probe_interval: float = 1.0

    def scene(self) -> Scene:
        return Scene(
            walls=(PolygonWall(name="tank", points=TANK, body="tank"),),
            fluid=(PolygonRegion(points=WATER),),
            depth=0.2,
            domain=((-1.0, -1.0), (3.0, 3.0)),
            bodies={"tank": Prescribed(self.motion)},
        )


def test_an_accelerated_frame_is_an_accelerated_tank() -> None:
    """X'' = 2 sin(20 t): the fluid moves in its tank as in one at rest with the acceleration -X''."""
    omega, size = 20.0, 2.0

    def motion(t: float) -> tuple[Any, Any, Any]:
        displacement = size / omega * (t - np.sin(omega * t) / omega)
        velocity = size / omega * (1.0 - np.cos(omega * t))
        return (displacement, 0, 0), (velocity, 0, 0), (size * np.sin(omega * t), 0, 0)

    times = np.arange(0.0, 0.4, 0.0005)
    table = tuple((float(t), float(-size * np.sin(omega * t)), 0.0) for t in times)
    moved = advanced(MovedTank(motion=motion), 500)
    shaken = advanced(custom(acceleration={"name": "series", "table": table}), 500)
    shift = motion(moved.time)[0][0]
    one, other = moved.fields(), shaken.fields()
    assert np.abs(other.position - Simulation(custom(), threads=1).fields().position).max() > 0.02
    np.testing.assert_allclose(one.position - (shift, 0.0), other.position, atol=2e-5)
    np.testing.assert_allclose(moved.wall_forces()["tank"][0], shaken.wall_forces()["tank"][0], rtol=0.01, atol=1.0)


class Spring(BodyForce):
    """f = (3, 1) - 5 x, a force with a gradient."""

    def acceleration(self, time: float) -> Any:
        return np.array([3.0 + time, 1.0])

    def gradient(self, time: float) -> Any:
        return np.diag([-5.0, -2.0])


def test_potential_energy_is_the_work_of_the_force() -> None:
    """The force of a plugin, with a gradient, in energy, driving force and restart."""
    simulation = Simulation(custom(acceleration=f"{__name__}:Spring"), threads=1)
    x, y = simulation.fields().position.T
    work = simulation.masses() @ (3.0 * x - 2.5 * x**2 + (1.0 - G) * y - y**2)
    assert simulation.energies()["potential"] == pytest.approx(-work, rel=1e-12)
    boundary = simulation.boundary
    force = np.array([3.0, 1.0 - G]) + boundary.foot * (-5.0, -2.0)
    np.testing.assert_allclose(boundary.driving, 1000.0 * force, rtol=1e-12, atol=1e-9)
    simulation = advanced(simulation.case, 20)
    saved, energies = simulation.state(), simulation.energies()
    simulation.advance()
    other = Simulation(simulation.case, threads=1)
    other.restore(saved)
    assert other.energies() == energies
    other.advance()
    for name, array in simulation.state().items():
        if name != "clocks":
            assert np.array_equal(array, other.state()[name]), name


def test_a_series_is_read_beside_the_case_file(tmp_path: Path) -> None:
    (tmp_path / "shake.txt").write_text("# time (s), x, y\n0, 0, 0\n1, 2, 4\n")
    file = tmp_path / "case.toml"
    file.write_text(
        "particle_spacing = 0.02\nuntil = 1.0\ngravity = [0, -9.81]\n"
        'acceleration = {name = "series", path = "shake.txt"}\n'
        '[[walls]]\nname = "tank"\nshape = "polygon"\npoints = [[0, 0.3], [0, 0], [0.4, 0], [0.4, 0.3]]\n'
        '[[fluid]]\nshape = "polygon"\npoints = [[0, 0], [0.4, 0], [0.4, 0.2], [0, 0.2]]\n'
    )
    case = load_case(file)
    assert "1, 2, 4" in case.acceleration.options["contents"]
    force = case.acceleration.create("body_forces")
    np.testing.assert_allclose(force.acceleration(0.25), [0.5, 1.0])
    np.testing.assert_allclose(force.acceleration(1.5), [0.0, 0.0])


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"gravity": [0.0, 0.0, -9.81]}, "gravity = .* must have 2 components"),
        ({"gravity": [0.0, "down"]}, "gravity\\[1\\] = 'down' must be a valid number"),
        ({"acceleration": [1.0]}, "acceleration: .*must be a vector of 2 finite numbers"),
        (
            {"acceleration": {"name": "series", "table": [[0, 0], [1, 1]]}},
            "2 columns; expected the time and 2 components",
        ),
        ({"acceleration": {"name": "series", "table": [[1, 0, 0], [0, 1, 1]]}}, "times increase"),
        ({"acceleration": "series"}, "either a path"),
        ({"gravity": [1.0, -9.0], "fluid": [PolygonRegion(points=WATER, level=0.3)]}, r"fluid\[0\] has a level"),
    ],
)
def test_forces_that_cannot_be_are_refused(parameters: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        load_case(custom(), overrides=parameters)


def test_a_free_body_is_refused_in_an_accelerated_frame() -> None:
    with pytest.raises(InputError, match="body 'box' is moved by the fluid"):
        load_case("floating-body", overrides={"acceleration": [0.1, 0.0]})
    with pytest.raises(InputError, match=r"gravity = .* must be a valid number"):
        load_case("dam-break", overrides={"gravity": [0.0, -9.81]})
