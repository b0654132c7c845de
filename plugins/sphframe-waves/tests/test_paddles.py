"""The paddles make the motion of their theories, and keep the promises of a rigid body."""

import math

import numpy as np
import pytest
from sphframe_waves import RegularWavePaddle, SolitaryWavePaddle

from sphframe import InputError, RigidBody, create
from sphframe.testing import parametrize_with_checks

NOTHING = np.zeros(3)


def at(body: RigidBody, time: float) -> tuple[float, float, float]:
    motion = body.motion(time, NOTHING, NOTHING, NOTHING)
    return float(motion.position[0]), float(motion.velocity[0]), float(motion.acceleration[0])


@parametrize_with_checks(
    [
        RegularWavePaddle(wave_height=0.05, period=1.5, depth=0.3),
        RegularWavePaddle(wave_height=0.05, period=1.2, depth=0.3),
        SolitaryWavePaddle(wave_height=0.15, depth=0.25),
        SolitaryWavePaddle(wave_height=0.15, depth=0.25, theory="boussinesq"),
        SolitaryWavePaddle(wave_height=0.05, depth=0.2, theory="boussinesq"),
    ]
)
def test_passes(body, check):
    check(body)


@pytest.mark.parametrize("theory", ["rayleigh", "boussinesq"])
@pytest.mark.parametrize("ratio", [0.05, 0.3, 0.6])
def test_solitary_paddle_moves_as_the_water_under_its_wave(theory: str, ratio: float) -> None:
    d, g = 0.25, 9.81
    height = ratio * d
    paddle = create("rigid_bodies", "solitary-wave-paddle", wave_height=height, depth=d, theory=theory)
    k = math.sqrt(0.75 * height / d**2 / (d + height if theory == "rayleigh" else d))
    c = math.sqrt(g * (d + height))
    assert paddle.stroke == pytest.approx(2.0 * height / (k * d), rel=1e-14)
    for time in np.linspace(0.0, 2.0 * paddle.mid_stroke_time, 23):
        x, u, _ = at(paddle, time)
        from_middle = x - 0.5 * paddle.stroke * math.tanh(3.8)
        theta = k * (c * (time - paddle.mid_stroke_time) - from_middle)
        assert from_middle == pytest.approx(height / (k * d) * math.tanh(theta), abs=1e-12)
        eta = height / math.cosh(theta) ** 2
        assert u == pytest.approx(c * eta / (d + eta), rel=1e-10)


def test_solitary_paddle_starts_at_rest_and_makes_its_whole_stroke() -> None:
    paddle = SolitaryWavePaddle(wave_height=0.15, depth=0.25)
    x, u, a = at(paddle, 0.0)
    assert x == pytest.approx(0.0, abs=1e-15)
    assert u < 0.002 * paddle.speed
    assert a < 0.2 * 9.81 / 10.0
    assert at(paddle, 100.0) == pytest.approx((paddle.stroke, 0.0, 0.0), rel=1e-3)
    assert at(paddle, paddle.mid_stroke_time)[0] == pytest.approx(0.5 * paddle.stroke, rel=2e-3)
    assert at(paddle, -1.0) == (0.0, 0.0, 0.0)


def test_regular_paddle_satisfies_dispersion_and_biesel() -> None:
    h, period, d, g = 0.05, 1.2, 0.3, 9.81
    paddle = RegularWavePaddle(wave_height=h, period=period, depth=d)
    kd = paddle.wavenumber * d
    assert g * paddle.wavenumber * math.tanh(kd) == pytest.approx((2 * math.pi / period) ** 2, rel=1e-12)
    assert h / paddle.stroke == pytest.approx(2 * (math.cosh(2 * kd) - 1) / (math.sinh(2 * kd) + 2 * kd), rel=1e-12)
    quarter = 0.25 * period + 5.0 * period
    assert at(paddle, quarter)[0] == pytest.approx(0.5 * paddle.stroke, rel=1e-12)
    assert at(paddle, 0.0) == (0.0, 0.0, 0.0)


def test_regular_paddle_in_deep_water_has_half_the_wave_height_as_stroke() -> None:
    paddle = RegularWavePaddle(wave_height=0.1, period=0.5, depth=20.0)
    assert paddle.stroke == pytest.approx(0.05, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        ("solitary-wave-paddle", {"wave_height": -1.0, "depth": 0.25}, "wave_height = -1.0 must be positive"),
        ("solitary-wave-paddle", {"wave_height": 0.1, "depth": 0.25, "theory": "stokes"}, "'rayleigh' or 'boussinesq'"),
        ("regular-wave-paddle", {"wave_height": 0.1, "depth": 0.25, "period": 0.0}, "period = 0.0 must be positive"),
    ],
)
def test_bad_options_are_refused(name: str, options: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        create("rigid_bodies", name, **options)
