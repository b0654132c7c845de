"""Errors of rules at a straight wall on the lattice, and the checks of treatments that break a promise.

The numbers depend on the kernel alone. They are those of an independent program that sums over the lattice.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from sphframe import Seen, WallParts, WallTraits, WallTreatment, create
from sphframe.testing import BrokenPromiseError, checks_of, wall_residuals
from sphframe.testing.verification import _installed
from sphframe.testing.wall_treatments import CHECKS_OF_TRAITS, _box, _set, poiseuille_error

KERNELS = {"gaussian": 1.3, "wendland-c2": 2.0}


class Lattice:
    """Sums of plain NumPy over the square lattice of spacing 1, whose points below the wall y = 0 are wall particles.

    The point x_j around the particle x_i of a layer has the weight s = -W'(r)/r, so that grad_i W = s (x_j - x_i).
    """

    def __init__(self, name: str, ratio: float) -> None:
        kernel = create("kernels", name)
        self.value, self.support, self.ratio = kernel.value_function(), kernel.support, ratio
        self.reach = int(kernel.support * ratio)
        near, slope = range(-self.reach, self.reach + 1), kernel.gradient_function()
        places = np.array([(a, b) for a in near for b in near if 0.0 < np.hypot(a, b) < kernel.support * ratio])
        self.b = places[:, 1]
        self.s = np.array([-slope(np.hypot(*place) / ratio) for place in places]) * kernel.normalisation(2) / ratio**4

    def average(self, y: float) -> float:
        """The height of the fluid that a kernel average at (0, y) has, normalised, with points at half spacings."""
        x, heights = np.meshgrid(np.arange(-self.reach, self.reach + 1), np.arange(2 * self.reach + 2) + 0.5)
        q = np.hypot(x, heights - y) / self.ratio
        weights = np.array([self.value(k) if k < self.support else 0.0 for k in q.flat])
        return float(weights @ heights.flat / weights.sum())

    def errors(self, field: str, rule: str) -> list[float]:
        """Errors in the first two layers of a rule for what a wall particle at height Y < 0 has in place of -Y or Y."""
        found = []
        for y in (0.5, 1.5):
            heights = y + self.b
            wall = heights < 0.0
            given = np.array([self.rules(rule, y, height) for height in heights[wall]])
            error = given - heights[wall]
            s, b = self.s[wall], self.b[wall]
            if field == "hydrostatic":  # p = -y, over rho = g = 1
                found.append(float(error @ (s * b)))
            else:
                found.append(float(1.0 + error @ (s * b) if field == "normal" else 2.0 * error @ s))
        return found

    def rules(self, rule: str, y: float, height: float) -> float:
        """The linear field of a wall particle, whose exact value is its height, as the particle at y sees it."""
        if rule in ("average", "mirror"):
            return -self.average(height if rule == "average" else -height)
        return {"exact": height, "wall": 0.0, "particle": y, "reversed": -y}[rule]


@pytest.mark.parametrize(
    ("name", "options", "field", "rule", "kernels"),
    [
        ("fixed-ghosts", {}, "hydrostatic", "exact", 2),
        ("fixed-ghosts", {}, "normal", "exact", 2),
        ("fixed-ghosts", {}, "shear", "exact", 2),
        ("pair-mirror", {"lift": False}, "hydrostatic", "particle", 1),
        ("pair-mirror", {"lift": False}, "normal", "reversed", 1),
        ("pair-mirror", {"lift": False}, "shear", "reversed", 1),
        ("mdbc-2022", {}, "normal", "wall", 2),
        ("mdbc-2022", {}, "shear", "wall", 2),
        ("mdbc-2025", {}, "shear", "mirror", 1),
        ("adami-2012", {}, "shear", "average", 1),
        pytest.param("pair-mirror", {"lift": False}, "hydrostatic", "particle", 2, marks=pytest.mark.long),
        pytest.param("pair-mirror", {"lift": False}, "normal", "reversed", 2, marks=pytest.mark.long),
        pytest.param("pair-mirror", {"lift": False}, "shear", "reversed", 2, marks=pytest.mark.long),
        pytest.param("mdbc-2025", {}, "shear", "mirror", 2, marks=pytest.mark.long),
        pytest.param("adami-2012", {}, "shear", "average", 2, marks=pytest.mark.long),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_errors_at_a_straight_wall(name, options, field, rule, kernels):
    """To three digits those of sums over the lattice; a uniform pressure exerts no force with any of these."""
    treatment = create("wall_treatments", name, **options)
    for kernel, ratio in list(KERNELS.items())[:kernels]:
        found = wall_residuals(treatment, kernel, ratio)
        np.testing.assert_allclose(getattr(found, field), Lattice(kernel, ratio).errors(field, rule), atol=5e-4)
        np.testing.assert_allclose(found.uniform, 0.0, atol=2e-4)


@pytest.mark.parametrize(
    ("name", "options", "morris", "monaghan_gingold", "order"),
    [
        ("fixed-ghosts", {}, (1.23, 0.31), (0.80, 0.20), 2.0),
        ("mdbc-2022", {}, (19.7, 9.6), (16.4, 8.0), 1.0),
        ("mdbc-2025", {}, (4.1, 2.6), None, 0.7),
        pytest.param("mdbc-2025", {}, (4.1, 2.6), (4.8, 2.8), 0.7, marks=pytest.mark.long),
        ("mdbc-2025", {"velocity": "corrected"}, (1.20, 0.30), None, 2.0),
        ("distance-ratio", {}, (1.02, 0.26), None, 2.0),
        pytest.param("adami-2012", {}, (1.70, 0.56), None, None, marks=pytest.mark.long),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_poiseuille_flow_with_no_slip(name, options, morris, monaghan_gingold, order):
    """Rules that continue a shear flow exactly are of second order; with the wall's own velocity they are of first."""
    treatment = create("wall_treatments", name, **options)
    for model, errors in {"morris": morris, "monaghan-gingold": monaghan_gingold}.items():
        if errors is None:
            continue
        found = [100.0 * poiseuille_error(treatment, across, viscosity_model=model) for across in (16, 32)]
        np.testing.assert_allclose(found, errors, rtol=0.04)
        assert order is None or abs(np.log2(found[0] / found[1]) - order) < 0.1


