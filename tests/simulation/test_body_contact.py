"""Bodies touch walls and each other, are refused when they are too light, and are watched."""

from typing import Any

import numpy as np
import pytest

from sphframe import InputError, Simulation, SimulationError, load_case
from sphframe.cases import Custom
from sphframe.interfaces import Motion

TANK = {"shape": "polygon", "name": "tank", "points": [[0, 0.6], [0, 0], [1, 0], [1, 0.6]]}


def hull(name: str, x: float, y: float, length: float, height: float) -> dict[str, Any]:
    corners = [[x, y], [x, y + height], [x + length, y + height], [x + length, y]]
    return {"shape": "polygon", "name": name, "body": name, "closed": True, "points": corners}


def case(bodies: dict[str, Any], *hulls: dict[str, Any], water: Any = None, **parameters: Any) -> Custom:
    """A tank of 1 m, with water at the left unless it is given, and bodies."""
    fluid = water or [{"shape": "box", "lower": [0, 0], "upper": [0.2, 0.2]}]
    options = {"particle_spacing": 0.04, "until": 2.0, "probe_interval": 0.01, **parameters}
    return Custom(walls=[TANK, *hulls], fluid=fluid, bodies=bodies, **options)


def advanced(simulation: Simulation, until: float) -> Simulation:
    while simulation.time < until:
        simulation.advance()
    return simulation


def around(x: float, y: float, length: float, level: float) -> list[dict[str, Any]]:
    """Water around a hull that reaches through its surface."""
    return [{"shape": "polygon", "points": [[0, 0], [1, 0], [1, level], [x + length, level], [x + length, y], [x, y],
                                            [x, level], [0, level]]}]  # fmt: skip


@pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
class TestContact:
    def test_a_box_that_falls_on_the_bed_rests_there_at_its_static_depth(self) -> None:
        # in a corner of the tank that the collapsing water has not reached
        run = Simulation(
            case({"box": {"name": "free", "density": 3000.0}}, hull("box", 0.7, 0.02, 0.2, 0.12)), threads=1
        )
        advanced(run, 0.2)
        omega = 0.2 * run.sound_speed / run.smoothing_length
        motion = run.body_motions()["box"]
        assert motion.position[1] == pytest.approx(-0.02 - 9.81 / omega**2, abs=2e-5)
        assert motion.position[2] == pytest.approx(0.0, abs=2e-3)  # the points lie unevenly
        assert np.abs(motion.velocity).max() < 1e-3

    def test_a_spring_and_a_damper_push_a_box_back(self) -> None:
        run = Simulation(
            case({"box": {"name": "free", "density": 3000.0}}, hull("box", 0.7, 0.02, 0.2, 0.12)), threads=1
        )
        omega, loads = 0.2 * run.sound_speed / run.smoothing_length, np.zeros((1, 3))
        motion = Motion(np.array([0.0, -0.021, 0.0]), np.array([0.0, -0.3, 0.0]), np.zeros(3))
        run.system.contacts.add_loads([motion], loads)
        mass = 3000.0 * 0.2 * 0.12
        assert loads[0, 1] == pytest.approx(mass * (omega**2 * 0.001 + 2.0 * 0.7 * omega * 0.3), rel=1e-9)

    @pytest.mark.parametrize("turn", [0.3, 1.5, -2.0])
    def test_forces_turn_with_the_bodies(self, turn: float) -> None:
        boxes = {name: {"name": "free", "density": 1000.0} for name in ("one", "two")}
        hulls = hull("one", 0.4, 0.3, 0.12, 0.12), hull("two", 0.6, 0.34, 0.12, 0.16)
        run = Simulation(case(boxes, *hulls), threads=1)
        centres, middle = run.boundary.centres, np.array([0.55, 0.38])
        found = []
        for angle in (0.0, turn):
            matrix = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            motions, loads = [], np.zeros((2, 3))
            for k, u in enumerate((0.5, -0.5)):  # they overlap by a hundredth of a metre, and come nearer
                place = centres[k] - [0.09 * k, 0.0]
                shift = matrix @ (place - middle) + middle - centres[k]
                motions.append(Motion(np.append(shift, angle), np.append(matrix @ [u, 0.0], 0.2), np.zeros(3)))
            run.system.contacts.add_loads(motions, loads)
            found.append(np.column_stack([loads[:, :2] @ matrix, loads[:, 2]]))
        assert found[0][1, 0] > 100.0
        np.testing.assert_allclose(found[1], found[0], rtol=1e-9, atol=1e-9)

    def test_a_box_above_the_end_of_a_wall_does_not_touch_it(self) -> None:
        run = Simulation(
            case({"box": {"name": "free", "density": 1000.0}}, hull("box", 0.7, 0.2, 0.12, 0.12)), threads=1
        )
        loads = np.zeros((1, 3))
        run.system.contacts.add_loads([Motion(np.array([0.24, 0.42, 0.0]), np.zeros(3), np.zeros(3))], loads)
        assert run.system.contacts.deepest is None

    def test_a_box_that_lands_on_an_edge_comes_to_lie_flat(self) -> None:
        turn = 0.2
        corners = (np.array([[-0.1, -0.06], [-0.1, 0.06], [0.1, 0.06], [0.1, -0.06]])
                   @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]) + [0.8, 0.1])  # fmt: skip
        wall = {"shape": "polygon", "name": "box", "body": "box", "closed": True, "points": corners.tolist()}
        run = Simulation(case({"box": {"name": "free", "density": 3000.0}}, wall), threads=1)
        angles = []
        while run.time < 0.3:
            run.advance()
            angles.append(run.body_motions()["box"].position[2])
        assert angles[-1] == pytest.approx(-turn, abs=5e-3)
        assert min(angles) > -turn - 0.1

    def test_two_bodies_that_meet_keep_their_momentum(self) -> None:
        bodies = {
            name: {"name": "free", "density": density, "gravity": 0.0, "initial_velocity": [u, 0.0, 0.0]}
            for name, density, u in (("one", 1000.0, 1.0), ("two", 500.0, -0.5))
        }
        hulls = hull("one", 0.4, 0.3, 0.12, 0.12), hull("two", 0.6, 0.3, 0.12, 0.16)
        run = Simulation(case(bodies, *hulls), threads=1)
        masses = np.array([14.4, 9.6])
        advanced(run, 0.15)
        velocity = np.array([motion.velocity for motion in run.body_motions().values()])
        assert masses @ velocity[:, 0] == pytest.approx(14.4 - 4.8, rel=1e-10)
        assert velocity[1, 0] >= velocity[0, 0] > -0.1, "they have passed through each other"
        gap = 0.6 - 0.52 + np.subtract(*[m.position[0] for m in reversed(run.body_motions().values())])
        assert gap > -0.02

    def test_a_heavy_body_sinks_through_water_to_the_bed_and_stays(self) -> None:
        water = around(0.4, 0.12, 0.2, 0.2)
        run = Simulation(case({"box": {"name": "free", "density": 2500.0}}, hull("box", 0.4, 0.12, 0.2, 0.2),
                              water=water, particle_spacing=0.04), threads=1)  # fmt: skip
        advanced(run, 0.9)
        assert run.body_motions()["box"].position[1] == pytest.approx(-0.12, abs=0.01)
        assert abs(run.body_motions()["box"].velocity[1]) < 0.05

    def test_a_hull_that_is_drawn_into_the_bed_does_not_touch_it(self) -> None:
        run = Simulation(case({"flap": {"name": "free", "density": 3000.0, "hinge": [0.76, 0.0]}},
                              hull("flap", 0.7, -0.04, 0.12, 0.3)), threads=1)  # fmt: skip
        run.advance()
        assert run.system.contacts.deepest is None


@pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
class TestGuards:
    def test_a_body_that_leaves_the_domain_stops_the_run(self) -> None:
        thrown = {"name": "free", "density": 1000.0, "initial_velocity": [0.0, 12.0, 0.0], "gravity": 0.0}
        run = Simulation(case({"box": thrown}, hull("box", 0.7, 0.2, 0.12, 0.12)), threads=1)
        with pytest.raises(SimulationError, match=r"body 'box' has left the domain .*likely causes"):
            advanced(run, 1.0)

    def test_a_body_that_is_too_fast_stops_the_run(self) -> None:
        thrown = {"name": "free", "density": 1000.0, "initial_velocity": [0.0, 20.0, 0.0]}
        with pytest.raises(SimulationError, match=r"body 'box' moves at 20 m/s, above 0.5 c0 = 14.01 m/s"):
            Simulation(case({"box": thrown}, hull("box", 0.7, 0.2, 0.12, 0.12)), threads=1)

    def test_a_body_that_hits_a_wall_too_hard_stops_the_run(self) -> None:
        thrown = {"name": "free", "density": 1000.0, "initial_velocity": [0.0, -12.0, 0.0]}
        run = Simulation(case({"box": thrown}, hull("box", 0.7, 0.1, 0.12, 0.12)), threads=1)
        with pytest.raises(SimulationError, match=r"body 'box' has sunk .* m into wall 'tank'"):
            advanced(run, 1.0)

    def test_a_body_whose_load_is_not_finite_stops_the_run(self) -> None:
        run = Simulation(
            case({"box": {"name": "free", "density": 500.0}}, hull("box", 0.7, 0.2, 0.12, 0.12)), threads=1
        )
        run.system.bodies.velocity[0, 1] = np.nan
        with pytest.raises(SimulationError, match="body 'box'"):
            run.advance()


MOON = """
particle_spacing = 0.04
until = 1.0
gravity = {gravity}
[[walls]]
shape = "polygon"
name = "tank"
points = [[0, 0.6], [0, 0], [1, 0], [1, 0.6]]
[[walls]]
shape = "polygon"
name = "hull"
body = "box"
closed = true
points = [[0.4, 0.2], [0.4, 0.4], [0.6, 0.4], [0.6, 0.2]]
[bodies.box]
name = "free"
{body}
[[fluid]]
shape = "polygon"
points = [[0, 0], [1, 0], [1, 0.3], [0.6, 0.3], [0.6, 0.2], [0.4, 0.2], [0.4, 0.3], [0, 0.3]]
"""


@pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
def test_a_box_on_the_moon_floats_at_rest(tmp_path: Any) -> None:
    path = tmp_path / "moon.toml"
    path.write_text(MOON.format(gravity=1.62, body="mass = 20.0\ninertia = 0.1333\ncentre = [0.5, 0.3]"))
    run = advanced(Simulation(load_case(path), threads=1), 1.0)
    assert np.abs(run.body_motions()["box"].position[:2]).max() < 0.01
    path.write_text(MOON.format(gravity=1.62, body="density = 500.0"))
    body = Simulation(load_case(path), threads=1).scene.bodies["box"]
    assert body.centre == pytest.approx((0.5, 0.3))  # type: ignore[comparison-overlap]
    assert body.mass == pytest.approx(20.0)  # type: ignore[attr-defined]


@pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
def test_a_light_body_is_refused_with_the_least_mass(tmp_path: Any) -> None:
    path = tmp_path / "light.toml"
    path.write_text(MOON.format(gravity=9.81, body="mass = 0.5\ninertia = 0.0033"))
    with pytest.raises(
        InputError, match=r"body 'box' is too light .* its mass is 0.5, and the least is (\d\S*)"
    ) as error:
        Simulation(load_case(path), threads=1)
    least = float(str(error.value).partition("the least is ")[2].partition(";")[0])
    # sway and roll together need most: K = 24 kg/m^2 times 0.2 m for sway, 0.01 m^2 for both, 4/3 * 10^-3 m^3 for roll
    per_mass = 24.0 * np.array([[0.2, 0.01], [0.01, 4e-3 / 3.0]]) / np.array([[1.0], [0.0033 / 0.5]])
    assert least == pytest.approx(np.linalg.eigvals(per_mass).max(), rel=0.08)
    scaled = 1.02 * least / 0.5
    path.write_text(MOON.format(gravity=9.81, body=f"mass = {0.5 * scaled}\ninertia = {0.0033 * scaled}"))
    Simulation(load_case(path), threads=1)
