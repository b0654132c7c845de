"""Every equation of state: inverse, reference state and sound speed."""

import numba
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sphframe.equations_of_state.linear import Linear
from sphframe.equations_of_state.tait import Tait
from sphframe.errors import InputError
from sphframe.interfaces import EquationOfState

EQUATIONS = [Linear(), Tait(), Tait(gamma=1.4), Tait(gamma=1.0)]
every_equation = pytest.mark.parametrize("equation", EQUATIONS, ids=repr)
compressions = st.floats(0.9, 1.1)
reference_densities = st.floats(1.0, 2000.0)
sound_speeds = st.floats(1.0, 1500.0)


@every_equation
@given(compression=compressions, rho0=reference_densities, c0=sound_speeds)
def test_density_inverts_pressure(equation: EquationOfState, compression: float, rho0: float, c0: float) -> None:
    pressure = equation.pressure_function()(compression * rho0, rho0, c0)
    assert equation.density_function()(pressure, rho0, c0) == pytest.approx(compression * rho0, rel=1e-12)


@every_equation
@given(compression=compressions, rho0=reference_densities, c0=sound_speeds)
def test_sound_speed_is_the_slope(equation: EquationOfState, compression: float, rho0: float, c0: float) -> None:
    rho, step = compression * rho0, 1e-5 * rho0
    pressure = equation.pressure_function()
    slope = (pressure(rho + step, rho0, c0) - pressure(rho - step, rho0, c0)) / (2.0 * step)
    assert equation.sound_speed_function()(rho, rho0, c0) ** 2 == pytest.approx(slope, rel=1e-6)


@every_equation
def test_reference_state(equation: EquationOfState) -> None:
    assert equation.pressure_function()(1000.0, 1000.0, 40.0) == 0.0
    assert equation.density_function()(0.0, 1000.0, 40.0) == 1000.0
    assert equation.sound_speed_function()(1000.0, 1000.0, 40.0) == 40.0


@every_equation
def test_functions_compile(equation: EquationOfState) -> None:
    for function in (equation.pressure_function(), equation.density_function(), equation.sound_speed_function()):
        assert numba.njit(function)(1010.0, 1000.0, 40.0) == pytest.approx(function(1010.0, 1000.0, 40.0), rel=1e-13)


def test_tait_with_unit_exponent_is_linear() -> None:
    assert Tait(gamma=1.0).pressure_function()(1010.0, 1000.0, 40.0) == pytest.approx(
        Linear().pressure_function()(1010.0, 1000.0, 40.0), rel=1e-12
    )


@pytest.mark.parametrize("gamma", [0.0, -7.0, 0.99, float("nan")])
def test_tait_refuses_an_exponent_below_one(gamma: float) -> None:
    with pytest.raises(InputError, match=r"gamma = .*at least 1"):
        Tait(gamma=gamma)
