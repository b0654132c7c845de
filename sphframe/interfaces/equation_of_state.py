"""Interfaces: the equation of state of a weakly compressible fluid."""

from abc import ABC, abstractmethod
from collections.abc import Callable

StateFunction = Callable[[float, float, float], float]


class EquationOfState(ABC):
    """A barotropic relation p(rho).

    Each method returns a scalar function that sphframe compiles; all three functions take
    ``(variable, reference_density, sound_speed)`` in SI units, with ``sound_speed`` the reference c0 at rho0.
    """

    @abstractmethod
    def pressure_function(self) -> StateFunction:
        """Return p(density, reference_density, sound_speed), in Pa."""

    @abstractmethod
    def density_function(self) -> StateFunction:
        """Return the inverse, rho(pressure, reference_density, sound_speed), in kg/m^3."""

    @abstractmethod
    def sound_speed_function(self) -> StateFunction:
        """Return c(density, reference_density, sound_speed) = sqrt(dp/drho), in m/s."""
