"""The improved weights beside their formula, computed from logarithms and with no regard to speed."""

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st
from sphframe_shepard import ImprovedShepard

from sphframe import ParticleCloud


def expected(method, s):
    """Return the weights of particles at the distances ``s`` (n,) over the cut-off, after Eqs. 19-21."""
    s = s.astype(np.longdouble)
    logarithm = -method.mu * (np.log(s) + s**2 / (1.0 - s**method.attenuation))
    weights = np.exp(logarithm - logarithm.max())
    return weights / weights.sum()


@settings(max_examples=300, deadline=None)
@given(
    seed=st.integers(0, 2**31),
    count=st.integers(1, 40),
    mu=st.sampled_from([1.0, 2.0, 3.5, 4.0, 6.0]),
    attenuation=st.sampled_from([1.0, 2.0, 3.5]),
    nearest=st.sampled_from([1e-200, 1e-80, 1e-40, 1e-9, 0.1, 0.5, 0.6, 0.9, 0.99]),
    h=st.sampled_from([1e-6, 1.0, 1e4]),
)
@example(seed=1, count=30, mu=4.0, attenuation=2.0, nearest=0.57, h=1.0)  # about where the sum of all weights is 1
def test_weights_are_those_of_the_formula(seed, count, mu, attenuation, nearest, h):
    random = np.random.default_rng(seed)
    s = nearest + (1.0 - nearest) * random.uniform(0.0, 0.999, count) ** 2
    s[0] = nearest
    positions = np.zeros((count, 2))
    positions[:, 0] = s * 3.0 * h
    cloud = ParticleCloud(positions, np.full(count, h**2), smoothing_length=h)
    method = ImprovedShepard(mu=mu, attenuation=attenuation)
    found = method.operator(np.zeros((1, 2)), cloud).toarray()[0]
    np.testing.assert_allclose(found, expected(method, positions[:, 0] / (3.0 * h)), rtol=1e-9, atol=3e-14)
