"""A flow that is moved, turned, reflected, scaled or renumbered is the same flow, also if its wall is cut in two."""

from dataclasses import dataclass
from itertools import permutations
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from sphframe import Simulation
from sphframe.cases import Custom
from sphframe.geometry import BoxRegion, BoxWall, PolygonWall

from .scenes import DX, Swirl, drive

pytestmark = pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
Array = NDArray[np.float64]
CELLS = {2: np.array([6, 5]), 3: np.array([5, 4, 4])}
CORNERS = np.array([[-0.6, 1.4], [0.0, 0.0], [0.6, 0.0], [0.6, 1.4]])
"""of a tank so high that its open ends, which go on upwards whatever is turned, are out of reach"""


@dataclass
class Change:
    """x' = shift + length Q x, with other units of time and density, and the particles in another order.

    Outlines are snapped to a grid of 1e-6 spacings, so that shifts are multiples of it.
    """

    dim: int
    shift: Any = 0.0
    turn: Any = None
    length: float = 1.0
    time: float = 1.0
    density: float = 1.0
    order: Any = None
    cut: bool = False
    slides: bool = True
    """whether the second wall slides; else the ghosts behind the corner belong to the first wall or the second"""

    @property
    def parity(self) -> float:
        """-1 for a reflection."""
        return 1.0 if self.turn is None else float(np.linalg.det(self.turn))

    def vectors(self, of: Array, length: int = 1, time: int = 0, density: int = 0) -> Array:
        """Return vectors (..., dim) of a quantity with these powers of the units."""
        matrix = np.eye(self.dim) if self.turn is None else self.turn
        return self.length**length * self.time**time * self.density**density * (of @ matrix.T)

    def points(self, of: Array) -> Array:
        """Return where points are."""
        return self.shift + self.vectors(of)


def walls_of(change: Change) -> list[Any]:
    """A tank with a slope whose rest slides, in 3-D a box without a lid."""
    if change.dim == 2:
        corners = [tuple(point) for point in change.points(CORNERS)]
        slides = tuple(change.vectors(change.slides * np.array([0.3, -0.2]), 1, -1))
        first = [PolygonWall(name="slope", points=corners[:2])]
        if change.cut:
            middle = tuple(np.add(corners[1], corners[2]) / 2.0)
            first.append(PolygonWall(name="half", points=[corners[1], middle], surface_velocity=slides))
            corners[1] = middle
        return [*first, PolygonWall(name="rest", points=corners[1:], surface_velocity=slides)]
    lower, upper = np.sort(change.points(np.array([[0.0] * 3, DX * (CELLS[3] + np.array([0, 0, 2]))])), axis=0)
    up = change.vectors(np.eye(3)[2]).round(9)
    axis = int(np.argmax(np.abs(up)))
    face = ("+" if up[axis] > 0 else "-") + "xyz"[axis]
    return [BoxWall(name="tank", lower=tuple(lower), upper=tuple(upper), open_faces=(face,))]


