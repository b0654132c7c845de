"""Random scenes, small and in disorder, for the solver and for plain NumPy."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sphframe import BodyForce, Simulation
from sphframe.cases import Custom
from sphframe.geometry import BoxRegion, BoxWall, PolygonWall

from .plain import Motion, Plain, improved_shepard, moving_least_squares, normalised, shepard, turn

Array = NDArray[np.float64]
DX = 0.1
WEIGHTS = {
    "improved-shepard": improved_shepard,
    "shepard": shepard,
    "normalized": normalised,
    "mls-linear": moving_least_squares,
}


class Swirl(BodyForce):
    """A force that depends on place and, at a ``rate`` (1/s), on time."""

    def __init__(self, origin: Array, gradient: Array, rate: float = 3.0) -> None:
        self.origin, self.slope, self.rate = origin, gradient, rate

    def acceleration(self, time: float) -> Array:
        """At the origin."""
        return self.origin * (1.0 + self.rate * time)

    def gradient(self, time: float) -> Array:
        """A matrix."""
        return self.slope * (1.0 + self.rate * time)


def drive(run: Simulation, force: Swirl) -> None:
    """Let the force act in a simulation; no case of the core has one that depends on place."""
    run.system._driving._added = force


def motion(random: np.random.Generator, dim: int) -> Callable[[float], Motion]:
    """A body that drifts, turns and speeds up, and is already displaced and turned at the start."""
    size = 3 if dim == 2 else 6
    place, rate, growth = random.normal(size=size), random.normal(size=size), 5.0 * random.normal(size=size)
    if dim == 3:  # about an axis that does not change, so that the turn is the integral of the angular velocity
        axis = random.normal(size=3)
        for vector in (place, rate, growth):
            vector[3:] = axis * vector[3]

    def at(time: float) -> Motion:
        return place + rate * time + 0.5 * growth * time**2, rate + growth * time, growth

    return at


def walls_of(kind: str, dim: int, size: Array) -> list[Any]:
    """A tank without a lid: one box, or in 2-D a slope and the rest, which share two corners; the last one moves."""
    if kind == "box":
        return [BoxWall(name="tank", lower=(0.0,) * dim, upper=tuple(size), open_faces=("+z" if dim == 3 else "+y",),
                        body="tank")]  # fmt: skip
    length, height = size
    body = None if kind == "at rest" else "tank"
    return [
        PolygonWall(name="side", points=[(-0.2, height), (0.0, 0.0)], body=body),
        PolygonWall(name="rest", points=[(0.0, 0.0), (length, 0.0), (length, height)], body=body,
                    surface_velocity=None if body else (0.7, -0.4)),
    ]  # fmt: skip


def random_scene(seed: int, dim: int, walls: str = "box", **options: Any) -> tuple[Simulation, Plain]:
    """The same random state for the solver and for plain NumPy."""
    random = np.random.default_rng(seed)
    cells = random.integers([4, 4, 4][:dim], [8, 7, 5] if dim == 3 else [9, 8])
    size = DX * (cells + np.eye(dim)[-1] * 1.0)
    drift, centre = motion(random, dim), random.normal(size=dim)
    drawn = walls_of(walls, dim, size)
    moves = drawn[0].body is not None
    case = Custom(
        dimension=dim, particle_spacing=DX, walls=drawn, fluid=[BoxRegion(lower=(0.0,) * dim, upper=tuple(DX * cells))],
        bodies={"tank": {"name": "prescribed", "function": drift, "centre": tuple(centre)}} if moves else {},
        until=1.0, time_step=1e-3, sound_speed=20.0, jitter=0.15, seed=seed, domain=((-9.0,) * dim, (9.0,) * dim),
        density_diffusion=random.uniform(0.0, 0.3), artificial_viscosity=random.uniform(0.0, 0.3),
        smoothing_length_ratio=1.3, **options,
    )  # fmt: skip
    run = Simulation(case, threads=1)
    system, n, columns = run.system, run.fluid_count, run.columns
    force = Swirl(5.0 * random.normal(size=dim), 5.0 * random.normal(size=(dim, dim)))
    drive(run, force)
    gravity = case.gravity_vector
    state = run.state()
    rows = state["rows"][:n]
    if moves:
        place, rate, _ = drift(0.0)
        rows[:, columns.position] = (rows[:, columns.position] - centre) @ turn(place).T + centre + place[:dim]
        rows[:, columns.velocity] = rate[:dim]
    rows[:, columns.velocity] += 0.5 * random.normal(size=(n, dim))
    rows[:, columns.mass] *= random.uniform(0.9, 1.1, n)
    rows[:, columns.density] *= 1.0 + 2e-3 * random.normal(size=n)
    order = np.argsort(system.ids)
    plain = Plain(
        case, 20.0, run.boundary._drawn, run.boundary.wall_body, centre[None], [drift] if moves else [],
        lambda time: (gravity + force.acceleration(time), force.gradient(time)),
        WEIGHTS[case.interpolator.name], run.boundary.velocity * (not moves),
        rows[order, columns.position], rows[order, columns.velocity], rows[order, columns.density],
        rows[order, columns.mass],
    )  # fmt: skip
    run.restore(state)
    system.find_neighbours()
    system.evaluate(0.0)
    plain.start(0.0)
    return run, plain
