from types import SimpleNamespace

import pytest
from sphframe_lennard_jones import LennardJones

from sphframe import Separation
from sphframe.testing import parametrize_with_checks

CONSTANTS = SimpleNamespace(gravity=9.81, depth=2.0, sound_speed=80.0, spacing=0.1)


@parametrize_with_checks([LennardJones()])
def test_has_its_traits(treatment, check):
    check(treatment)


def force(treatment, x, y, constants=CONSTANTS):
    """Acceleration of a fluid particle that sees a wall particle at x, y."""
    found = treatment.parts(None).force
    return found(None, Separation(x, y, 0.0, x * x + y * y), constants)


@pytest.mark.parametrize(("steep", "powers"), [(False, (4, 2)), (True, (12, 6))])
def test_the_force_of_a_pair(steep, powers):
    treatment = LennardJones(steep=steep)
    expected = 5.0 * 9.81 * 2.0 * (2.0 ** powers[0] - 2.0 ** powers[1]) / 0.05
    assert force(treatment, 0.0, -0.05) == pytest.approx((0.0, expected, 0.0), rel=1e-14)  # the wall is below
    assert force(treatment, 0.03, 0.04) == pytest.approx((-0.6 * expected, -0.8 * expected, 0.0), rel=1e-14)


def test_there_is_no_force_from_the_particle_spacing_on_and_never_attraction():
    treatment = LennardJones()
    assert force(treatment, 0.0, -0.1) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert force(treatment, 0.0, -0.1001) == (0.0, 0.0, 0.0)
    assert force(treatment, 0.0, -0.0999)[1] > 0.0
    assert force(treatment, 0.0, 0.0) == (0.0, 0.0, 0.0)


def test_the_strength():
    assert force(LennardJones(strength=1.0), 0.0, -0.05)[1] == pytest.approx(12.0 / 0.05, rel=1e-14)
    weightless = SimpleNamespace(**{**vars(CONSTANTS), "gravity": 0.0})
    assert force(LennardJones(), 0.0, -0.05, weightless)[1] == pytest.approx(5.0 * 16.0 * 12.0 / 0.05, rel=1e-14)
    with pytest.raises(ValueError, match="strength must be a positive number"):
        LennardJones(strength=-1.0)
