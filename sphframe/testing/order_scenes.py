"""Testing: rates of the solver beside a wall, less those that wall particles with exact values would give.

The reference is a sum over pairs in NumPy, over the same fluid and the layers of wall particles of the solver, which
hold the exact values of the fields, continued through the wall. At a straight wall these layers are the lattice itself.
The difference is thus what the treatment makes of the wall, free of the error of the fluid's own lattice.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from sphframe.arrays import Array, IntArray
from sphframe.cases.custom import Custom
from sphframe.cases.parameters import Component
from sphframe.interfaces import BoundaryInterpolator, WallTreatment
from sphframe.registry import create
from sphframe.simulation.simulation import Simulation
from sphframe.testing.order_fields import DENSITY, GRAVITY, TestWall, drawn

KERNEL, RATIO = "gaussian", 1.3
ARRANGEMENTS = ("lattice", "jittered", "nearer", "farther")
"""how the fluid lies: as it fills the domain, displaced by up to 0.1 dx, or by a quarter spacing across the wall"""
_SOUND_SPEED, _VISCOSITY = 2000.0, 1.0
_WALL_VELOCITY = np.array([0.7, -0.4])

Field = Callable[[Array], Array]


class Sums(NamedTuple):
    """The pairs of a cloud: ``chosen`` (m,) are the particles whose rates are compared, ``first`` their places in it.

    ``cloud`` (n + g, 2): the fluid and the layers behind the wall, m; ``offset`` (k, 2) from particle ``first`` to
    ``second``, m; ``weight`` (k,): -V_j w'(q)/q sigma/h^4, so that V_j grad_i W_ij = weight offset.
    """

    chosen: IntArray
    cloud: Array
    first: IntArray
    second: IntArray
    offset: Array
    weight: Array

    def _over_pairs(self, values: Array) -> Array:
        count = len(self.chosen)
        columns = values.reshape(len(values), -1).T
        return np.stack([np.bincount(self.first, column, count) for column in columns], axis=1)

    def _changes(self, values: Array) -> Array:
        return np.asarray(values[self.second] - values[self.chosen[self.first]])

    def pressure_gradient(self, field: Field) -> Array:
        """Return sum_j (p_i + p_j) grad W V_j (m, 2), Pa/m."""
        values = field(self.cloud)
        stress = self.weight * (values[self.second] + values[self.chosen[self.first]])
        return self._over_pairs(stress[:, None] * self.offset)

    def divergence(self, field: Field) -> Array:
        """Return sum_j (u_j - u_i).grad W V_j (m, 1), 1/s."""
        return self._over_pairs(self.weight * (self._changes(field(self.cloud)) * self.offset).sum(axis=1))

    def laplacian(self, field: Field) -> Array:
        """Return 2 sum_j (u_j - u_i) x_ji.grad W/r^2 V_j (m, 2), 1/(m s)."""
        return self._over_pairs(2.0 * self.weight[:, None] * self._changes(field(self.cloud)))

    def renormalised_gradient(self, field: Field) -> Array:
        """Return the gradient (m, 2) that is exact for linear fields, 1/m."""
        values = self._over_pairs((self.weight * self._changes(field(self.cloud)))[:, None] * self.offset)
        tensor = self._over_pairs(self.weight[:, None, None] * self.offset[:, :, None] * self.offset[:, None, :])
        return np.asarray(np.linalg.solve(tensor.reshape(-1, 2, 2), values[:, :, None])[:, :, 0], np.float64)


class Beside:
    """The solver beside ``wall``, with ``count`` spacings over the unit of length, and the treatment under test."""

    def __init__(self, component: WallTreatment | BoundaryInterpolator, wall: TestWall, count: int, slip: str) -> None:
        self.wall, self.count, self.slip = wall, count, slip
        self.simulation = _simulation(_chosen(component), wall, count, slip)
        self._place, self._volume = _particles(self.simulation)

    def arrange(self, arrangement: str) -> Sums:
        """Put the fluid in an arrangement, find its neighbours, and return the pairs of the reference."""
        system, n = self.simulation.system, self.simulation.fluid_count
        place = _arranged(self.wall, self._place, self.count, arrangement)
        system.rows[:n, :2] = place[system.ids]
        system.find_neighbours()
        return _sums(self.wall, self.count, arrangement)

    def rates(self, pressure: Field | None = None, velocity: Field | None = None) -> Array:
        """Return accelerations times rho less rho f, Pa/m, density rates over -rho, and c0^2 grad rho, (n, 5).

        Without a ``pressure``, zero in the fluid, no force b balances it at the wall either.
        """
        simulation, system = self.simulation, self.simulation.system
        columns, n = simulation.columns, simulation.fluid_count
        fluid, boundary = system.rows[:n], system.boundary
        boundary.velocity[:], boundary.driving[:] = _WALL_VELOCITY, 0.0
        if pressure is not None:
            boundary.driving[:] = DENSITY * np.array(GRAVITY)
        given, behind = (
            np.zeros(len(p)) if pressure is None else pressure(p) for p in (fluid[:, :2], boundary.position)
        )
        boundary.wall_state[:] = DENSITY + behind / _SOUND_SPEED**2
        fluid[:, columns.density] = DENSITY + given / _SOUND_SPEED**2
        fluid[:, columns.mass] = fluid[:, columns.density] * self._volume[system.ids]
        fluid[:, columns.velocity] = _WALL_VELOCITY + (0.0 if velocity is None else velocity(fluid[:, :2]))
        system.evaluate(0.0)
        found = np.empty((n, 5))
        density = fluid[:, columns.density]
        found[system.ids, :2] = density[:, None] * (system.rates[:, columns.velocity] - np.array(GRAVITY))
        found[system.ids, 2] = -system.rates[:, columns.density] / density
        found[system.ids, 3:] = system.gradient * _SOUND_SPEED**2
        return found


def _chosen(component: WallTreatment | BoundaryInterpolator) -> tuple[tuple[str, Component], ...]:
    names = getattr(component, "__dataclass_fields__", {})
    options = {name: getattr(component, name) for name in names}
    address = f"{type(component).__module__}:{type(component).__qualname__}"
    kind = "interpolator" if isinstance(component, BoundaryInterpolator) else "wall_treatment"
    return ((kind, Component(name=address, options=options)),)


def _simulation(chosen: tuple[tuple[str, Component], ...], wall: TestWall, count: int, slip: str) -> Simulation:
    spacing = 1.0 / count
    outline, fluid = drawn(wall, spacing, _support(count))
    given: dict[str, Any] = {
        "particle_spacing": spacing, "gravity": GRAVITY, "sound_speed": _SOUND_SPEED, "density_diffusion": 0.0,
        "artificial_viscosity": 0.0, "kinematic_viscosity": _VISCOSITY, "slip": slip, "tension": "free",
        "kernel": KERNEL, "smoothing_length_ratio": RATIO, "walls": [outline], "fluid": [fluid], "depth": 1.0,
        "domain": ((-9.0, -9.0), (9.0, 9.0)), "until": 1.0, "frame_interval": 1.0, "probe_interval": 1.0,
        **dict(chosen),
    }  # fmt: skip
    return Simulation(Custom(**given), threads=1)


def _particles(simulation: Simulation) -> tuple[Array, Array]:
    """Return positions (n, 2), m, and volumes (n,), m^2, in the order of the particles' numbers."""
    order = np.argsort(simulation.system.ids)
    fluid = simulation.system.rows[: simulation.fluid_count][order]
    return fluid[:, :2].copy(), fluid[:, simulation.columns.volume].copy()


