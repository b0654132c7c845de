"""Equations of state: Tait's equation."""

import math
from dataclasses import dataclass

from sphframe.errors import InputError
from sphframe.interfaces import EquationOfState
from sphframe.interfaces.equation_of_state import StateFunction


@dataclass(frozen=True)
class Tait(EquationOfState):
    """p = B [(rho/rho0)^gamma - 1] with B = rho0 c0^2 / gamma.

    Its inverse is rho = rho0 (1 + p/B)^(1/gamma), which exists for p > -B (about -57 rho0 g H at c0 = 20 sqrt(gH));
    its sound speed is c = c0 (rho/rho0)^((gamma - 1)/2).

    Source: Batchelor (1974), An Introduction to Fluid Dynamics; Monaghan (1994), doi:10.1006/jcph.1994.1034.

    Parameters
    ----------
    gamma
        exponent, at least 1; 7 for water.

    Raises
    ------
    InputError
        when gamma is below 1.

    Examples
    --------
    >>> tait = Tait(gamma=7.0)
    >>> pressure = tait.pressure_function()(1001.0, 1000.0, 40.0)
    >>> round(pressure, 3)
    1604.808
    >>> round(tait.density_function()(pressure, 1000.0, 40.0), 9)
    1001.0
    """

    gamma: float = 7.0

    def __post_init__(self) -> None:
        if not self.gamma >= 1.0:
            raise InputError(f"gamma = {self.gamma}: the exponent of Tait's equation must be at least 1 (water: 7)")

    def pressure_function(self) -> StateFunction:
        """Return p(rho), in Pa."""
        gamma = float(self.gamma)

        def pressure(density: float, reference_density: float, sound_speed: float) -> float:
            stiffness = reference_density * sound_speed * sound_speed / gamma
            return stiffness * (math.pow(density / reference_density, gamma) - 1.0)

        return pressure

    def density_function(self) -> StateFunction:
        """Return the inverse rho(p), in kg/m^3."""
        gamma = float(self.gamma)

        def density(pressure: float, reference_density: float, sound_speed: float) -> float:
            stiffness = reference_density * sound_speed * sound_speed / gamma
            return reference_density * math.pow(1.0 + pressure / stiffness, 1.0 / gamma)

        return density

    def sound_speed_function(self) -> StateFunction:
        """Return c(rho), in m/s."""
        gamma = float(self.gamma)

        def sound_speed_at(density: float, reference_density: float, sound_speed: float) -> float:
            return sound_speed * math.pow(density / reference_density, 0.5 * (gamma - 1.0))

        return sound_speed_at
