"""Testing: checks of wall treatments, with the solver itself, in a box of water on a square lattice.

Fields are given to the fluid, the solver computes rates once, and those of the first two layers above the middle of the
bed are compared with those in the midst of the fluid. Kernel sums of the lattice itself thus cancel.
"""

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from sphframe.arrays import Array, IntArray
from sphframe.cases.custom import Custom
from sphframe.cases.parameters import Component
from sphframe.errors import SphframeError
from sphframe.interfaces import WallTraits, WallTreatment
from sphframe.simulation.simulation import Simulation
from sphframe.testing.evaluation import title
from sphframe.testing.proof import BrokenPromiseError

_SPACING, _WIDTH, _HEIGHT = 0.01, 0.36, 0.26
_DENSITY, _SOUND_SPEED, _GRAVITY, _VISCOSITY = 1000.0, 2000.0, 9.81, 1e-3
_ROUND_OFF = 2e-4
"""what a lattice of a compressible fluid leaves of an exact property"""

Field = Callable[[Array], Array]


class WallResiduals(NamedTuple):
    """Errors in the first two layers of particles above a bed.

    uniform: acceleration away from the wall under a uniform pressure p, over 2 p/(rho dx).
    hydrostatic: acceleration away from a bed under still water, over g.
    normal: divergence of a velocity a y away from the wall, over a; 1 is exact.
    shear: viscous force in a shear flow u = a y with no slip, as a Laplacian times dx/a; 0 is exact.
    """

    uniform: tuple[float, float]
    hydrostatic: tuple[float, float]
    normal: tuple[float, float]
    shear: tuple[float, float]


@cache
def wall_residuals(
    treatment: WallTreatment,
    kernel: str = "gaussian",
    smoothing_length_ratio: float = 1.3,
    viscosity_model: str = "morris",
) -> WallResiduals:
    """Return the errors of a treatment at a straight bed on the square lattice, in two dimensions, with no slip."""
    kernels: dict[str, Any] = {
        "kernel": kernel,
        "smoothing_length_ratio": smoothing_length_ratio,
        "viscosity_model": viscosity_model,
    }
    still = _box(treatment, gravity=0.0, **kernels)
    uniform = _difference(still, "v", pressure=lambda x: np.full(len(x), 1000.0))
    heavy = _box(treatment, gravity=_GRAVITY, **kernels)
    hydrostatic = _difference(heavy, "v", pressure=lambda x: _DENSITY * _GRAVITY * (_HEIGHT - x[:, 1]))
    normal = _difference(still, "density", velocity=lambda x: np.stack([0.0 * x[:, 1], x[:, 1]], axis=1))
    shear = _difference(still, "u", velocity=lambda x: np.stack([x[:, 1], 0.0 * x[:, 1]], axis=1))
    return WallResiduals(
        _pair(uniform * _SPACING * _DENSITY / 2000.0),
        _pair(hydrostatic / _GRAVITY),
        _pair(1.0 - normal / _DENSITY),
        _pair(shear * _SPACING / _VISCOSITY),
    )


