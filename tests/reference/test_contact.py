"""Particles behind walls that have turned and move are counted, and put back with the velocity of the wall."""

import numpy as np
import pytest

from .scenes import DX, random_scene
from .walls import turn

pytestmark = pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")


@pytest.mark.parametrize("dim", [2, 3])
def test_particles_behind_a_turned_wall(dim: int) -> None:
    run, plain = random_scene(3, dim)
    system, columns = run.system, run.columns
    (place, _, _), centre = plain.walls.bodies[0](0.0), run.boundary.centres[0]
    matrix, down = turn(place), -np.eye(dim)[-1]
    along = np.eye(dim)[0]
    wall_u = np.arange(1.0, dim + 1.0)
    run.boundary.velocity[:] = wall_u
    assert run.particles_outside() == 0
    drawn = np.array([1.5 * DX * np.ones(dim), 2.5 * DX * np.ones(dim)])
    drawn[:, -1] = -0.2 * DX
    pressed = np.flatnonzero(system.ids < 2)
    rows = system.rows[pressed]
    rows[:, columns.position] = (drawn - centre) @ matrix.T + centre + place[:dim]
    rows[0, columns.velocity] = wall_u + matrix @ (0.5 * along + 3.0 * down)  # into the wall
    rows[1, columns.velocity] = wall_u + matrix @ (0.5 * along - 3.0 * down)  # away from it
    system.rows[pressed] = rows
    system.find_neighbours()
    assert run.particles_outside() == 2
    assert system.put_back() == 2
    assert run.particles_outside() == 0
    found = system.rows[np.flatnonzero(system.ids < 2)]
    back = (found[:, columns.position] - centre - place[:dim]) @ matrix + centre
    relative = (found[:, columns.velocity] - wall_u) @ matrix
    assert back[:, -1] == pytest.approx(0.0, abs=1e-12)
    assert sorted(relative[:, -1]) == pytest.approx([0.0, 3.0], abs=1e-12)
    assert relative[:, 0] == pytest.approx(0.5)
