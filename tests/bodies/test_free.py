"""A free body: what it takes from its case, what is held, and its motion without water."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from sphframe.bodies import Free
from sphframe.interfaces import Solid, Surroundings
from sphframe.simulation.body_states import BodyStates

Array = NDArray[np.float64]
SQUARE = Solid(0.04, np.array([0.5, 0.3]), np.array([[0.2**4 / 6.0]]))
"""a square of 0.2 m"""
BLOCK = Solid(6.0, np.zeros(3), 0.5 * np.diag([13.0, 10.0, 5.0]))
"""a block of 1 m x 2 m x 3 m: V / 12 (b^2 + c^2)"""


def free(solid: Solid | None = SQUARE, dimension: int = 2, gravity: float = 1.62, **options: Any) -> Free:
    return Free(**options).placed(Surroundings(dimension, gravity, solid))


def test_mass_inertia_centre_and_gravity_are_those_of_the_wall_and_the_case() -> None:
    body = free(density=500.0)
    assert body.mass == pytest.approx(20.0)
    assert body.inertia == pytest.approx(20.0 * 0.2**2 / 6.0)
    assert body.centre == (0.5, 0.3)
    nothing = np.zeros(3)
    assert body.motion(0.0, nothing, nothing, nothing).acceleration == pytest.approx([0.0, -1.62, 0.0])
    heavier = free(mass=30.0, gravity=9.81, centre=(0.5, 0.25))
    assert heavier.inertia == pytest.approx(30.0 * 0.2**2 / 6.0)
    assert heavier.centre == (0.5, 0.25)
    kept = Free(mass=1.0, gravity=3.0).placed(Surroundings(2, 1.62, SQUARE))
    assert kept.gravity == 3.0


def test_a_block_in_space_takes_its_tensor() -> None:
    body = free(BLOCK, 3, density=2.0)
    assert np.array(body.inertia) == pytest.approx(np.diag([13.0, 10.0, 5.0]))
    assert body.motion(0.0, *np.zeros((3, 6))).acceleration == pytest.approx([0.0, 0.0, -1.62, 0.0, 0.0, 0.0])


def test_a_tensor_is_symmetric_to_round_off() -> None:
    rows = ((2.0, 0.3, 0.1), (0.3 + 1e-14, 3.0, 0.2), (0.1, 0.2, 4.0))
    body, still, moment = free(BLOCK, 3, mass=1.0, inertia=rows), np.zeros(6), np.array([0.0, 0.0, 0.0, 1.0, -2.0, 3.0])
    angular = body.motion(0.0, still, still, moment).acceleration[3:]
    assert angular == pytest.approx(np.linalg.solve(rows, moment[3:]), rel=1e-12)
    with pytest.raises(ValueError, match="a matrix symmetric"):
        Free(mass=1.0, inertia=((2.0, 0.3, 0.1), (0.3 + 1e-6, 3.0, 0.2), (0.1, 0.2, 4.0)))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"solid": None, "mass": 1.0}, "give inertia, centre; they follow from a density only if its wall is closed"),
        ({}, "give its mass, or its density"),
        ({"mass": 1.0, "centre": (0.0, 0.0, 0.0)}, "centre = .* must have 2 coordinates in 2-D"),
        ({"mass": 1.0, "inertia": (1.0, 1.0, 1.0)}, "must be a number"),
        ({"mass": 1.0, "held": ("z",)}, "refer to the coordinates x, y, angle in 2-D"),
    ],
)
def test_a_body_that_contradicts_its_case_is_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        free(**given)


def moved(body: Free, dim: int, until: float, step: float, load: Array) -> BodyStates:
    """The body under a constant ``load``, advanced as the symplectic scheme does it."""
    states = BodyStates({"body": body}, dim)
    loads = np.array([load])
    states.update_motions(0.0, loads)
    states.update_rates(0.0, loads)
    for k in range(round(until / step)):
        states.kick(0.5 * step)
        states.drift(0.5 * step)
        states.drift(0.5 * step)
        states.update_motions((k + 1) * step, loads)
        states.update_rates((k + 1) * step, loads)
        states.kick(0.5 * step)
    return states


def test_a_body_thrown_upwards_follows_its_parabola() -> None:
    states = moved(free(density=500.0, initial_velocity=(1.0, 2.0, 3.0)), 2, 1.0, 0.01, np.zeros(3))
    assert states.position[0] == pytest.approx([1.0, 2.0 - 0.81, 3.0])


def test_what_is_held_stands_still() -> None:
    states = moved(free(density=500.0, held=("x", "angle"), initial_velocity=(1.0, 0.0, 1.0)), 2, 0.5, 0.01,
                   np.array([7.0, 0.0, 2.0]))  # fmt: skip
    assert states.position[0] == pytest.approx([0.0, -0.5 * 1.62 * 0.25, 0.0])


def test_a_hinged_body_swings_as_a_physical_pendulum() -> None:
    # T = 2 pi sqrt(I_h / (m g l)) for small angles; the hinge lies l = 0.5 m above the centre
    body = free(density=500.0, gravity=9.81, hinge=(0.5, 0.8), initial_velocity=(0.0, 0.0, 1e-3))
    period = 2.0 * np.pi * np.sqrt((20.0 * 0.2**2 / 6.0 + 20.0 * 0.25) / (20.0 * 9.81 * 0.5))
    states = moved(body, 2, 0.25 * period, period / 4000.0, np.zeros(3))
    amplitude = 1e-3 * period / (2.0 * np.pi)
    assert states.position[0, 2] == pytest.approx(amplitude, rel=1e-5)
    assert states.position[0, 0] == pytest.approx(0.5 * np.sin(amplitude), rel=1e-4)
    far = moved(free(density=500.0, gravity=9.81, hinge=(0.5, 0.8), initial_velocity=(0.0, 0.0, 2.0)), 2, 3.0, 1e-3,
                np.zeros(3))  # fmt: skip
    present = np.array([0.5, 0.3]) + far.motions[0].position[:2]
    assert np.linalg.norm(present - [0.5, 0.8]) == pytest.approx(0.5, rel=1e-12)
    energy = 0.5 * (20.0 * 0.2**2 / 6.0 + 5.0) * far.velocity[0, 2] ** 2 + 20.0 * 9.81 * (present[1] - 0.3)
    assert energy == pytest.approx(0.5 * (20.0 * 0.2**2 / 6.0 + 5.0) * 4.0, rel=1e-4)


def energy_and_momentum(states: BodyStates, moments: Array) -> tuple[float, Array]:
    """Kinetic energy and angular momentum of a body with principal ``moments``, by a rotation of its own."""
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_rotvec(states.position[0, 3:]).as_matrix()
    omega = states.velocity[0, 3:]
    momentum = turn @ (moments * (turn.T @ omega))
    return 0.5 * float(omega @ momentum), momentum


def test_a_torque_free_top_conserves_energy_and_angular_momentum() -> None:
    moments, start = np.array([1.0, 2.0, 3.0]), np.array([0.3, 2.0, 0.2])  # about the middle axis: it tumbles
    errors = []
    for step in (0.01, 0.005):
        top = Free(mass=1.0, inertia=(1.0, 2.0, 3.0), centre=(0, 0, 0), gravity=0.0,
                   initial_velocity=(0.0, 0.0, 0.0, *start)).placed(Surroundings(3, 9.81, None))  # fmt: skip
        states = moved(top, 3, 6.0, step, np.zeros(6))
        energy, momentum = energy_and_momentum(states, moments)
        errors.append([abs(energy / (0.5 * start @ (moments * start)) - 1.0),
                       np.linalg.norm(momentum - moments * start) / np.linalg.norm(moments * start)])  # fmt: skip
    assert np.max(errors[1]) < 2e-4
    assert np.all(np.array(errors[1]) < 0.35 * np.array(errors[0])), errors  # of second order
    axes = [turn_about(moved(top, 3, until, 0.01, np.zeros(6)).position[0, 3:])[1, 1] for until in (5.0, 5.5, 6.0)]
    assert min(axes) < -0.5, f"the top has not tumbled {axes}"


def test_a_symmetric_top_precesses_in_a_runge_kutta_scheme_of_fourth_order() -> None:
    # torque-free, I = (2, 2, 1): the axis turns about the angular momentum L at the rate |L| / 2
    moments, start = np.array([2.0, 2.0, 1.0]), np.array([1.0, 0.0, 3.0])
    momentum = moments * start
    exact = turn_about(momentum, np.linalg.norm(momentum) / 2.0 * 2.0) @ np.array([0.0, 0.0, 1.0])
    errors = []
    for step in (0.04, 0.02):
        top = Free(mass=1.0, inertia=(2.0, 2.0, 1.0), centre=(0, 0, 0), gravity=0.0,
                   initial_velocity=(0.0, 0.0, 0.0, *start)).placed(Surroundings(3, 9.81, None))  # fmt: skip
        states = BodyStates({"top": top}, 3)
        for _ in range(round(2.0 / step)):
            runge_kutta_step(states, step)
        errors.append(np.linalg.norm(turn_about(states.position[0, 3:]) @ np.array([0.0, 0.0, 1.0]) - exact))
    assert errors[1] < 1e-5
    assert errors[0] / errors[1] > 12.0


def runge_kutta_step(states: BodyStates, step: float) -> None:
    """One step with the stages of sphframe.integrators.RungeKutta4, without the fluid."""
    states.hold()
    for weight, onward in ((1 / 6, 0.5), (1 / 3, 0.5), (1 / 3, 1.0), (1 / 6, None)):
        states.update_motions(0.0, np.zeros((1, 6)))
        states.update_rates(0.0, np.zeros((1, 6)))
        states.accumulate(weight)
        if onward is None:
            states.advance_total(step)
        else:
            states.advance(onward * step)


def turn_about(vector: Array, angle: float | None = None) -> Array:
    """The rotation matrix by the formula of Rodrigues."""
    size = float(np.linalg.norm(vector))
    x, y, z = vector / size
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    by = size if angle is None else angle
    matrix: Array = np.eye(3) + np.sin(by) * cross + (1.0 - np.cos(by)) * cross @ cross
    return matrix
