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
from sphframe.testing.wall_treatments import _box, _set, poiseuille_error

KERNELS = {"gaussian": 1.3, "wendland-c2": 2.0}


@pytest.mark.parametrize(
    ("name", "options", "field", "gaussian", "wendland"),
    [
        ("fixed-ghosts", {}, "uniform", (0.0, 0.0), (0.0, 0.0)),
        ("fixed-ghosts", {}, "hydrostatic", (0.0, 0.0), (0.0, 0.0)),
        ("fixed-ghosts", {}, "normal", (1.0, 1.0), (1.0, 1.0)),
        ("fixed-ghosts", {}, "shear", (0.0, 0.0), (0.0, 0.0)),
        ("pair-mirror", {"lift": False}, "hydrostatic", (-0.50, -0.22), (-0.50, -0.30)),
        ("pair-mirror", {"lift": False}, "normal", (0.89, 1.10), (0.84, 1.12)),
        ("mdbc-2022", {}, "normal", (0.69, 0.94), (0.67, 0.91)),
        ("mdbc-2022", {}, "shear", (0.44,), ()),
        ("mdbc-2025", {}, "shear", (-0.27,), ()),
        ("adami-2012", {}, "shear", (0.01,), ()),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_errors_at_a_straight_wall(name, options, field, gaussian, wendland):
    treatment = create("wall_treatments", name, **options)
    for (kernel, ratio), expected in zip(KERNELS.items(), (gaussian, wendland), strict=True):
        if not expected:
            continue
        found = getattr(wall_residuals(treatment, kernel, ratio), field)[: len(expected)]
        np.testing.assert_allclose(found, expected, atol=0.0055 if any(expected) else 1e-3)


@pytest.mark.parametrize(
    ("name", "options", "morris", "monaghan_gingold", "order"),
    [
        ("fixed-ghosts", {}, (1.23, 0.31), (0.80, 0.20), 2.0),
        ("mdbc-2022", {}, (19.7, 9.6), (16.4, 8.0), 1.0),
        ("mdbc-2025", {}, (4.1, 2.6), (4.8, 2.8), 0.7),
        ("mdbc-2025", {"velocity": "corrected"}, (1.20, 0.30), None, 2.0),
        ("distance-ratio", {}, (1.02, 0.26), None, 2.0),
        ("adami-2012", {}, (1.70, 0.56), None, None),
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


@pytest.mark.parametrize("name", ["fixed-ghosts", "mdbc-2022"])
def test_the_documentation_has_the_measured_errors(name):
    _, measured = documented()
    for kernel, ratio in KERNELS.items():
        residuals = wall_residuals(create("wall_treatments", name), kernel, ratio)
        found = [[float(value) for value in cell.split("/")] for cell in measured[name, kernel]]
        np.testing.assert_allclose(found, residuals, atol=1.1e-3)


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
