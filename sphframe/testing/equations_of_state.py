"""Testing: equations of state, one check function per property."""

import math
from collections.abc import Callable

import numpy as np

from sphframe.compiled import compile_part
from sphframe.interfaces import EquationOfState
from sphframe.kernels import compiled_kernel
from sphframe.registry import create
from sphframe.simulation.components import loop_parts
from sphframe.testing.evaluation import title
from sphframe.testing.proof import require

_RATIOS = np.array([0.7, 0.9, 0.99, 0.999, 1.0, 1.0001, 1.001, 1.01, 1.03, 1.2, 1.5])
"""densities over rho0"""
_FLUIDS = ((1000.0, 10.0), (1000.0, 1500.0), (870.0, 40.0), (1.2, 340.0))
"""rho0 (kg/m^3) and c0 (m/s) of water, oil and air"""


def check_inverse(state: EquationOfState) -> None:
    """rho(p(rho)) = rho, also where the pressure at the reference density is a background pressure."""
    pressure, density = state.pressure_function(), state.density_function()
    for rho0, c0 in _FLUIDS:
        for rho in (rho0 * _RATIOS).tolist():
            back = density(pressure(rho, rho0, c0), rho0, c0)
            require(
                abs(back - rho) < 1e-9 * rho,
                f"{title(state)}: rho(p({rho:g})) is {back:.12g} kg/m^3 with rho0 = {rho0:g} kg/m^3, c0 = {c0:g} m/s;"
                f" density_function must invert pressure_function",
            )


def check_pressure_rises(state: EquationOfState) -> None:
    """The pressure increases with the density."""
    pressure = state.pressure_function()
    for rho0, c0 in _FLUIDS:
        values = [pressure(rho, rho0, c0) for rho in (rho0 * _RATIOS).tolist()]
        require(bool(np.all(np.diff(values) > 0.0)), f"{title(state)}: p does not increase with rho: {values} Pa")


def check_sound_speed(state: EquationOfState) -> None:
    """c^2 = dp/drho, and c = c0 at the reference density."""
    pressure, speed = state.pressure_function(), state.sound_speed_function()
    for rho0, c0 in _FLUIDS:
        require(
            math.isclose(speed(rho0, rho0, c0), c0, rel_tol=1e-9),
            f"{title(state)}: c(rho0) is {speed(rho0, rho0, c0):.9g} m/s with rho0 = {rho0:g} kg/m^3, c0 = {c0:g} m/s",
        )
        for rho in (rho0 * _RATIOS).tolist():
            step = 1e-6 * rho0
            slope = (pressure(rho + step, rho0, c0) - pressure(rho - step, rho0, c0)) / (2.0 * step)
            given = speed(rho, rho0, c0) ** 2
            require(
                math.isclose(slope, given, rel_tol=1e-5),
                f"{title(state)}: c^2 = {given:.9g} at rho = {rho:g}, but dp/drho = {slope:.9g} m^2/s^2",
            )


def check_compiles(state: EquationOfState) -> None:
    """The compiled functions and plain Python return the same values."""
    loop_parts(compiled_kernel(create("kernels", "gaussian"), 2), state, 2)
    pressure = state.pressure_function()
    for function, argument in (
        (pressure, 1003.0),
        (state.sound_speed_function(), 1003.0),
        (state.density_function(), pressure(1003.0, 1000.0, 40.0)),
    ):
        compiled = compile_part(function)(argument, 1000.0, 40.0)
        plain = function(argument, 1000.0, 40.0)
        require(
            math.isclose(compiled, plain, rel_tol=1e-9),
            f"{title(state)}: compiled {compiled} and plain Python {plain} differ at {argument:g}",
        )


CHECKS: dict[str, Callable[[EquationOfState], None]] = {
    "compiles": check_compiles,
    "inverse": check_inverse,
    "pressure_rises": check_pressure_rises,
    "sound_speed": check_sound_speed,
}
"""the checks of an equation of state, by the name of the property"""
