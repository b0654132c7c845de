"""Properties of the methods of the project that are not traits of the interface."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sphframe import OK, SINGULAR, TOO_FEW, create
from sphframe.kernels.gaussian import RenormalisedGaussian
from sphframe.testing import Cloud, clouds, evaluate
from sphframe.testing.evaluation import evaluator
from sphframe.testing.kernels import kernel_value
from sphframe.testing.neighbourhoods import REGULAR, condition

FAST = settings(deadline=None, max_examples=60)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("name", ["improved-shepard", "shepard", "normalized", "adami"])
def test_a_single_neighbour_has_weight_one(name, dim):
    run = evaluator(create("interpolators", name), dim)

    @FAST
    @given(
        fraction=st.floats(0.0, 1.0, exclude_max=True),
        support=st.floats(1e-6, 1e4),
        volume=st.floats(1e-18, 1e9),
        axis=st.integers(0, dim - 1),
    )
    def prove(fraction, support, volume, axis):
        offset = np.zeros(dim)
        offset[axis] = fraction * support
        if offset[axis] < support:
            assert run(Cloud([offset], [volume], support)).weights.tolist() == [1.0]

    prove()


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize(("name", "degree"), [("mls-linear", 1), ("mls-quadratic", 2)])
def test_least_squares_is_that_of_numpy(name, degree, dim):
    run = evaluator(create("interpolators", name), dim)

    @FAST
    @given(clouds(dim, (*REGULAR, "thin sheet", "spray"), largest=1.1))
    def prove(cloud):
        outcome = run(cloud)
        if outcome.status != OK:
            return
        x = cloud.offsets * 3.0 / cloud.support
        columns = [np.ones(len(x)), *x.T]
        if degree == 2:
            columns += [x[:, a] * x[:, b] for a in range(dim) for b in range(a + 1)]
        basis = np.column_stack(columns)
        weights = kernel_value(RenormalisedGaussian(), cloud.distances, cloud.support / 3.0, dim) * cloud.volumes
        root = np.sqrt(weights / weights.max())
        # value = e1 . c with c the least-squares solution for the data f: one column of f per neighbour
        expected = np.linalg.lstsq(root[:, None] * basis, np.diag(root), rcond=None)[0][0]
        slack = min(1e3 * np.finfo(float).eps * condition(cloud, degree), 1e-3) * outcome.magnitude
        np.testing.assert_allclose(outcome.weights, expected, rtol=0.0, atol=slack)

    prove()


@pytest.mark.parametrize(("name", "count"), [("mls-linear", 2), ("mls-quadratic", 5), ("sfdi", 2), ("mdbc", 2)])
def test_too_few_points_are_never_solved(name, count):
    method = create("interpolators", name)
    rng = np.random.default_rng(0)
    for _ in range(50):
        outcome = evaluate(method, Cloud(rng.uniform(-0.6, 0.6, (count, 2)), np.ones(count), 1.0))
        assert outcome.status == TOO_FEW
        assert outcome.weights.sum() == pytest.approx(1.0, abs=1e-14)


@pytest.mark.parametrize("form", ["coupled", "printed"])
def test_sfdi_with_one_column_of_particles_uses_the_fallback(form):
    cloud = Cloud([[0.1, 0.5 * k] for k in range(-4, 5)], np.ones(9), 3.0)
    assert evaluate(create("interpolators", "sfdi", form=form), cloud).status == SINGULAR


def test_printed_sfdi_errs_on_linear_fields_as_published():
    """The error is a bounded fraction of |grad f| dx, since the printed form omits the cross term."""
    run = evaluator(create("interpolators", "sfdi", form="printed"), 2)
    rng = np.random.default_rng(2)
    errors = []
    for _ in range(200):
        x, y = np.meshgrid(np.arange(-5, 6), np.arange(-5, 6))
        offsets = np.column_stack([x.ravel(), y.ravel()]) + rng.uniform(-0.2, 0.2, (121, 2)) + rng.uniform(-0.5, 0.5, 2)
        offsets = offsets[np.linalg.norm(offsets, axis=1) < 3.9]
        errors.append(np.linalg.norm(run(Cloud(offsets, np.ones(len(offsets)), 3.9)).weights @ offsets))
    assert 1e-3 < max(errors) < 0.2


def test_two_neighbours_at_the_cut_off_have_positive_weights():
    cloud = Cloud([[-2.9999999999, 0.0], [0.0, 2.9999999999999]], np.ones(2), 3.0)
    assert evaluate(create("interpolators", "normalized"), cloud).weights.min() >= 0.0
