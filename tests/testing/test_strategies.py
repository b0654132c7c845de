"""The public strategies: what they draw is what they say, and finds wrong components."""

import math

import numpy as np
import pytest
from hypothesis import find, given, settings
from hypothesis.errors import NoSuchExample

from sphframe import create
from sphframe.cases.custom import Custom
from sphframe.kernels.wendland import WendlandC2
from sphframe.simulation.simulation import Simulation
from sphframe.testing import evaluate
from sphframe.testing.strategies import basins, body_states, flattened_clouds, kernel_arguments, oscillators, states

KERNEL = WendlandC2()
few = settings(max_examples=30, deadline=None)


@pytest.mark.parametrize(("degree", "dim"), [(1, 2), (1, 3), (2, 2), (2, 3)])
def test_flattened_clouds_hardly_determine_a_polynomial(degree, dim):
    @few
    @given(flattened_clouds(dim, degree=degree))
    def holds(cloud):
        x = cloud.offsets / cloud.support
        columns = [np.ones(len(x)), *x.T]
        if degree == 2:
            columns += [x[:, a] * x[:, b] for a in range(dim) for b in range(a + 1)]
        singular = np.linalg.svd(np.column_stack(columns), compute_uv=False)
        assert singular[-1] < 0.01 * singular[0]
        assert cloud.distances.max() < cloud.support
        outcome = evaluate(create("interpolators", "mls-linear"), cloud)
        assert np.isfinite(outcome.weights).all()
        assert outcome.magnitude < 3.0 + 1e-9

    holds()


@few
@given(kernel_arguments(KERNEL))
def test_kernels_have_arguments_within_their_support(q):
    assert 0.0 <= q < KERNEL.support
    assert KERNEL.value_function()(q) >= 0.0


def test_an_error_near_the_cut_off_is_found():
    def wrong(q):
        return KERNEL.value_function()(q) - (1e-3 if q > 0.995 * KERNEL.support else 0.0) < 0.0

    assert find(kernel_arguments(KERNEL), wrong, settings=settings(deadline=None)) > 0.995 * KERNEL.support


@few
@given(states())
def test_states_invert_both_equations(state):
    rho, rho0, c0 = state
    for name in ("tait", "linear"):
        equation = create("equations_of_state", name)
        pressure, density = equation.pressure_function(), equation.density_function()
        assert math.isclose(density(pressure(rho, rho0, c0), rho0, c0), rho, rel_tol=1e-9)


def test_a_reference_density_of_water_written_into_an_inverse_is_found():
    assert find(states(), lambda state: state.reference_density != 1000.0)
    with pytest.raises(NoSuchExample):
        find(states(0.9, 1.1), lambda state: not 0.89 < state.density / state.reference_density < 1.11)


@few
@given(oscillators())
def test_oscillators_are_integrated_to_their_exact_solution(oscillator):
    integrator = create("integrators", "rk4")
    for k in range(20):
        integrator.step(oscillator, 0.05 * k, 0.05)
    found = oscillator.x, oscillator.u, oscillator.rho
    np.testing.assert_allclose(found, oscillator.exact(1.0), atol=1e-5)


@few
@given(body_states())
def test_springs_accelerate_by_their_load(state):
    body = create("rigid_bodies", "spring-mass", mass=2.0, stiffness=3.0)
    motion = body.motion(*state)
    assert np.isfinite(motion.acceleration).all()
    assert all(np.shape(part) == (3,) for part in motion)


@settings(max_examples=4, deadline=None)
@given(basins())
def test_water_in_a_basin_has_finite_rates(basin):
    simulation = Simulation(Custom(**basin, wall_treatment={"name": "fixed-ghosts"}), threads=1)
    assert np.isfinite(simulation.system.rates).all()
    assert simulation.fluid_count >= 36