def poiseuille_error(
    treatment: WallTreatment,
    across: int,
    kernel: str = "wendland-c2",
    smoothing_length_ratio: float = 2.0,
    viscosity_model: str = "morris",
) -> float:
    """Return the largest error of plane Poiseuille flow, over the largest velocity, ``across`` spacings wide, in 2-D.

    The viscous forces of the solver on layers of particles, half a spacing and so on from two plates, are a matrix of
    the velocities of the layers, found column by column. The flow is the solution for a uniform force, which is scaled
    by the viscous force of a parabola in the midst of the fluid, so that the error is that of the walls alone.
    """
    box = {"shape": "box", "lower": (0.0, 0.0), "upper": (20 * _SPACING, across * _SPACING)}
    simulation = _box(
        treatment, gravity=0.0, kernel=kernel, smoothing_length_ratio=smoothing_length_ratio,
        viscosity_model=viscosity_model,
        walls=[{**box, "open_faces": ["-x", "+x"], "one_sided": True}], fluid=[box],
    )  # fmt: skip
    position = simulation.system.rows[: simulation.fluid_count, :2]
    layer = np.floor(position[:, 1] / _SPACING).astype(int)
    middle = np.flatnonzero(np.abs(position[:, 0] - 10.5 * _SPACING) < 0.2 * _SPACING)
    middle = middle[np.argsort(layer[middle])]
    height = (np.arange(across) + 0.5) / across

    def forces(velocity: Array) -> Array:
        _set(simulation, velocity=lambda _: np.stack([velocity[layer], np.zeros(len(layer))], axis=1))
        return np.asarray(simulation.system.rates[middle, simulation.columns.u])

    matrix = np.stack([forces(column) for column in np.eye(across)], axis=1)
    scale = forces(height**2)[across // 2] / 2.0
    return float(np.abs(np.linalg.solve(matrix, np.full(across, -8.0 * scale)) - 4.0 * height * (1.0 - height)).max())


def _pair(values: Array) -> tuple[float, float]:
    return float(values[0]), float(values[1])


def _box(treatment: WallTreatment, *, dim: int = 2, gravity: float, **parameters: Any) -> Simulation:
    """Return a box full of water, open at its top, with walls of ``treatment``."""
    names = getattr(treatment, "__dataclass_fields__", {})
    component = Component(
        name=f"{type(treatment).__module__}:{type(treatment).__qualname__}",
        options={name: getattr(treatment, name) for name in names},
    )
    size = (_WIDTH, _HEIGHT) if dim == 2 else (0.12, 0.12, 0.12)
    box = {"shape": "box", "lower": (0.0,) * dim, "upper": size}
    given: dict[str, Any] = {
        "dimension": dim, "particle_spacing": _SPACING, "gravity": gravity, "sound_speed": _SOUND_SPEED,
        "density_diffusion": 0.0, "artificial_viscosity": 0.0, "kinematic_viscosity": _VISCOSITY, "slip": "no",
        "tension": "free", "walls": [{**box, "open_faces": ["+y" if dim == 2 else "+z"]}], "fluid": [box],
        "until": 1.0, "frame_interval": 1.0, "probe_interval": 1.0, "wall_treatment": component, **parameters,
    }  # fmt: skip
    return Simulation(Custom(**given), threads=1)


def _set(simulation: Simulation, pressure: Field | None = None, velocity: Field | None = None) -> None:
    """Give the fluid a pressure and a velocity as functions of its positions, and compute all rates."""
    system, columns, n = simulation.system, simulation.columns, simulation.fluid_count
    fluid = system.rows[:n]
    position = fluid[:, columns.position]
    given = np.zeros(n) if pressure is None else pressure(position)
    fluid[:, columns.density] = _DENSITY + given / _SOUND_SPEED**2
    fluid[:, columns.mass] = fluid[:, columns.density] * _SPACING**columns.dim
    fluid[:, columns.velocity] = 0.0 if velocity is None else velocity(position)
    system.evaluate(0.0)


def _difference(
    simulation: Simulation, rate: str, pressure: Field | None = None, velocity: Field | None = None
) -> Array:
    """Return a rate of the first two layers above the middle of the bed less that in the midst of the fluid, (2,)."""
    _set(simulation, pressure, velocity)
    system = simulation.system
    position = system.rows[: simulation.fluid_count, :2]
    found = system.rates[:, getattr(simulation.columns, rate)]

    def layer(number: int) -> IntArray:
        near = np.abs(position - [0.5 * _WIDTH, (number - 0.5) * _SPACING]) < [0.6 * _SPACING, 0.2 * _SPACING]
        return np.flatnonzero(near.all(axis=1))

    return np.array([found[layer(number)].mean() - found[layer(13)].mean() for number in (1, 2)])


def check_compiles(treatment: WallTreatment, dim: int) -> None:
    """All loops of the solver can be compiled with the treatment, and give finite rates."""
    if dim not in treatment.traits.dimensions:
        return
    try:
        simulation = _box(treatment, dim=dim, gravity=_GRAVITY)
        _set(simulation, *_random_fields(dim))
        simulation.system.update_loads()
    except SphframeError as error:
        raise BrokenPromiseError(f"{title(treatment)}: {error}") from error
    if not (np.isfinite(simulation.system.rates).all() and np.isfinite(simulation.system.loads).all()):
        raise BrokenPromiseError(f"{title(treatment)}: rates are not finite: guard divisions by max(., tiny)")


def check_momentum(treatment: WallTreatment) -> None:
    """The force on the walls is minus that on the fluid: what walls give to the momentum of the fluid, they lose."""
    for dim in treatment.traits.dimensions:
        _check_momentum(treatment, dim)


def _check_momentum(treatment: WallTreatment, dim: int) -> None:
    simulation = _box(treatment, dim=dim, gravity=0.0)
    _set(simulation, *_random_fields(dim))
    system, columns = simulation.system, simulation.columns
    system.update_loads()
    forces = system.rows[: simulation.fluid_count, columns.mass, None] * system.rates[:, columns.velocity]
    action, reaction = forces.sum(axis=0), system.loads[:, :dim].sum(axis=0)
    if not np.all(np.abs(action + reaction) <= 1e-10 * np.abs(forces).sum()):
        raise BrokenPromiseError(
            f"{title(treatment)}: the walls exert {action} N on the fluid, and bear {reaction} N themselves"
        )


def _random_fields(dim: int) -> tuple[Field, Field]:
    random = np.random.default_rng(3)
    return (lambda x: 500.0 + 500.0 * random.uniform(size=len(x)), lambda x: random.normal(size=(len(x), dim)))


def _check_residual(treatment: WallTreatment, name: str, exact: float = 0.0) -> None:
    found = getattr(wall_residuals(treatment), name)
    if not np.all(np.abs(np.array(found) - exact) <= (1e-3 if name == "normal" else _ROUND_OFF)):
        raise BrokenPromiseError(
            f"{title(treatment)}: {name} field above a straight bed: {found[0]:.4g} in the first layer, {found[1]:.4g}"
            f" in the second, {exact:g} is exact; see sphframe.testing.wall_residuals"
        )


def check_constant(treatment: WallTreatment) -> None:
    """A uniform pressure exerts no force, nor does uniform suction."""
    _check_residual(treatment, "uniform")
    suction = _difference(_box(treatment, gravity=0.0), "v", pressure=lambda x: np.full(len(x), -1000.0))
    if not np.all(np.abs(suction * _SPACING * _DENSITY / 2000.0) <= _ROUND_OFF):
        raise BrokenPromiseError(
            f"{title(treatment)}: suction of 1000 Pa accelerates the first layers by {suction} m/s^2"
        )


def check_hydrostatic(treatment: WallTreatment) -> None:
    """Still water above a bed stays still."""
    _check_residual(treatment, "hydrostatic")


def check_shear(treatment: WallTreatment) -> None:
    """A linear shear flow with no slip has no viscous force."""
    _check_residual(treatment, "shear")


def check_normal(treatment: WallTreatment) -> None:
    """A velocity that grows linearly from the wall has the right divergence."""
    _check_residual(treatment, "normal", 1.0)


def check_conjugate(treatment: WallTreatment) -> None:
    """Without viscosity and gravity a wall at rest gives the fluid no energy: sum m u.a + sum (p/rho) V drho/dt = 0.

    The viscosity is no more than a name: with none at all, the pair loops would be compiled once more.
    """
    simulation = _box(treatment, gravity=0.0, kinematic_viscosity=1e-30, slip="free")
    _set(simulation, *_random_fields(2))
    system, columns = simulation.system, simulation.columns
    fluid = system.rows[: simulation.fluid_count]
    kinetic = fluid[:, columns.mass, None] * fluid[:, columns.velocity] * system.rates[:, columns.velocity]
    internal = fluid[:, columns.pressure] / fluid[:, columns.density] * fluid[:, columns.volume]
    internal = internal * system.rates[:, columns.density]
    power = kinetic.sum() + internal.sum()
    if not abs(power) <= 1e-10 * (np.abs(kinetic).sum() + np.abs(internal).sum()):
        raise BrokenPromiseError(f"{title(treatment)}: walls at rest give the fluid {power:.4g} W")


CHECKS = {"compiles": check_compiles}
"""checks of every treatment, in each dimension"""
CHECKS_OF_TRAITS: dict[str, tuple[Callable[[WallTreatment], None], Callable[[WallTraits], bool]]] = {
    "momentum": (check_momentum, lambda traits: traits.momentum),
    "exact_constant": (check_constant, lambda traits: traits.exact_constant),
    "exact_hydrostatic": (check_hydrostatic, lambda traits: traits.exact_hydrostatic),
    "exact_shear": (check_shear, lambda traits: traits.exact_shear),
    "exact_normal": (check_normal, lambda traits: traits.exact_normal),
    "conjugate": (check_conjugate, lambda traits: traits.conjugate),
}
"""checks of what a treatment promises; but for momentum in two dimensions"""
