"""Bodies: fixed, prescribed (a function, a measured motion), on a spring, free."""

from sphframe.bodies.displacement_series import DisplacementSeries
from sphframe.bodies.fixed import Fixed
from sphframe.bodies.free import Free
from sphframe.bodies.prescribed import Prescribed
from sphframe.bodies.spring_mass import SpringMass

__all__ = ["DisplacementSeries", "Fixed", "Free", "Prescribed", "SpringMass"]
