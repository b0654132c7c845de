"""A tank that rolls, moved by a body and seen from the tank."""

import math
from typing import Any

import numpy as np
from sphframe_flows import Roll

from sphframe import Case, Motion, RigidBody
from sphframe.cases import Scene
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe.simulation.simulation import Simulation
from sphframe.testing import parametrize_with_checks

ANGLE, FREQUENCY = 0.06, 9.0
TANK = ((-0.2, 0.3), (-0.2, 0.0), (0.2, 0.0), (0.2, 0.3))


class Rolling(RigidBody):
    """Rolls about the origin."""

    def motion(self, time: float, position: Any, velocity: Any, load: Any) -> Motion:
        turn, (sine, cosine) = np.array([0.0, 0.0, ANGLE]), (math.sin(FREQUENCY * time), math.cos(FREQUENCY * time))
        return Motion(sine * turn, FREQUENCY * cosine * turn, -(FREQUENCY**2) * sine * turn)


class Tank(Case):
    """A tank that rolls, or stands still under the force of the roll; its fluid turns with it at the start."""

    rolls: int = 1
    particle_spacing: float = 0.02
    until: float = 1.0
    sound_speed: float = 30.0
    time_step: float = 4e-4
    frame_interval: float = 1.0
    probe_interval: float = 1.0

    def scene(self) -> Scene:
        rate = ANGLE * FREQUENCY

        def turning(position: Any) -> Any:
            return rate * np.column_stack([-position[:, 1], position[:, 0]])

        return Scene(
            walls=(PolygonWall(name="tank", points=TANK, body="tank" if self.rolls else None),),
            fluid=(PolygonRegion(points=((-0.2, 0.0), (0.2, 0.0), (0.2, 0.16), (-0.2, 0.16))),),
            depth=0.16,
            domain=((-1.0, -1.0), (1.0, 1.0)),
            bodies={"tank": Rolling()} if self.rolls else {},
            initial_velocity=turning if self.rolls else None,
        )


def offsets(case: Case) -> np.ndarray:
    """The mean position of the fluid along the tank over time, m."""
    simulation, found = Simulation(case, threads=1), []
    while simulation.time < 0.5:
        simulation.advance()
        x, y = simulation.fields().position.mean(axis=0)
        angle = ANGLE * math.sin(FREQUENCY * simulation.time) if simulation.case.rolls else 0.0  # type: ignore[attr-defined]
        found.append(math.cos(angle) * x + math.sin(angle) * y)
    return np.array(found)


def test_a_tank_that_rolls_is_one_in_which_gravity_turns() -> None:
    """The Coriolis force is the difference, smaller by the roll angle."""
    force = {"name": "roll", "amplitude": ANGLE, "angular_frequency": FREQUENCY}
    moved, turned = offsets(Tank()), offsets(Tank(rolls=0, acceleration=force))
    assert np.abs(moved).max() > 2e-3
    assert np.abs(moved - turned).max() < 2.0 * ANGLE * np.abs(moved).max()


@parametrize_with_checks([Roll(amplitude=0.1, angular_frequency=2.0)])
def test_roll_has_what_is_expected_of_it(component, check) -> None:  # type: ignore[no-untyped-def]
    check(component)
