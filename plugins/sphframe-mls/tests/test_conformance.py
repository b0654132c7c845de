import numpy as np
import pytest
from sphframe_mls import LinearMLS, QuadraticMLS

from sphframe import Status
from sphframe.testing import Cloud, evaluate, parametrize_with_checks

NEAR_A_CONIC = ((2.69, 1.3), (1.78, 0.78), (1.14, 0.96), (0.03, 0.08), (-0.91, -0.34), (-1.76, -0.19))


@parametrize_with_checks([LinearMLS(), QuadraticMLS()])
def test_has_its_traits(method, check):
    check(method)


@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_a_cloud_near_a_conic_is_singular(angle):
    """Its weights are small, but would sum to 1 + 5e-12."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    cloud = Cloud(np.array(NEAR_A_CONIC) @ turn, volumes=np.ones(6), support=3.0)
    outcome = evaluate(QuadraticMLS(), cloud)
    assert outcome.status == Status.SINGULAR
    assert abs(outcome.weights.sum() - 1.0) < 1e-15
    assert evaluate(LinearMLS(), cloud).status == Status.OK
