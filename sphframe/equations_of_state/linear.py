"""Equations of state: the linear equation of state."""

from dataclasses import dataclass

from sphframe.interfaces import EquationOfState
from sphframe.interfaces.equation_of_state import StateFunction


def _pressure(density: float, reference_density: float, sound_speed: float) -> float:
    return sound_speed * sound_speed * (density - reference_density)


def _density(pressure: float, reference_density: float, sound_speed: float) -> float:
    return reference_density + pressure / (sound_speed * sound_speed)


def _sound_speed(density: float, reference_density: float, sound_speed: float) -> float:
    return sound_speed


@dataclass(frozen=True)
class Linear(EquationOfState):
    """p = c0^2 (rho - rho0) + p_b, with p_b = 0 the equation of state of every case of Huang et al. (2019).

    Its inverse is rho = rho0 + (p - p_b)/c0^2, its sound speed c0 at every density.

    Source: Molteni & Colagrossi (2009), doi:10.1016/j.cpc.2008.12.004.

    Attributes
    ----------
    background_pressure
        p_b, Pa: the pressure at the reference density.

    Examples
    --------
    >>> Linear().pressure_function()(1001.0, 1000.0, 40.0)
    1600.0
    """

    background_pressure: float = 0.0
    """p_b, Pa: the pressure at the reference density; fluid in a closed vessel under pressure does not form voids"""

    def pressure_function(self) -> StateFunction:
        """Return p(rho), in Pa."""
        background = float(self.background_pressure)
        if background == 0.0:
            return _pressure

        def pressure(density: float, reference_density: float, sound_speed: float) -> float:
            return sound_speed * sound_speed * (density - reference_density) + background

        return pressure

    def density_function(self) -> StateFunction:
        """Return rho(p), in kg/m^3."""
        background = float(self.background_pressure)
        if background == 0.0:
            return _density

        def density(pressure: float, reference_density: float, sound_speed: float) -> float:
            return reference_density + (pressure - background) / (sound_speed * sound_speed)

        return density

    def sound_speed_function(self) -> StateFunction:
        """Return c = c0, in m/s."""
        return _sound_speed
