"""The fallback that is linear along the directions in which the neighbours are spread, and constant across them."""

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sphframe_mls import LinearMLS, QuadraticMLS

from sphframe import BoundaryInterpolator, Status, Traits
from sphframe.interfaces.boundary_interpolator import kernel_average
from sphframe.kernels.gaussian import RenormalisedGaussian
from sphframe.testing import Cloud, checks_of, clouds, evaluate, parametrize_with_checks
from sphframe.testing.evaluation import evaluator
from sphframe.testing.kernels import kernel_value
from sphframe.testing.neighbourhoods import ALL
from sphframe.testing.strategies import flattened_clouds

FAST = settings(deadline=None, max_examples=100)
LINEAR, QUADRATIC = LinearMLS(fallback="rank-revealing"), QuadraticMLS(fallback="rank-revealing")


@dataclass(frozen=True)
class Always(BoundaryInterpolator):
    """The fallback as a method of its own."""

    amplification: float = 3.0

    traits = Traits()

    def point_weights(self, kernel, dim):
        return LinearMLS(self.amplification, "rank-revealing").fallback_weights(kernel, dim)


@pytest.mark.long
@parametrize_with_checks([Always()])
def test_has_its_traits(method, check):
    """Its weights are continuous, also where a particle enters and where a direction is left out."""
    check(method)


def test_a_method_has_the_traits_that_depend_on_its_fallback():
    for check in checks_of(LINEAR):
        if str(check) in ("rank-2d", "rotation_invariance-2d", "partition_of_unity-2d"):
            check(LINEAR)


@pytest.mark.long
@parametrize_with_checks([LINEAR, QUADRATIC])
def test_methods_have_their_traits(method, check):
    check(method)


def test_the_default_is_the_kernel_average():
    for method in (LinearMLS(), QuadraticMLS()):
        assert method.fallback_weights(None, 2) is kernel_average


def spread(cloud):
    """The shares a_j (n,) of the kernel average, standard deviations in h (dim,) and directions in columns."""
    h = cloud.support / 3.0
    shares = kernel_value(RenormalisedGaussian(), cloud.distances, h, cloud.dim) * cloud.volumes
    shares = shares / shares.sum()
    away = cloud.offsets - shares @ cloud.offsets
    singular, directions = np.linalg.svd(np.sqrt(shares)[:, None] * away / h)[1:]
    deviations = np.zeros(cloud.dim)
    deviations[: len(singular)] = singular
    return shares, deviations, directions.T


@pytest.mark.parametrize("dim", [2, 3])
def test_is_a_least_squares_fit_in_the_space_of_the_neighbours(dim):
    run, tried = evaluator(Always(1e9), dim), []

    @FAST
    @given(
        st.one_of(
            flattened_clouds(dim), clouds(dim, ("collinear", "nearly collinear", "spray", "thin sheet")), clouds(dim)
        )
    )
    def prove(cloud):
        shares, deviations, directions = spread(cloud)
        if np.any((deviations > 0.0999) & (deviations < 0.2001)):
            return
        kept = directions[:, deviations > 0.15]
        tried.append(kept.shape[1])
        basis = np.column_stack([np.ones(len(cloud)), cloud.offsets * 3.0 / cloud.support @ kept])
        root = np.sqrt(shares)
        expected = np.linalg.lstsq(root[:, None] * basis, np.diag(root), rcond=None)[0][0]
        weights = run(cloud).weights
        np.testing.assert_allclose(weights, expected, rtol=0.0, atol=1e-10 * max(1.0, np.abs(expected).sum()))

    prove()
    assert set(tried) >= set(range(1, dim + 1))


@pytest.mark.parametrize(("dim", "rank"), [(2, 1), (3, 1), (3, 2)])
@pytest.mark.parametrize("method", [LINEAR, QUADRATIC])
def test_is_exact_along_a_line_or_plane_and_constant_across(method, dim, rank):
    """The value is that at the foot of the perpendicular, for points on a line in 2-D and 3-D and in a plane."""
    rng = np.random.default_rng(1)
    run = evaluator(method, dim)
    for _ in range(20):
        directions = np.linalg.qr(rng.normal(size=(dim, dim)))[0]
        axes = np.meshgrid(*[np.arange(-2.0, 3.0)] * rank)
        along = np.stack(axes, axis=-1).reshape(-1, rank) + rng.uniform(-0.2, 0.2, (5**rank, rank))
        across = rng.uniform(-1.0, 1.0, dim - rank)
        offsets = along @ directions[:, :rank].T + across @ directions[:, rank:].T
        outcome = run(Cloud(offsets, rng.uniform(0.5, 2.0, len(offsets)), 3.9).clear_of_cut_off(0.0))
        assert outcome.status != Status.OK
        inside = np.linalg.norm(offsets, axis=1) < 3.9
        slopes = rng.normal(size=dim)
        field = 3.0 + (offsets @ directions) @ slopes
        assert outcome.weights @ field[inside] == pytest.approx(3.0 + across @ slopes[rank:], abs=1e-12)


def test_two_neighbours_are_interpolated_linearly():
    outcome = evaluate(LINEAR, Cloud([[-0.25, 0.6], [0.75, 0.6]], volumes=[1.0, 1.3], support=3.9))
    assert outcome.status == Status.TOO_FEW
    assert outcome.weights == pytest.approx([0.75, 0.25], abs=1e-14)
    average = evaluate(LinearMLS(), Cloud([[-0.25, 0.6], [0.75, 0.6]], volumes=[1.0, 1.3], support=3.9))
    assert abs(average.weights[0] - 0.75) > 0.05


@pytest.mark.parametrize("dim", [2, 3])
def test_sums_to_one_and_bounds_the_weights_for_every_cloud(dim):
    run = evaluator(Always(1.7), dim)

    @FAST
    @given(st.one_of(clouds(dim, ALL), flattened_clouds(dim)))
    def prove(cloud):
        weights = run(cloud).weights
        assert abs(weights.sum() - 1.0) < 1e-12
        assert np.abs(weights).sum() <= 1.7 + 1e-12

    prove()


def test_joins_the_method_where_the_weights_become_too_large():
    """As the point leaves a half plane of particles, the status changes and the weights do not jump."""
    lattice = np.stack(np.meshgrid(np.arange(-3.0, 4.0), np.arange(0.0, 4.0)), axis=-1).reshape(-1, 2)

    def at(height):
        offsets = lattice - [0.3, -height]
        return evaluate(LINEAR, Cloud(offsets, np.ones(len(offsets)), 6.0))

    low, high = 0.0, 3.0
    assert (at(low).status, at(high).status) == (Status.OK, Status.SINGULAR)
    for _ in range(45):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if at(middle).status == Status.OK else (low, middle)
    np.testing.assert_allclose(at(low).weights, at(high).weights, rtol=0.0, atol=1e-11)


def test_other_fallbacks_are_refused():
    with pytest.raises(ValueError, match='must be "kernel-average" or "rank-revealing", got \'none\''):
        LinearMLS(fallback="none")
