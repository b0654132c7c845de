import numpy as np
import pytest
from sphframe_hashemi import Hashemi, NormalDerivative

from sphframe import Status
from sphframe.boundary.operator import operator
from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([Hashemi()])
def test_has_its_traits(treatment, check):
    check(treatment)


@pytest.mark.parametrize("depth", [0.5, 1.5, 2.5])
def test_pressures_whose_derivative_along_the_normal_is_known_are_exact(depth):
    """p_G = sum Phi_j p_j - (b.n) sum Phi_j (x_j - x_G).n for linear p with any gradient along the wall."""
    random = np.random.default_rng(2)
    x, y = np.meshgrid(np.arange(-5.0, 5.0) + 0.5, np.arange(5.0) + 0.5)
    position = np.column_stack([x.ravel(), y.ravel()]) + random.uniform(-0.2, 0.2, (x.size, 2))
    ghost, normal, gradient = np.array([0.1, -depth]), np.array([0.0, -1.0]), np.array([-3.0, -9.81])
    weights, statuses = operator(
        NormalDerivative(), ghost, position, 1.0, smoothing_length=1.3, lift=normal
    )  # fmt: skip
    phi = weights.toarray()[0]
    assert statuses.tolist() == [int(Status.OK)]
    assert phi.sum() == pytest.approx(1.0, abs=1e-12)
    assert phi.min() >= 0.0
    along = phi @ ((position - ghost) @ normal)
    found = phi @ (7.0 + position @ gradient) - (gradient @ normal) * along
    assert found == pytest.approx(7.0 + ghost @ gradient, abs=1e-11)