@dataclass(frozen=True)
class Wrong(WallTreatment):
    """Promises everything and keeps nothing."""

    traits = WallTraits(
        exact_constant=True, exact_hydrostatic=True, exact_shear=True, exact_normal=True, conjugate=True,
        dimensions=(2,),
    )  # fmt: skip

    def parts(self, context):
        def seen(fluid, wall, separation, constants):
            half = 0.5 * fluid.u + 0.0 * separation.x
            return Seen(1.9 * fluid.pressure, half, 0.0, 0.0, half, 0.0, 0.0)

        return WallParts(seen=seen)


def test_promises_that_are_not_kept_are_found():
    found = {}
    for check in checks_of(Wrong()):
        try:
            check(Wrong())
        except BrokenPromiseError as error:
            found[check.name] = str(error)
    assert set(found) == {"exact_constant", "exact_hydrostatic", "exact_shear", "exact_normal", "conjugate"}
    assert "0 is exact" in found["exact_constant"]


def test_a_treatment_that_does_not_compile_is_named():
    @dataclass(frozen=True)
    class Broken(WallTreatment):
        traits = WallTraits(dimensions=(2,))

        def parts(self, context):
            return WallParts(seen=lambda fluid, wall, separation, constants: fluid.colour)

    globals()["Broken"] = Broken
    Broken.__qualname__ = "Broken"
    with pytest.raises(BrokenPromiseError, match=r"Broken.*colour"):
        checks_of(Broken())[0](Broken())