def moved(change: Change, seed: int, steps: int = 3) -> tuple[Array, Array, Array, Array, Array]:
    """Make some steps; return positions, velocities and densities in one order, and force and moment on all walls."""
    dim, random = change.dim, np.random.default_rng(seed)
    lower, upper = np.sort(change.points(np.array([np.zeros(dim), DX * CELLS[dim]])), axis=0)
    case = Custom(
        dimension=dim, particle_spacing=DX * change.length, walls=walls_of(change),
        fluid=[BoxRegion(lower=tuple(lower), upper=tuple(upper))], until=change.time, time_step=1e-3 * change.time,
        sound_speed=20.0 * change.length / change.time, reference_density=1000.0 * change.density,
        smoothing_length_ratio=1.3, gravity=0.0, domain=((-99.0,) * dim, (99.0,) * dim),
    )  # fmt: skip
    run = Simulation(case, threads=1)
    system, columns, n = run.system, run.columns, run.fluid_count
    assert n == np.prod(CELLS[dim])
    grid = np.stack(np.meshgrid(*map(np.arange, CELLS[dim]), indexing="ij"), axis=-1).reshape(-1, dim)
    position = DX * (grid + random.uniform(0.3, 0.7, grid.shape))
    velocity = random.normal(size=grid.shape)
    density, mass = 1000.0 + random.normal(size=n), 1000.0 * DX**dim * random.uniform(0.9, 1.1, n)
    origin, gradient = 9.0 * random.normal(size=dim), 5.0 * random.normal(size=(dim, dim))
    order = np.arange(n) if change.order is None else change.order
    system.ids[:] = np.arange(n)
    rows = system.rows[:n]
    rows[order, columns.position] = change.points(position)
    rows[order, columns.velocity] = change.vectors(velocity, 1, -1)
    rows[order, columns.density] = density * change.density
    rows[order, columns.mass] = mass * change.density * change.length**dim
    slope = change.vectors(change.vectors(gradient, 0, -1).T, 0, -1).T  # Q G Q^T
    force = change.vectors(origin, 1, -2) - slope @ (change.shift * np.ones(dim))
    drive(run, Swirl(force, slope, 3.0 / change.time))
    system.find_neighbours()
    system.evaluate(0.0)
    for _ in range(steps):
        run.advance()
    fields = run.fields()
    system.update_loads()
    loads = system.loads.sum(axis=0)
    return fields.position[order], fields.velocity[order], fields.density[order], loads[:dim], loads[dim:]


def assert_same_flow(change: Change, seed: int) -> None:
    """Compare the flow with that which is not changed."""
    dim = change.dim
    x, u, rho, force, moment = moved(Change(dim, slides=change.slides), seed)
    arm, force = change.shift * np.ones(dim), change.vectors(force, dim + 1, -2, 1)
    if dim == 3:
        moment = change.parity * change.vectors(moment, dim + 2, -2, 1)
    else:
        moment = change.parity * change.length ** (dim + 2) / change.time**2 * change.density * moment
    expected = (
        change.points(x) - arm, change.vectors(u, 1, -1), change.density * (rho - 1000.0), force,
        moment + np.atleast_1d(np.cross(arm, force) if dim == 3 else arm[0] * force[1] - arm[1] * force[0]),
    )  # fmt: skip
    found = moved(change, seed)
    found = (found[0] - arm, found[1], found[2] - 1000.0 * change.density, *found[3:])
    for name, one, other in zip(("position", "velocity", "density", "force", "moment"), found, expected, strict=True):
        scale = np.abs(other).max()
        assert np.abs(one - other).max() < 1e-9 * scale, f"{name} differs by {np.abs(one - other).max() / scale:.3g}"


@settings(max_examples=4)
@given(st.integers(0, 10**6))
def test_in_the_plane(seed: int) -> None:
    random = np.random.default_rng(seed)
    quarter = np.array([[0.0, -1.0], [1.0, 0.0]])
    for change in (
        Change(2, shift=random.normal(size=2).round(3), order=random.permutation(30)),
        # open ends of walls go on upwards, so that a tank with its opening below would be refused
        Change(2, turn=np.linalg.matrix_power(quarter, int(random.choice([1, 3]))), slides=False),
        Change(2, turn=np.diag([-1.0, 1.0]), slides=False),
        Change(2, length=random.uniform(0.01, 10.0), time=random.uniform(0.01, 10.0), density=random.uniform(0.1, 9.0)),
        Change(2, cut=True),
    ):
        assert_same_flow(change, seed)


@settings(max_examples=2)
@given(st.integers(0, 10**6), st.sampled_from(list(permutations(range(3)))))
def test_in_space(seed: int, axes: tuple[int, ...]) -> None:
    random = np.random.default_rng(seed)
    signs = np.diag(random.choice([-1.0, 1.0], 3))
    assert_same_flow(Change(3, shift=random.normal(size=3).round(3), turn=np.eye(3)[list(axes)] @ signs,
                            order=random.permutation(80)), seed)  # fmt: skip
    assert_same_flow(Change(3, length=7.0, time=0.02, density=0.1), seed)