def _support(count: int) -> float:
    return float(create("kernels", KERNEL).support * RATIO / count)


def _arranged(wall: TestWall, place: Array, count: int, arrangement: str) -> Array:
    if arrangement == "jittered":
        return place + np.random.default_rng(count).uniform(-0.1, 0.1, place.shape) / count
    shift = {"lattice": 0.0, "nearer": -0.25, "farther": 0.25}[arrangement]
    return place + shift * wall.normal(place) / count if shift else place


@lru_cache(maxsize=128)
def _sums(wall: TestWall, count: int, arrangement: str) -> Sums:
    """Return the pairs of the fluid and of the solver's layers of wall particles."""
    simulation = _simulation((), wall, count, "no")
    place, volume = _particles(simulation)
    place = _arranged(wall, place, count, arrangement)
    cloud = np.vstack([place, simulation.boundary.position])
    volume = np.concatenate([volume, simulation.boundary.volume])
    kernel, h, support = create("kernels", KERNEL), RATIO / count, _support(count)
    chosen = np.flatnonzero(wall.measured(place, support))
    near = cKDTree(cloud).query_ball_point(place[chosen], support * (1.0 - 1e-12))
    first, second = np.repeat(np.arange(len(chosen)), [len(found) for found in near]), np.concatenate(near)
    offset = cloud[second] - place[chosen][first]
    slope = np.vectorize(kernel.gradient_function())(np.hypot(*offset.T) / h)
    weight = -kernel.normalisation(2) / h**4 * slope * volume[second]
    return Sums(chosen, cloud, first, second.astype(np.int64), offset, weight)
