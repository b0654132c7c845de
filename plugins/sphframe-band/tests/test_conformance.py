from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sphframe_band import Band, LinearAtGhost

from sphframe import OK, SINGULAR, Interpolated, WallPoint
from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([Band()])
def test_has_its_traits(treatment, check):
    check(treatment)


@settings(deadline=None)  # loops are compiled
@given(seed=st.integers(0, 2**32 - 1))
def test_linear_pressures_are_continued_beyond_the_fluid_as_a_least_squares_fit(seed):
    """The weights are those of numpy's weighted fit, and exact for linear pressures; the fallback is lifted."""
    random = np.random.default_rng(seed)
    offsets = random.uniform([-1.0, 0.2], [1.0, 1.5], (12, 2))  # all on one side of the wall particle
    distances, volumes = np.linalg.norm(offsets, axis=1), random.uniform(0.5, 2.0, 12)
    values, weights, force = np.exp(-(distances**2)), np.empty(12), 1e4 * random.normal(size=2)
    status = LinearAtGhost(amplification=1e9).point_weights(SimpleNamespace(support=3.0), 2)(
        offsets, distances, values, volumes, 2.0, np.zeros(2), weights
    )
    assert status == OK
    linear = np.column_stack([np.ones(12), offsets])
    fit = np.linalg.pinv(np.sqrt(values * volumes)[:, None] * linear)[0] * np.sqrt(values * volumes)
    assert weights == pytest.approx(fit, abs=1e-9 * np.abs(fit).max())
    pressures, velocity = 700.0 + offsets @ random.normal(size=2) * 1e4, np.empty(2)
    assign = Band().parts(SimpleNamespace(dim=2, no_slip=True)).assign
    wall = WallPoint(
        np.array([0.0, -1.0]), 0.1, 0.0, np.zeros(2), np.eye(2), np.array([0.1, 0.2]), force, 0.0, np.zeros(2), 0
    )
    fluid = Interpolated(OK, 12, weights.sum(), weights @ pressures, False, weights @ offsets, np.zeros(2))
    assert assign(fluid, wall, None, velocity, velocity)[0] == pytest.approx(700.0, abs=1e-6)
    assert velocity.tolist() == [0.1, 0.2]
    average = values * volumes / (values @ volumes)
    fluid = Interpolated(SINGULAR, 12, 1.0, average @ (700.0 + offsets @ force), False, average @ offsets, np.zeros(2))
    assert assign(fluid, wall, None, velocity, velocity)[0] == pytest.approx(700.0, abs=1e-9)
