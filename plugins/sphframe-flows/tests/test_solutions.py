"""The exact solutions satisfy their equations, without any run."""

import math

import numpy as np
import pytest
import xarray as xr
from sphframe_flows import (
    JetOnPlate,
    Oscillating,
    RotatingBucket,
    RotatingFrame,
    SloshingTank,
    Spinning,
    StokesPlate,
    Surge,
    TaylorCouette,
)
from sphframe_flows.solutions import fitted_oscillation, mean_velocity, viscous_wave

from sphframe.testing import parametrize_with_checks


@pytest.mark.parametrize(
    ("depth", "reynolds", "frequency", "damping"),
    [(math.pi, 500.0, 1.76623, 0.03652), (math.pi / 2.0, 250.0, None, None)],
)
def test_viscous_waves(depth: float, reynolds: float, frequency: float | None, damping: float | None) -> None:
    """A published root, and the limit of small viscosity: damping 2 nu k^2 above a bed with free slip."""
    k = depth
    rate = viscous_wave(k, 1.0, 1.0, 1.0 / reynolds)
    if frequency is not None:
        assert rate.imag == pytest.approx(frequency, abs=2e-5)
        assert -rate.real == pytest.approx(damping, abs=2e-5)
    small = viscous_wave(k, 1.0, 1.0, 1e-7)
    assert small.imag == pytest.approx(math.sqrt(k * math.tanh(k)), rel=1e-5)
    assert -small.real == pytest.approx(2e-7 * k * k, rel=0.01)


def test_fit_of_an_oscillation() -> None:
    t = np.linspace(0.0, 5.0, 300)
    values = 0.3 * np.exp(-0.2 * t) * np.cos(4.0 * t + 0.3)
    assert fitted_oscillation(t, values, 3.8, 0.1) == pytest.approx((4.0, 0.2), rel=1e-6)


def test_sloshing_starts_at_rest_and_tends_to_the_slope_of_slow_forcing() -> None:
    """The modes satisfy a'' + w^2 a = -c X'' with c from the static limit eta = X''/g (L/2 - x)."""
    case = SloshingTank()
    t = np.linspace(0.0, 2.0, 4001)
    k, modes = case.modes(t)
    assert not modes[:, 0].any()
    step = t[1]
    first = modes[0]
    curvature = (first[2:] - 2.0 * first[1:-1] + first[:-2]) / step**2
    w2 = 9.81 * k[0] * math.tanh(k[0] * 0.5)
    forcing = 4.0 * math.tanh(k[0] * 0.5) / k[0] * 0.01 * 9.0 * np.cos(3.0 * t[1:-1])
    np.testing.assert_allclose(curvature + w2 * first[1:-1], forcing, atol=1e-4 * np.abs(forcing).max())
    _, resonant = SloshingTank(angular_frequency=math.sqrt(w2)).modes(t)
    _, close = SloshingTank(angular_frequency=math.sqrt(w2) * (1.0 + 1e-6)).modes(t)
    np.testing.assert_allclose(resonant[0], close[0], atol=1e-4 * np.abs(close[0]).max())


def test_bucket_keeps_its_volume_and_balances_gravity() -> None:
    case = RotatingBucket()
    x = np.linspace(-0.5, 0.5, 100_001)
    surface = case.surface(x)
    assert np.trapezoid(surface, x) == pytest.approx(case.depth, rel=1e-9)
    np.testing.assert_allclose(np.gradient(surface, x)[1:-1], 9.0 * x[1:-1] / 9.81, atol=1e-6)


def test_the_pressure_of_a_jet_is_its_momentum() -> None:
    """The integral over the plate is rho U^2 b; in the middle there is the stagnation pressure."""
    case = JetOnPlate()
    x = np.linspace(0.0, 1.5, 300_001)
    assert case.pressure(np.zeros(1))[0] == pytest.approx(500.0)
    assert 2.0 * np.trapezoid(case.pressure(x), x) == pytest.approx(1000.0 * case.width, rel=1e-3)


def test_velocities_at_points_are_exact_for_linear_fields() -> None:
    position = np.random.default_rng(3).uniform(0.0, 1.0, (600, 2))
    velocity = np.array([0.3, -0.2]) + position @ [[1.0, 2.0], [-0.5, 0.7]]
    dims = ("time", "particle", "space")
    dataset = xr.Dataset(
        {"position": (dims, position[None]), "velocity": (dims, velocity[None])}, attrs={"particle_spacing": 0.05}
    )
    points = np.array([[0.5, 0.5], [0.02, 0.4]])
    expected = np.array([0.3, -0.2]) + points @ [[1.0, 2.0], [-0.5, 0.7]]
    np.testing.assert_allclose(mean_velocity(dataset, points, 1), expected, rtol=1e-9)


def test_plates_drive_the_fluid_as_the_equation_has_it() -> None:
    """u_t = nu u_yy - X'', zero at the plates, by differences."""
    case = StokesPlate()
    y, t, step = np.linspace(0.0, 1.0, 2001), 0.7, 1e-5
    now = case.velocity(y, t)
    rate = (case.velocity(y, t + step) - case.velocity(y, t - step)) / (2.0 * step)
    diffusion = 0.05 * (now[2:] - 2.0 * now[1:-1] + now[:-2]) / (y[1] - y[0]) ** 2
    np.testing.assert_allclose(rate[1:-1], diffusion - 0.1 * 25.0 * math.cos(5.0 * t), atol=1e-4)
    assert np.abs(now[[0, -1]]).max() < 1e-12


def test_taylor_couette_has_the_speeds_of_its_walls() -> None:
    case = TaylorCouette(outer_speed=0.5)
    np.testing.assert_allclose(case.velocity(np.array([0.5, 1.0])), [1.0, 0.5])


@parametrize_with_checks([RotatingFrame(angular_speed=2.0), Surge(amplitude=0.1, angular_frequency=3.0)])
def test_forces_have_what_is_expected_of_them(component, check) -> None:  # type: ignore[no-untyped-def]
    check(component)


@parametrize_with_checks(
    [
        Spinning(angular_speed=2.0),
        Spinning(angular_speed=-1.0, ramp_time=2.0),
        Oscillating(0.1, 5.0),
        Oscillating(0.1, 1.0),
    ]
)
def test_bodies_have_what_is_expected_of_them(component, check) -> None:  # type: ignore[no-untyped-def]
    check(component)
