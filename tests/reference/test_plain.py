"""Steps of the solver are those of plain NumPy, on random scenes."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sphframe import Simulation

from .plain import Plain
from .scenes import DX, random_scene

pytestmark = pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
SEEDS = st.integers(0, 10**6)
SLIP = st.sampled_from(["free", "no"])
INTEGRATORS = st.sampled_from(["symplectic", "rk4"])


def assert_close(name: str, found: Any, expected: Any) -> None:
    """To 1e-11 of the largest value."""
    assert np.shape(found) == np.shape(expected), name
    error = np.abs(np.subtract(found, expected)).max(initial=0.0) / max(np.abs(expected).max(initial=0.0), 1e-300)
    assert error < 1e-11, f"{name} differs by {error:.3g}"


def assert_same(run: Simulation, plain: Plain, seed: int) -> None:
    """Compare all that can be seen of a state."""
    fields, ghosts = run.fields(), run.ghost_fields()
    for name, found, expected in (
        ("position", fields.position, plain.x),
        ("velocity", fields.velocity, plain.u),
        ("pressure", fields.pressure, plain.c0**2 * (plain.rho - plain.rho0)),
        ("ghost position", ghosts.position, plain.ghost),
        ("ghost pressure", ghosts.pressure, plain.ghost_p),
        ("ghost density", ghosts.density - plain.rho0, plain.ghost_rho - plain.rho0),
        ("ghost velocity", ghosts.velocity, plain.ghost_u),
        ("density gradient", run.in_original_order(run.system.gradient), plain.gradient),
        ("acceleration", run.in_original_order(run.system.rates[:, run.columns.velocity]), plain.a),
    ):
        assert_close(name, found, expected)
    plain.prepare(plain.time)
    assert_close("energies", list(run.energies().values()), list(plain.energies().values()))
    points = plain.x + DX * np.random.default_rng(seed).normal(size=plain.x.shape)
    assert_close("samples", run.sample(points)[0], plain.sample(points))
    run.system.fill_ghosts()
    run.system.update_loads()
    assert_close("loads", run.system.loads, plain.loads())


def compare(seed: int, dim: int, walls: str = "box", steps: int = 2, **options: Any) -> None:
    """Make some steps with both."""
    run, plain = random_scene(seed, dim, walls, **options)
    integrate = plain.rk4 if options.get("integrator") == "rk4" else plain.symplectic
    for _ in range(steps):
        run.advance()
        integrate(1e-3)
        run.system.keep(np.random.default_rng(seed).permutation(run.fluid_count))  # each keeps all that is its own
        run.system.find_neighbours()
    assert_same(run, plain, seed)


@settings(max_examples=6)
@given(SEEDS, st.sampled_from(["box", "moving", "at rest"]), SLIP, INTEGRATORS)
def test_the_default_in_the_plane(seed: int, walls: str, slip: str, integrator: str) -> None:
    compare(seed, 2, walls, slip=slip, integrator=integrator)


@settings(max_examples=3)
@given(SEEDS, SLIP)
def test_the_default_in_space(seed: int, slip: str) -> None:
    compare(seed, 3, slip=slip)


@settings(max_examples=5)
@given(SEEDS, st.sampled_from(["box", "moving"]), SLIP)
def test_the_mirror_lift_and_laminar_viscosity_in_the_plane(seed: int, walls: str, slip: str) -> None:
    compare(
        seed, 2, walls, slip=slip, hydrostatic_lift="mirror", interpolator="normalized", kinematic_viscosity=0.02,
        tension="free",
    )  # fmt: skip


LEAST_SQUARES = {"interpolator": "mls-linear", "hydrostatic_lift": "mirror"}


@settings(max_examples=5)
@given(SEEDS, st.sampled_from(["box", "moving"]))
def test_moving_least_squares_in_the_plane(seed: int, walls: str) -> None:
    compare(seed, 2, walls, **LEAST_SQUARES)


@pytest.mark.long
@pytest.mark.parametrize(
    ("dim", "options"),
    [
        (2, {}),
        (2, {"hydrostatic_lift": "mirror", "interpolator": "normalized", "kinematic_viscosity": 0.02,
             "tension": "free"}),
        (2, {"ghost_velocity": "interpolated", "interpolator": "shepard", "kinematic_viscosity": 0.02,
             "viscosity_model": "monaghan-gingold", "lowest_pressure": -300.0}),
        (2, LEAST_SQUARES),
        (3, {}),
        (3, {"hydrostatic_lift": "mirror", "interpolator": "normalized", "kinematic_viscosity": 0.02}),
    ],
    ids=["default", "mirror", "interpolated", "least-squares", "space", "mirror-in-space"],
)  # fmt: skip
def test_two_hundred_scenes(dim: int, options: dict[str, Any]) -> None:
    for seed in range(1000, 1040):
        walls = "box" if dim == 3 else ("box", "moving", "at rest")[seed % 3]
        integrator = ("symplectic", "rk4")[seed // 3 % 2]
        compare(seed, dim, walls, slip=("free", "no")[seed // 6 % 2], integrator=integrator, **options)
