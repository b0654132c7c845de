"""The built-in rigid bodies pass all checks."""

from sphframe.bodies.fixed import Fixed
from sphframe.bodies.free import Free
from sphframe.bodies.regular_wave_paddle import RegularWavePaddle
from sphframe.bodies.solitary_wave_paddle import SolitaryWavePaddle
from sphframe.bodies.spring_mass import SpringMass
from sphframe.testing import parametrize_with_checks


@parametrize_with_checks(
    [
        Fixed(),
        Free(mass=20.0, inertia=0.3, centre=(0.5, 0.2)),
        RegularWavePaddle(wave_height=0.05, period=1.5, depth=0.3),
        SolitaryWavePaddle(wave_height=0.15, depth=0.25),
        SolitaryWavePaddle(wave_height=0.15, depth=0.25, theory="boussinesq"),
        SpringMass(mass=250.0, stiffness=10.0, threshold=200.0),
    ]
)
def test_passes(body, check):
    check(body)
