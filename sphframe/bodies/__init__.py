"""Bodies: fixed, prescribed (paddles, measured motions), on a spring, free."""

from sphframe.bodies.displacement_series import DisplacementSeries
from sphframe.bodies.fixed import Fixed
from sphframe.bodies.free import Free
from sphframe.bodies.prescribed import Prescribed
from sphframe.bodies.regular_wave_paddle import RegularWavePaddle
from sphframe.bodies.solitary_wave_paddle import SolitaryWavePaddle
from sphframe.bodies.spring_mass import SpringMass

__all__ = ["DisplacementSeries", "Fixed", "Free", "Prescribed", "RegularWavePaddle", "SolitaryWavePaddle", "SpringMass"]
