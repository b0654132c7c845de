"""The built-in rigid bodies pass all checks."""

from sphframe.bodies.fixed import Fixed
from sphframe.bodies.free import Free
from sphframe.bodies.spring_mass import SpringMass
from sphframe.testing import parametrize_with_checks


@parametrize_with_checks(
    [Fixed(), Free(mass=20.0, inertia=0.3, centre=(0.5, 0.2)), SpringMass(mass=250.0, stiffness=10.0, threshold=200.0)]
)
def test_passes(body, check):
    check(body)
