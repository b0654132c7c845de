"""Every term of the equations compared with plain NumPy, and properties of physics that hold exactly."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sphframe.boundary.corners import Shares
from sphframe.boundary.images import Images
from sphframe.compiled import LANES, specialise
from sphframe.neighbours.sight import WHOLE
from sphframe.particles import Columns
from sphframe.physics import wall_reaction
from sphframe.physics.density_gradient import renormalised_2d, renormalised_3d

from .cloud import make_cloud


def neighbours(cloud, i):
    """All other particles, fluid and ghosts; those beyond the support have no weight."""
    others = np.delete(np.arange(len(cloud.rows)), i)
    return others[others < cloud.fluid_count], others[others >= cloud.fluid_count]


def slow_gradient(cloud):
    c = Columns.of(cloud.dim)
    gradient = np.zeros((cloud.fluid_count, cloud.dim))
    for i in range(cloud.fluid_count):
        fluid, _ = neighbours(cloud, i)
        x_ji = cloud.rows[fluid, c.position] - cloud.rows[i, c.position]
        weighted = cloud.grad_kernel(x_ji) * cloud.rows[fluid, c.volume][:, None]
        matrix = x_ji.T @ weighted
        right = (cloud.rows[fluid, c.density] - cloud.rows[i, c.density]) @ weighted
        gradient[i] = np.linalg.solve(matrix, right)
    return gradient


def slow_rates(cloud, gradient, diffusion, viscosity, body_force, force_gradient, friction=0.0):
    c = Columns.of(cloud.dim)
    rates = np.zeros((cloud.fluid_count, 2 * cloud.dim + 1))
    for i in range(cloud.fluid_count):
        fluid, ghosts = neighbours(cloud, i)
        for near, diffuses in ((fluid, True), (ghosts, False)):
            x_ji = cloud.rows[near, c.position] - cloud.rows[i, c.position]
            r2 = np.einsum("ij,ij->i", x_ji, x_ji)
            grad = cloud.grad_kernel(x_ji)
            volume = cloud.rows[near, c.volume]
            u_ji = cloud.rows[near, c.velocity] - cloud.rows[i, c.velocity]
            density = cloud.rows[i, c.density]
            rates[i, -1] -= density * np.sum(np.einsum("ij,ij->i", u_ji, grad) * volume)
            if diffuses:
                psi = 2.0 * (cloud.rows[near, c.density] - density)[:, None] * x_ji / r2[:, None]
                psi -= gradient[i] + gradient[near]
                rates[i, -1] += diffusion * np.sum(np.einsum("ij,ij->i", psi, grad) * volume)
            pressures = cloud.rows[i, c.pressure] + cloud.rows[near, c.pressure]
            pi = np.einsum("ij,ij->i", u_ji, x_ji) / r2
            force = ((viscosity * pi - pressures) * volume) @ grad
            force += friction * (u_ji.T @ (np.einsum("ij,ij->i", x_ji, grad) / r2 * volume))
            rates[i, cloud.dim : 2 * cloud.dim] += force / density
        rates[i, : cloud.dim] = cloud.rows[i, c.velocity]
        slope = np.reshape(force_gradient, (3, 3))[: cloud.dim, : cloud.dim]
        rates[i, cloud.dim : 2 * cloud.dim] += body_force[: cloud.dim] + slope @ cloud.rows[i, c.position]
    return rates


@pytest.mark.parametrize(("kernel", "dim"), [("gaussian", 2), ("gaussian", 3), ("wendland-c2", 2)])
def test_rates_equal_the_slow_version(kernel, dim):
    cloud = make_cloud(dim, 1, kernel=kernel, cells=9 if dim == 2 else 5)
    gradient = cloud.density_gradient()
    expected_gradient = slow_gradient(cloud)
    np.testing.assert_allclose(gradient, expected_gradient, rtol=1e-8, atol=1e-9 * np.abs(expected_gradient).max())
    force, force_gradient = (1.5, -9.81, 4.0), (3.0, -1.0, 0.5, 2.0, -5.0, 1.0, 0.7, 0.2, -2.0)
    numbers = {"diffusion": 0.7, "viscosity": 130.0, "force": force, "force_gradient": force_gradient}
    if kernel == "gaussian":
        cloud.morris, numbers["friction"] = True, 70.0
    rates = cloud.rates(gradient, **numbers)
    expected = slow_rates(cloud, gradient, body_force=numbers.pop("force"), **numbers)
    np.testing.assert_allclose(rates, expected, rtol=1e-9, atol=1e-10 * np.abs(expected).max())


@settings(max_examples=20, deadline=None)
@given(dim=st.sampled_from([2, 3]), seed=st.integers(0, 10_000), slope=st.floats(-500.0, 500.0))
def test_gradient_and_diffusion_are_exact_for_a_linear_density(dim, seed, slope):
    cloud = make_cloud(dim, seed, ghosts=False, cells=5)
    c = Columns.of(dim)
    direction = np.arange(1.0, dim + 1.0) * slope
    cloud.rows[:, c.density] = 1000.0 + cloud.rows[:, c.position] @ direction
    cloud.rows[:, c.velocity] = 0.0
    gradient = cloud.density_gradient()
    np.testing.assert_allclose(gradient, np.broadcast_to(direction, gradient.shape), atol=1e-9 * (1 + abs(slope)))
    rates = cloud.rates(gradient, diffusion=1.0)
    scale = cloud.gradient_scale * cloud.h**2 * (1.0 + abs(slope))
    assert np.abs(rates[:, -1]).max() < 1e-11 * scale * len(rates), "the diffusion must annihilate a linear density"


@settings(max_examples=20, deadline=None)
@given(dim=st.sampled_from([2, 3]), seed=st.integers(0, 10_000))
def test_a_free_blob_keeps_its_momentum(dim, seed):
    cloud = make_cloud(dim, seed, ghosts=False, cells=5)
    rates = cloud.rates(cloud.density_gradient(), viscosity=500.0)
    masses = cloud.rows[:, Columns.of(dim).mass]
    forces = masses[:, None] * rates[:, dim : 2 * dim]
    assert np.abs(forces.sum(axis=0)).max() < 1e-12 * np.abs(forces).sum(), "momentum must be conserved to round-off"


@settings(max_examples=20, deadline=None)
@given(dim=st.sampled_from([2, 3]), seed=st.integers(0, 10_000))
def test_diffusion_keeps_the_volume_weighted_density(dim, seed):
    cloud = make_cloud(dim, seed, ghosts=True, cells=5)
    c = Columns.of(dim)
    cloud.rows[:, c.velocity] = 0.0
    rates = cloud.rates(cloud.density_gradient(), diffusion=1.0)
    change = cloud.rows[: cloud.fluid_count, c.volume] * rates[:, -1]
    assert abs(change.sum()) < 1e-11 * np.abs(change).sum()


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_spray_never_gives_nan(dim, count):
    cloud = make_cloud(dim, 0, ghosts=False, cells=2)
    c = Columns.of(dim)
    cloud.rows[:, c.position] *= 100.0  # too far apart to be neighbours
    for k in range(count):  # except a few on one line, two of them at one place
        cloud.rows[k, c.position] = [0.01 * (k // 2), *[0.0] * (dim - 1)]
    gradient = cloud.density_gradient()
    rates = cloud.rates(gradient, diffusion=1.0, viscosity=1.0)
    assert np.isfinite(gradient).all()
    assert np.isfinite(rates).all()


@pytest.mark.parametrize(("dim", "hidden"), [(2, False), (2, True), (3, False)])
def test_wall_reaction_is_opposite_to_what_ghosts_do_to_the_fluid(dim, hidden):
    cloud = make_cloud(dim, 3, cells=9 if dim == 2 else 5)
    if hidden:
        cloud.shares = np.random.default_rng(5).integers(0, WHOLE + 1, (*cloud.lists.shape, LANES)).astype(np.uint8)
    c = Columns.of(dim)
    gradient = np.zeros((cloud.fluid_count, dim))
    viscosity = 50.0
    with_ghosts = cloud.rates(gradient, viscosity=viscosity)
    counts, cloud.ghost_counts = cloud.ghost_counts, np.zeros_like(cloud.ghost_counts)
    without = cloud.rates(gradient, viscosity=viscosity)
    cloud.ghost_counts = counts
    masses = cloud.rows[: cloud.fluid_count, c.mass]
    expected = -(masses[:, None] * (with_ghosts - without)[:, dim : 2 * dim]).sum(axis=0)
    ghosts = len(cloud.rows) - cloud.fluid_count
    walls = (np.arange(ghosts) % 2).astype(np.int64)
    nothing = np.zeros((ghosts, dim))
    partial = np.zeros((7, 2, 3 if dim == 2 else 6))
    specialise(wall_reaction, cloud.parts())(
        cloud.rows, cloud.fluid_count, cloud.lists, cloud.fluid_counts, cloud.ghost_counts, cloud.shares, walls,
        Shares(np.full_like(walls, -1), nothing, nothing), np.zeros((2, dim)), cloud.walls(), Images.of(0, dim),
        cloud.parameters(viscosity=viscosity),
        partial,
    )  # fmt: skip
    loads = partial.sum(axis=0)
    np.testing.assert_allclose(loads[:, :dim].sum(axis=0), expected, rtol=1e-10)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize(("condition", "solved"), [(0.021, True), (0.019, False), (-0.1, False)])
def test_matrices_are_inverted_from_a_fiftieth_of_a_full_one_on_in_any_unit(dim, unit, condition, solved):
    turn = np.linalg.qr(np.random.default_rng(dim).normal(size=(dim, dim)))[0]
    # eigenvalues 1 - e, 1 + e (and 1) have the mean 1 and the determinant 1 - e^2
    eigenvalues = np.append(1.0 + np.sqrt(1.0 - condition) * np.array([-1.0, 1.0]), np.ones(dim - 2))
    matrix = unit * turn @ np.diag(eigenvalues) @ turn.T
    right = unit * np.arange(1.0, dim + 1.0)
    upper = [matrix[j, k] for k in range(dim) for j in range(k + 1)]
    found = (renormalised_2d if dim == 2 else renormalised_3d).py_func(*right, *upper)
    np.testing.assert_allclose(found, np.linalg.solve(matrix, right) if solved else right, rtol=1e-9)