def documented():
    """The table of docs/walls.md: the cells of each treatment, and its measured cells by kernel."""
    traits, measured = {}, {}
    text = (Path(__file__).parents[2] / "docs" / "walls.md").read_text(encoding="utf-8")
    for line in text.partition("| treatment | C |")[2].splitlines()[2:]:
        if not line.startswith("|"):
            break
        name, *cells = (cell.strip() for cell in line.strip("|").split("|"))
        if name:
            label = name
            traits[label] = dict(zip("CHSDJM", cells, strict=False))
        measured[label, cells[6]] = cells[7:]
    return traits, measured


def test_the_documentation_has_the_promises_of_all_treatments():
    traits, _ = documented()
    for kind, label, name, options in _installed("wall_treatments"):
        promised = create(kind, name, **options).traits
        letters = {
            "C": promised.exact_constant, "H": promised.exact_hydrostatic, "S": promised.exact_shear,
            "D": promised.exact_normal, "J": promised.conjugate, "M": promised.momentum,
        }  # fmt: skip
        assert {letter: cell == "yes" for letter, cell in traits[label].items()} == letters, label


SHORT = ("fixed-ghosts", "mdbc-2022")


@pytest.mark.parametrize(
    "choice",
    [
        pytest.param(choice, id=choice[1], marks=[] if choice[1] in SHORT else pytest.mark.long)
        for choice in _installed("wall_treatments")
    ],
)
def test_the_documentation_has_the_measured_errors(choice):
    _, label, name, options = choice
    traits, measured = documented()
    treatment = create("wall_treatments", name, **options)
    for kernel, ratio in KERNELS.items():
        found = [[float(value) for value in cell.split("/")] for cell in measured[label, kernel]]
        np.testing.assert_allclose(found, wall_residuals(treatment, kernel, ratio), atol=6e-4, rtol=1e-5)
    if label not in SHORT:
        for letter, check in zip("MCHSDJ", CHECKS_OF_TRAITS.values(), strict=True):
            try:
                check[0](treatment)
            except BrokenPromiseError:
                assert traits[label][letter] == "-", letter
            else:
                assert traits[label][letter] in ("yes", "(yes)"), letter


@dataclass(frozen=True)
class TwoMethods(WallTreatment):
    """The pressure by kernel averages, the velocity by linear fits, of which the part along the normal is reversed."""

    traits = WallTraits()

    def interpolator(self, chosen):
        return create("interpolators", "normalized")

    def velocity_interpolator(self, chosen):
        return create("interpolators", "mls-linear")

    def parts(self, context):
        dim = context.dim

        def assign(fluid, wall, constants, velocity, viscous_velocity):
            normal = 0.0
            for d in range(dim):
                normal += (fluid.velocity[d] - wall.velocity[d]) * wall.normal[d]
            for d in range(dim):
                velocity[d] = fluid.velocity[d] - 2.0 * normal * wall.normal[d]
            return fluid.pressure, 1.0

        return WallParts(assign=assign)


def test_velocities_have_weights_of_their_own_and_know_the_normal():
    """Linear fields at the mirror point, half a spacing above the bed: the linear fit is exact, the average is not."""
    simulation = _box(TwoMethods(), gravity=0.0)
    _set(
        simulation,
        pressure=lambda x: 1000.0 * x[:, 1],
        velocity=lambda x: np.stack([x[:, 1], 2.0 * x[:, 1] + 0.01], axis=1),
    )
    ghosts = simulation.ghost_fields()
    x, y = ghosts.position.T
    below = (np.abs(y + 0.005) < 1e-9) & (np.abs(x - 0.18) < 0.1)
    assert below.sum() == 20
    np.testing.assert_allclose(ghosts.velocity[below], [[0.005, -0.02]] * 20, atol=1e-9)
    assert (ghosts.pressure[below] > 1.2 * 5.0).all()


