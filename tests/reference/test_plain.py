"""Steps of the solver are those of plain NumPy, on random scenes."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sphframe import Simulation

from .plain import Plain
from .scenes import DX, random_scene
from .treatments import IN_THE_PLANE, TREATMENTS
from .walls import turn

pytestmark = pytest.mark.filterwarnings("ignore::sphframe.cases.CaseWarning")
SEEDS = st.integers(0, 10**6)
MANY = 8
"""scenes of each kind in a long test"""
SLIP = st.sampled_from(["free", "no"])
INTEGRATORS = st.sampled_from(["symplectic", "rk4"])


def assert_close(name: str, found: Any, expected: Any) -> None:
    """To 1e-11 of the largest value."""
    assert np.shape(found) == np.shape(expected), name
    error = np.abs(np.subtract(found, expected)).max(initial=0.0) / max(np.abs(expected).max(initial=0.0), 1e-300)
    assert error < 1e-11, f"{name} differs by {error:.3g}"


def assert_same(run: Simulation, plain: Plain, seed: int) -> None:
    """Compare all that can be seen of a state."""
    fields, ghosts, walls = run.fields(), run.ghost_fields(), plain.walls
    quantities = [
        ("position", fields.position + run.turns() * walls.period, plain.x),
        ("velocity", fields.velocity, plain.u),
        ("pressure", fields.pressure, plain.pressure()),
        ("density gradient", run.in_original_order(run.system.gradient), plain.gradient),
        ("acceleration", run.in_original_order(run.system.rates[:, run.columns.velocity]), plain.a),
        ("ghost position", ghosts.position, walls.wrapped(walls.ghost)),
        ("wall density", run.boundary.wall_state, plain.wall_density),
    ]
    if np.isfinite(plain.free.mass):
        body = run.system.bodies
        quantities += [
            ("displacement", body.position[0, : plain.dim], plain.free.position[: plain.dim]),
            ("turn", turn(body.position[0]), turn(plain.free.position)),
            ("velocity of the body", body.velocity[0], plain.free.velocity),
        ]
    if plain.ghosts.position is None:  # ghosts do not count beside images
        near = (np.linalg.norm(plain.x_gi, axis=2) < run.support).any(axis=0)  # others are left as they were
        quantities += [
            ("ghost pressure", ghosts.pressure[near], plain.ghost_p[near]),
            ("ghost density", ghosts.density[near] - plain.rho0, plain.ghost_density()[near] - plain.rho0),
            ("ghost velocity", ghosts.velocity[near], plain.ghost_u[near]),
        ]
    for name, found, expected in quantities:
        assert_close(name, found, expected)
    plain.prepare(plain.time)
    assert_close("energies", list(run.energies().values()), list(plain.energies().values()))
    points = plain.x + DX * np.random.default_rng(seed).normal(size=plain.x.shape)
    assert_close("samples", run.sample(points)[0], plain.sample(points))
    run.system.move_walls(plain.time)
    run.system.fill_ghosts()
    run.system.update_loads()
    assert_close("loads", run.system.loads, plain.loads())


def compare(seed: int, dim: int, walls: str = "box", steps: int = 2, **options: Any) -> None:
    """Make some steps with both."""
    run, plain = random_scene(seed, dim, walls, **options)
    for _ in range(steps):
        run.advance()
        plain.advance(1e-3)
        run.system.keep(np.random.default_rng(seed).permutation(run.fluid_count))  # each keeps all that is its own
        run.system.find_neighbours()
    if plain.condition < 1e5:  # round-off is multiplied by it
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


@settings(max_examples=4)
@given(SEEDS, INTEGRATORS)
def test_a_free_body_in_the_plane(seed: int, integrator: str) -> None:
    compare(seed, 2, "free box", integrator=integrator)


@settings(max_examples=2)
@given(SEEDS)
def test_a_free_body_in_space(seed: int) -> None:
    for integrator in ("symplectic", "rk4"):
        compare(seed, 3, "free box", integrator=integrator)


@settings(max_examples=4)
@given(SEEDS, st.sampled_from(["channel", "moving channel", "nothing"]))
def test_what_repeats_itself_in_the_plane(seed: int, walls: str) -> None:
    compare(seed, 2, walls, **SHEARED)


SHEARED = {"slip": "no", "kinematic_viscosity": 0.02, "tension": "free"}
"""the loops of the conformance checks of treatments"""
MIRROR = {"hydrostatic_lift": "mirror"}
METHODS = [{"interpolator": name} for name in ("mls-linear", "mls-quadratic", "sfdi", "mdbc", "adami")]
"""their loops are those of ``tests/boundary/test_ghosts.py``"""
WALLS: list[dict[str, Any]] = [{"name": name} for name in TREATMENTS]
OPTIONS: list[dict[str, Any]] = [
    {"name": "fixed-ghosts", "continuity": "free-slip"},
    {"name": "mdbc-2025", "velocity": "corrected"},
    {"name": "dynamic-2007", "diffusion": 0.1},
    {"name": "distance-ratio", "continuity": "ratio", "cap": 1.5},
]


def described(given: dict[str, Any]) -> str:
    """The values."""
    return ",".join(map(str, given.values()))


@pytest.mark.parametrize("method", METHODS, ids=described)
@settings(max_examples=2)
@given(SEEDS, st.sampled_from(["box", "moving"]))
def test_methods_in_the_plane(method: dict[str, Any], seed: int, walls: str) -> None:
    compare(seed, 2, walls, **method)


def compare_walls(treatment: dict[str, Any], seed: int, dim: int, walls: str, **options: Any) -> None:
    """Compare a treatment; images have the velocity and force of the nearest ghost, so that theirs do not vary."""
    images = treatment["name"] == "mirror-images"
    compare(seed, dim, "carried box" if images else walls, wall_treatment=treatment, **options)


@pytest.mark.parametrize("treatment", WALLS, ids=described)
@settings(max_examples=2)
@given(SEEDS, st.sampled_from(["box", "moving", "at rest"]))
def test_treatments_in_the_plane(treatment: dict[str, Any], seed: int, walls: str) -> None:
    for integrator in ("symplectic", "rk4"):
        compare_walls(treatment, seed, 2, walls, integrator=integrator, **SHEARED)


RELEASED = {**SHEARED, "tension": "none"}
SHORT = ("fixed-ghosts", "mirror-images", "pair-mirror")
"""their loops are those of ``tests/simulation/test_wall_treatments_run.py``"""


@pytest.mark.parametrize(
    "treatment",
    [pytest.param(given, marks=[] if given["name"] in SHORT else pytest.mark.long) for given in WALLS],
    ids=described,
)
@settings(max_examples=2)
@given(SEEDS, st.sampled_from(["box", "moving", "at rest"]))
def test_walls_that_do_not_attract(treatment: dict[str, Any], seed: int, walls: str) -> None:
    compare_walls(treatment, seed, 2, walls, **RELEASED)


SHIFTED = {"shifting": 1.0, "tensile_control": "on"}


@settings(max_examples=2)
@given(SEEDS)
def test_shifting_and_the_control_of_the_tensile_instability(seed: int) -> None:
    for walls in ("box", "full box"):
        compare(seed, 2, walls, **SHIFTED)


SCENES = [
    *((2, given) for given in (
        {}, {**MIRROR, "interpolator": "normalized", "kinematic_viscosity": 0.02, "tension": "free"},
        {"ghost_velocity": "interpolated", "interpolator": "shepard", "kinematic_viscosity": 0.02,
         "viscosity_model": "monaghan-gingold", "lowest_pressure": -300.0},
        *METHODS, *(SHEARED | MIRROR | method for method in METHODS),
    )),
    (3, {}), (3, {**MIRROR, "interpolator": "normalized", "kinematic_viscosity": 0.02}),
    *((3, method) for method in METHODS),
    *((dim, {**SHIFTED, "tension": "free"}) for dim in (2, 3)),
    (2, {**SHIFTED, "shifting": 0.7, "equation_of_state": {"name": "linear", "background_pressure": 2000.0}}),
]  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize(("dim", "given"), SCENES, ids=str)
def test_many_scenes(dim: int, given: dict[str, Any]) -> None:
    for seed in range(1000, 1000 + MANY):
        walls = "box" if dim == 3 else ("box", "moving", "at rest")[seed % 3]
        integrator = ("symplectic", "rk4")[seed // 3 % 2]
        compare(seed, dim, walls, **{"slip": ("free", "no")[seed // 6 % 2], "integrator": integrator, **given})


@pytest.mark.long
@pytest.mark.parametrize("walls", ["channel", "moving channel", "nothing", "gutter"])
def test_many_scenes_that_repeat_themselves(walls: str) -> None:
    for seed in range(1000, 1000 + MANY):
        slip, integrator = ("free", "no")[seed % 2], ("symplectic", "rk4")[seed // 2 % 2]
        compare(seed, 3 if walls == "gutter" else 2, walls, slip=slip, integrator=integrator, tension="free")


@pytest.mark.long
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("treatment", [*WALLS, *OPTIONS], ids=described)
def test_many_scenes_of_treatments(treatment: dict[str, Any], dim: int) -> None:
    if dim == 3 and treatment["name"] in IN_THE_PLANE:
        pytest.skip("in two dimensions alone")
    for seed in range(1000, 1000 + MANY):
        walls = ("box", "free box")[seed % 2] if dim == 3 else ("box", "moving", "at rest", "free box")[seed % 4]
        given = (SHEARED, RELEASED, {"slip": "free", "integrator": "rk4"})[seed // 3 % 3]
        compare_walls(treatment, seed, dim, walls, **given)
