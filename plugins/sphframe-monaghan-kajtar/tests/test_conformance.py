from types import SimpleNamespace

import numpy as np
import pytest
from sphframe_monaghan_kajtar import MonaghanKajtar

from sphframe import Separation
from sphframe.testing import parametrize_with_checks

CONSTANTS = SimpleNamespace(gravity=1.0, depth=1.0, sound_speed=20.0, spacing=1.0, smoothing_length=1.3)


@parametrize_with_checks([MonaghanKajtar()])
def test_has_its_traits(treatment, check):
    check(treatment)


def along_the_wall(treatment, distance, constants=CONSTANTS):
    """Acceleration (n, 2) of fluid particles at n places along a straight wall, ``distance`` above it."""
    force = treatment.parts(SimpleNamespace(dim=2)).force
    places = np.linspace(0.0, 1.0, 48, endpoint=False)
    row = np.arange(-5 * treatment.beta, 6 * treatment.beta) / treatment.beta
    found = [
        [force(None, Separation(g - x, -distance, 0.0, (g - x) ** 2 + distance**2), constants) for g in row]
        for x in places
    ]
    return np.array(found).sum(axis=1)[:, :2]


@pytest.mark.parametrize("beta", [1, 2, 3])
def test_the_mean_force_of_a_straight_wall_does_not_depend_on_the_number_of_its_particles(beta):
    assert along_the_wall(MonaghanKajtar(beta=beta), 1.0)[:, 1].mean() == pytest.approx(0.834, abs=5e-4)


@pytest.mark.parametrize(("beta", "ripple"), [(1, 0.18), (2, 0.008), (3, 0.0003)])
def test_the_force_hardly_changes_along_a_straight_wall(beta, ripple):
    across = along_the_wall(MonaghanKajtar(beta=beta), 0.5)[:, 1]
    assert 0.5 * np.ptp(across) / across.mean() == pytest.approx(ripple, rel=0.15)


def test_there_is_no_force_beyond_two_smoothing_lengths_and_never_attraction():
    treatment = MonaghanKajtar()
    assert np.all(along_the_wall(treatment, 2.6) == 0.0)
    for distance in (2.5, 0.3, 1e-9):
        assert np.all(along_the_wall(treatment, distance)[:, 1] > 0.0)


def test_the_kernel_of_the_paper():
    force = MonaghanKajtar(beta=1).parts(SimpleNamespace(dim=2)).force
    q = 0.7 / 1.3
    psi = 1.77 / 32 * (1 + 2.5 * q + 2 * q**2) * (2 - q) ** 5
    assert force(None, Separation(0.0, -0.7, 0.0, 0.49), CONSTANTS)[1] == pytest.approx(psi / 0.7, rel=1e-14)


def test_the_shifted_force_is_stronger_by_1_4_at_one_spacing():
    plain, shifted = (along_the_wall(MonaghanKajtar(shifted=s), 1.0)[:, 1].mean() for s in (False, True))
    assert shifted / plain == pytest.approx(1.4, abs=0.05)


def test_options_are_checked():
    with pytest.raises(ValueError, match="beta must be at least 1"):
        MonaghanKajtar(beta=0)