@dataclass(frozen=True)
class Limited(WallTreatment):
    """The pressure of a wall particle follows a mean of the fluid's in which outliers hardly count, within h/c0."""

    traits = WallTraits()
    scale: float = 1000.0

    def parts(self, context):
        scale, equation_of_state = self.scale, context.pressure

        def rate(near, wall, constants):
            rho0, c0 = constants.reference_density, constants.sound_speed
            own, total, weights = equation_of_state(wall.state, rho0, c0), 0.0, 0.0
            for j in range(near.distances.shape[0]):
                weight = near.volumes[j] / (1.0 + ((near.pressures[j] - own) / scale) ** 2)
                total += weight * near.densities[j]
                weights += weight
            return (total / weights - wall.state) * c0 / constants.smoothing_length

        def assign(fluid, wall, constants, velocity, viscous_velocity):
            velocity[:] = wall.velocity
            return equation_of_state(wall.state, constants.reference_density, constants.sound_speed), 1.0

        return WallParts(rate=rate, assign=assign)


def test_weights_can_depend_on_the_values_of_single_particles():
    """One particle above the bed has a hundred times the pressure of all others: a mean of fixed weights feels it."""

    def pressure(x):
        return np.where(np.linalg.norm(x - [0.185, 0.005], axis=1) < 1e-3, 1e5, 1e3)

    simulation = _box(Limited(), gravity=0.0)
    _set(simulation, pressure)
    system, interval = simulation.system, 0.3 * simulation.smoothing_length / simulation.sound_speed
    for _ in range(40):
        system.wall_states.evaluate(system.rows, system.lists, system.parameters)
        system.wall_states.update_density(interval)
    system.fill_ghosts()
    ghosts, fluid = simulation.ghost_fields(), simulation.fields()
    below = np.flatnonzero(np.linalg.norm(ghosts.position - [0.18, -0.005], axis=1) < 0.02)
    distances = np.linalg.norm(fluid.position - ghosts.position[below, None], axis=2)
    means = [fluid.pressure[around].mean() for around in distances < simulation.support]
    assert np.mean(means) > 2.5e3
    np.testing.assert_allclose(ghosts.pressure[below], 1e3, rtol=0.01)


class Placed(WallTreatment):
    """A pressure that tells where the wall particle is and to which wall it belongs."""

    traits = WallTraits()

    def parts(self, context):
        dim = context.dim

        def assign(fluid, wall, constants, velocity, viscous_velocity):
            velocity[:] = wall.velocity
            return 1e4 * (wall.number + 1) + 1e3 * wall.position[0] + 10.0 * wall.position[dim - 1], 1.0

        return WallParts(assign=assign)


def _sway(time):
    return [-0.5 * time, 0.0, 0.3 * time], [-0.5, 0.0, 0.3], [0.0, 0.0, 0.0]


@pytest.mark.parametrize("body", [None, "tank"], ids=["at rest", "moving"])
def test_a_treatment_can_choose_by_wall_and_by_place(body):
    walls = [
        {"shape": "polygon", "name": "side", "points": [(0.0, 1.0), (0.0, 0.0)], "body": body},
        {"shape": "polygon", "name": "rest", "points": [(0.0, 0.0), (0.36, 0.0), (0.36, 1.0)], "body": body},
    ]
    moving = {"tank": {"name": "prescribed", "function": _sway}} if body else {}
    simulation = _box(Placed(), gravity=1.0, walls=walls, bodies=moving)
    for _ in range(3):
        simulation.advance()
    ghosts, near = simulation.ghost_fields(), simulation.system.lists.near
    number, place = simulation.boundary.wall[near], ghosts.position[near]
    assert set(number) == {0, 1}
    expected = 1e4 * (number + 1) + 1e3 * place[:, 0] + 10.0 * place[:, 1]
    np.testing.assert_allclose(ghosts.pressure[near], expected, rtol=1e-12)
