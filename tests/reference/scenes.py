"""Random scenes, small and in disorder, for the solver and for plain NumPy."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sphframe import BodyForce, Simulation
from sphframe.cases import Custom
from sphframe.geometry import BoxRegion, BoxWall, PolygonWall

from .bodies import FreeBody
from .plain import Plain
from .walls import Motion, Walls, turn

Array = NDArray[np.float64]
DX = 0.1
PERIODIC = {"channel": "x", "moving channel": "x", "gutter": "y", "nothing": "xy"}
"""directions in which scenes of these kinds repeat themselves"""
FULL = ("channel", "moving channel", "full box")
"""kinds without a free surface"""


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


def motion(random: np.random.Generator, dim: int, *, turns: bool = True) -> Callable[[float], Motion]:
    """A body that drifts, turns and speeds up, and is already displaced and turned at the start.

    It is slower than half of the sound speed, above which a run stops.
    """
    size = 3 if dim == 2 else 6
    place, rate, growth = random.normal(size=size), random.normal(size=size), 5.0 * random.normal(size=size)
    rate = np.clip(rate, -1.5, 1.5)
    if dim == 3:  # about an axis that does not change, so that the turn is the integral of the angular velocity
        axis = random.normal(size=3)
        axis /= np.linalg.norm(axis)
        for vector in (place, rate, growth):
            vector[3:] = axis * vector[3]
    if not turns:
        for vector in (place, rate, growth):
            vector[dim:] = 0.0

    def at(time: float) -> Motion:
        return place + rate * time + 0.5 * growth * time**2, rate + growth * time, growth

    return at


def walls_of(kind: str, dim: int, size: Array) -> list[Any]:
    """A tank without a lid, one box, or in 2-D a slope and the rest, which share two corners; or what repeats itself.

    A carried box does not turn, and the force is the same everywhere. A free box is moved by the water. A channel along
    x has a bed that slides or moves and a lid; a gutter along y has no ends.
    """
    if kind == "nothing":
        return []
    if "channel" in kind:
        (length, height), own = size, "tank" if kind == "moving channel" else None
        return [
            PolygonWall(name="lid", points=[(0.0, height), (length, height)], body=own),
            PolygonWall(name="bed", points=[(0.0, 0.0), (length, 0.0)], body=own,
                        surface_velocity=None if own else (0.7, 0.0)),
        ]  # fmt: skip
    if kind == "gutter":
        return [BoxWall(name="tank", lower=(0.0,) * dim, upper=tuple(size), open_faces=("+z", "-y", "+y"),
                        body="tank")]  # fmt: skip
    if "box" in kind:
        opened = () if kind == "full box" else ("+z" if dim == 3 else "+y",)
        return [BoxWall(name="tank", lower=(0.0,) * dim, upper=tuple(size), open_faces=opened, body="tank")]
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
    axes = PERIODIC.get(walls, "")
    repeats = np.array([axis in axes for axis in "xyz"[:dim]])
    cells[repeats] += 5  # a period is longer than twice the support
    size = DX * (cells + np.eye(dim)[-1] * (not repeats[-1] and walls not in FULL))
    drift, centre = motion(random, dim, turns=not axes and walls != "carried box"), random.normal(size=dim)
    drawn = walls_of(walls, dim, size)
    moves = bool(drawn) and drawn[0].body is not None
    body: dict[str, Any] = {"name": "prescribed", "function": drift, "centre": tuple(centre)}
    free: FreeBody = FreeBody.none(dim)
    carrier: Callable[[float], Motion] = drift
    if walls == "free box":
        mass = 1000.0 * random.uniform(4.0, 8.0) * size.prod()
        stretch = np.eye(2 * dim - 3) + 0.2 * random.uniform(-1.0, 1.0, (2 * dim - 3,) * 2)
        inertia = mass * (1.0 + centre @ centre) * stretch @ stretch.T
        place, rate, growth = drift(0.0)
        rate[dim:] = random.normal(size=2 * dim - 3)
        free = carrier = FreeBody(mass, inertia, -9.81 * np.eye(dim)[-1], place, rate, growth)
        body = {"name": "free", "mass": mass, "centre": tuple(centre)}
        body["inertia"] = tuple(map(tuple, inertia.tolist())) if dim == 3 else inertia[0, 0]
    case = Custom(
        dimension=dim, particle_spacing=DX, walls=drawn, fluid=[BoxRegion(lower=(0.0,) * dim, upper=tuple(DX * cells))],
        bodies={"tank": body} if moves else {},
        until=1.0, time_step=1e-3, sound_speed=20.0, jitter=0.15, seed=seed, periodic=tuple(axes),
        domain=(tuple(np.where(repeats, 0.0, -9.0)), tuple(np.where(repeats, size, 9.0))),
        density_diffusion=random.uniform(0.0, 0.3), artificial_viscosity=random.uniform(0.0, 0.3),
        **{"smoothing_length_ratio": 1.3, **options},
    )  # fmt: skip
    run = Simulation(case, threads=1)
    system, n, columns = run.system, run.fluid_count, run.columns
    slope = 5.0 * random.normal(size=(dim, dim)) * ~repeats * (walls != "carried box")
    force = Swirl(5.0 * random.normal(size=dim), slope)
    drive(run, force)
    gravity = case.gravity_vector
    state = run.state()
    rows = state["rows"][:n]
    if moves:
        place, rate, _ = carrier(0.0)
        rows[:, columns.position] = (rows[:, columns.position] - centre) @ turn(place).T + centre + place[:dim]
        rows[:, columns.velocity] = rate[:dim]
        for name, value in (("position", place), ("velocity", rate), ("motions", carrier(0.0))):
            state[f"bodies.{name}"][0] = value
    rows[:, columns.position] += 1.5 * random.uniform(-1.0, 1.0, dim) * size * repeats
    rows[:, columns.velocity] += 0.5 * random.normal(size=(n, dim))
    rows[:, columns.mass] *= random.uniform(0.9, 1.1, n)
    rows[:, columns.density] *= 1.0 + 2e-3 * random.normal(size=n)
    if run.components.walls.rate is not None:
        state["boundary.wall_state"][:] = 1000.0 * (1.0 + 2e-3 * random.normal(size=run.ghost_count))
    order = np.argsort(system.ids)
    at_rest = run.boundary.velocity * (not moves)
    faces = [[0.0, float(end)] for end in size[:-1]] + [[0.0]] if "box" in walls else None
    around = Walls(run.boundary._drawn, run.boundary.wall_body, centre[None], [carrier] * moves, at_rest,
                   size * repeats, faces)  # fmt: skip
    plain = Plain(
        case, 20.0, around, lambda time: (gravity + force.acceleration(time), force.gradient(time)),
        rows[order, columns.position], rows[order, columns.velocity], rows[order, columns.density],
        rows[order, columns.mass], state["boundary.wall_state"].copy(), free,
    )  # fmt: skip
    run.restore(state)
    system.move_walls(0.0)
    system.find_neighbours()
    system.evaluate(0.0)
    plain.start(0.0)
    return run, plain
