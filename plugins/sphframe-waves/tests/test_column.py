"""The force of a solitary wave on a column: theory beside independent sums and limits, and a flume beside theory."""

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import h1vp, hankel1, jv, jvp
from sphframe_waves import ColumnDiffraction, SolitaryWaveColumn

from sphframe import Array, InputError, Simulation, run
from sphframe.geometry import fill


def wave(**given: Any) -> ColumnDiffraction:
    return ColumnDiffraction(
        **{"wave_height": 0.1, "wavenumber": 0.26, "speed": 3.28, "depth": 1.0, "radius": 0.75} | given
    )


def slope_force(theory: ColumnDiffraction, time: Array) -> Array:
    """Two rho pi a^2 d times minus the slope of the surface times gravity: twice the force on the water displaced."""
    phase = theory.wavenumber * theory.speed * time
    slope = 2.0 * theory.wave_height * theory.wavenumber * np.tanh(phase) / np.cosh(phase) ** 2
    displaced = theory.density * math.pi * theory.radius**2 * theory.depth
    return np.asarray(-2.0 * displaced * theory.gravity * slope)


def pressed(theory: ColumnDiffraction, q: complex) -> complex:
    """Force of a wave exp(i q x) by quadrature of the elevation around the column, from its orders on one column."""
    theta = np.linspace(0.0, 2.0 * math.pi, 65)[:-1]
    orders = np.arange(-20, 21)
    z = q * theory.radius
    alone = 1j ** orders.astype(complex) * (jv(orders, z) - jvp(orders, z) / h1vp(orders, z) * hankel1(orders, z))
    elevation = (alone[:, None] * np.exp(1j * orders[:, None] * theta)).sum(axis=0)
    scale = theory.density * theory.gravity * theory.depth * theory.radius
    return complex(-scale * (elevation * np.cos(theta)).mean() * 2.0 * math.pi)


@settings(deadline=None)
@given(radius=st.floats(0.1, 5.0), real=st.floats(0.01, 5.0), imaginary=st.floats(0.05, 1.0), depth=st.floats(0.2, 3.0))
def test_force_of_a_wave_is_the_integral_of_its_pressure(
    radius: float, real: float, imaginary: float, depth: float
) -> None:
    theory, q = wave(radius=radius, depth=depth), complex(real, imaginary)
    assert theory.force_of_wave(np.array([q]))[0] == pytest.approx(pressed(theory, q), rel=1e-8)


@settings(deadline=None, max_examples=30)
@given(
    radius=st.floats(0.3, 0.9), width=st.floats(3.6, 20.0), real=st.floats(0.05, 3.0), imaginary=st.floats(0.15, 0.5)
)
def test_no_water_crosses_the_column_in_a_channel(radius: float, width: float, real: float, imaginary: float) -> None:
    """The waves of a row of columns, summed column by column, have no slope across the surface of one of them."""
    theory, q, step = wave(radius=radius, width=width), complex(real, imaginary), 1e-4
    theta = np.linspace(0.0, 0.5 * math.pi, 9)
    slope = (odd_waves(theory, q, radius + step, theta) - odd_waves(theory, q, radius - step, theta)) / (2.0 * step)
    assert np.abs(slope).max() < 1e-3 * abs(q)
    theta = 2.0 * math.pi * np.arange(64) / 64.0
    mean = (odd_waves(theory, q, radius, theta) * np.cos(theta)).mean()
    force = -2.0 * math.pi * radius * theory.density * theory.gravity * theory.depth * mean
    assert theory.force_of_wave(np.array([q]))[0] == pytest.approx(force, rel=1e-3)


def odd_waves(theory: ColumnDiffraction, q: complex, radius: float, theta: Array) -> Array:
    """Part of the elevation odd in x, of exp(i q x) and what each column of the row sends, from orders 1 to 7."""
    reach = int(40.0 / (q.imag * theory.width)) + 2
    orders, places = np.arange(1, 8, 2), theory.width * np.arange(-reach, reach + 1)
    x, y = radius * np.cos(theta)[:, None], radius * np.sin(theta)[:, None] - places
    away, angle = np.hypot(x, y), np.arctan2(y, x)
    total = 1j * np.sin(q * x[:, 0])
    z = q * theory.radius
    for order, size in zip(orders, theory.orders(np.array([q]))[0], strict=True):
        sent = -2.0 * size * jvp(order, z) / h1vp(order, z)
        total = total + sent * (hankel1(order, q * away) * np.cos(order * angle)).sum(axis=1)
    return np.asarray(total)


def test_a_thin_column_feels_the_force_of_inertia() -> None:
    theory = wave(radius=1e-3)
    time = np.linspace(-3.0, 3.0, 41) / (theory.wavenumber * theory.speed)
    assert theory.force(time) == pytest.approx(slope_force(theory, time), abs=1e-5 * slope_force(theory, time).max())


@pytest.mark.parametrize("width", [4.0, 6.0, 10.0])
def test_side_walls_add_to_the_inertia_as_in_potential_flow(width: float) -> None:
    q = np.array([1e-3 + 1e-3j])
    ratio = wave(radius=0.5, width=width).force_of_wave(q)[0] / wave(radius=0.5).force_of_wave(q)[0]
    assert ratio == pytest.approx(1.0 / (1.0 - (math.pi * 0.5 / width) ** 2 / 3.0), rel=2e-3)


def test_side_walls_far_away_are_not_felt() -> None:
    time = np.linspace(-1.5, 1.5, 21)
    alone, wide = wave().force(time), wave(width=80.0).force(time)
    assert wide == pytest.approx(alone, abs=1e-9 * np.abs(alone).max())  # their waves come later


@settings(deadline=None)
@given(ratio=st.floats(0.02, 0.6), depth=st.floats(0.1, 5.0), size=st.floats(0.05, 2.0), phase=st.floats(-4.0, 4.0))
def test_force_in_the_open_sea_is_the_integral_over_real_wavenumbers(
    ratio: float, depth: float, size: float, phase: float
) -> None:
    k = math.sqrt(0.75 * ratio / (1.0 + ratio)) / depth
    theory = wave(wave_height=ratio * depth, wavenumber=k, depth=depth, radius=size * depth)
    time = phase / (k * theory.speed)

    def part(s: float) -> float:
        q = s * k
        sent = 0.5 * theory.wave_height * s / (k * math.sinh(0.5 * math.pi * s))
        force = 4.0 * theory.density * theory.gravity * depth / (q * h1vp(1, q * theory.radius))
        return float(2.0 * k * (sent * force * np.exp(-1j * s * phase)).real)

    scale = slope_force(theory, np.array([-0.66 / (k * theory.speed)]))[0]
    assert theory.force(np.array([time]))[0] == pytest.approx(quad(part, 1e-9, 20.0, limit=200)[0], abs=1e-6 * scale)


@settings(deadline=None)
@given(height=st.floats(0.01, 1.0), k=st.floats(0.05, 5.0), phase=st.floats(-4.0, 4.0))
def test_elevation_is_the_sum_of_the_spectrum(height: float, k: float, phase: float) -> None:
    theory = wave(wave_height=height, wavenumber=k)
    total = quad(
        lambda s: 2.0 * k * theory.spectrum(np.array([s * k]))[0].real * math.cos(s * phase), 1e-9, 30.0, limit=200
    )[0]
    assert theory.elevation(phase / k, np.array([0.0]))[0] == pytest.approx(total, abs=1e-8 * height)
    assert theory.elevation(0.0, np.array([-phase / (k * theory.speed)]))[0] == pytest.approx(total, abs=1e-8 * height)


def test_the_crest_passes_at_its_speed() -> None:
    theory = wave()
    time = np.linspace(-1.0, 1.0, 9)
    assert [theory.elevation(theory.speed * t, np.array([t]))[0] for t in time] == pytest.approx([0.1] * 9, rel=1e-14)


def test_the_impulse_of_the_force_is_zero() -> None:
    for width in (math.inf, 6.0):
        theory = wave(width=width)
        time = np.linspace(-20.0, 40.0, 6001)
        force = theory.force(time)
        assert abs(np.trapezoid(force, time)) < 1e-3 * np.trapezoid(np.abs(force), time)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"radius": 0.0}, "radius = 0.0 must be positive"),
        ({"wave_height": math.nan}, "wave_height = nan must be positive"),
        ({"width": 1.5}, "more than the diameter of the column, 1.5"),
    ],
)
def test_what_makes_no_sense_is_refused(given: dict[str, float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        wave(**given)


def samples(case: SolitaryWaveColumn, until: float, push: float = 1.0, pull: float = 1.0) -> xr.Dataset:
    """Samples of a run whose force is that of theory, times ``push`` forwards and ``pull`` backwards."""
    after = np.arange(-5.0, until, 0.01) / (case.paddle().wavenumber * case.paddle().speed)
    force = case.diffraction().force(after)
    force[0] = 0.0
    walls = np.zeros((len(after), 2, 3))
    walls[:, 1, 0] = 7.0 + 0.5 * np.where(force > 0.0, push, pull) * force
    level = case.depth + case.diffraction().elevation(-0.5 * case.column_position, after)
    return xr.Dataset(
        {
            "wall_force": (("probe_time", "wall", "space"), walls),
            "gauge_elevation": (("probe_time", "gauge"), level[:, None]),
        },
        {
            "probe_time": after + case.arrival_time(),
            "wall": ["tank", "column"],
            "space": ["x", "y", "z"],
            "gauge": ["G1"],
        },
    )


def test_a_run_that_is_the_theory_has_no_errors() -> None:
    case = SolitaryWaveColumn()
    assert set(case.errors(samples(case, 2.0))) == {"column_force", "elevation", "wave_height", "push", "pull"}
    assert case.errors(samples(case, 2.0)) == pytest.approx(
        dict.fromkeys(case.errors(samples(case, 2.0)), 0.0), abs=1e-4
    )


def test_push_and_pull_are_judged_apart_and_not_before_they_are_over() -> None:
    case = SolitaryWaveColumn(wave_height=0.025, column_radius=0.1, gravity=3.0)
    found = case.errors(samples(case, 2.0, push=1.2, pull=0.9))
    assert (found["push"], found["pull"]) == (pytest.approx(0.2, abs=1e-12), pytest.approx(0.1, abs=1e-12))
    assert case.errors(samples(case, 1.0, push=1.2)).keys() == {"column_force", "elevation", "wave_height", "push"}
    assert case.errors(samples(case, -0.5)).keys() == {"column_force", "elevation"}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"flume_width": 0.375}, "flume_width = 0.375 m leaves no water beside the column"),
        ({"column_position": 0.4}, "the column reaches from x = 0.2125 to 0.5875 m"),
        ({"flume_length": 2.1}, "to the end of the flume, 2.1 m: give a column_position between them"),
    ],
)
def test_a_column_without_water_around_it_is_refused(given: dict[str, float], message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        SolitaryWaveColumn(**given).scene()


@pytest.mark.parametrize("spacing", [0.05, 0.03])
def test_half_of_the_flume_is_drawn_from_the_paddle_to_the_end(spacing: float) -> None:
    case = SolitaryWaveColumn(particle_spacing=spacing)
    scene = case.scene()
    water, (tank, paddle, column) = scene.fluid[0].of, scene.walls
    length = water.upper[0] - water.lower[0]
    assert length / spacing == pytest.approx(round(4.0 / spacing), abs=1e-9)
    assert abs(water.lower[0]) <= 0.5 * spacing
    assert paddle.upper == (water.lower[0], 0.75, tank.upper[2])
    assert paddle.body == "paddle"
    assert column.stop == (2.0, 0.0, tank.upper[2])
    volume = fill(scene.fluid[0], spacing).volume.sum()
    assert volume == pytest.approx((0.75 * length - 0.5 * math.pi * 0.1875**2) * 0.25, rel=1e-3)


COARSE: dict[str, Any] = {
    "particle_spacing": 0.25 / 6.0,
    "flume_width": 0.75,
    "column_position": 1.6,
    "flume_length": 2.8,
}
"""a short flume, six spacings over the depth; finer runs are in the documentation"""


@pytest.mark.filterwarnings("ignore:particle_spacing .* particles over the depth")
def test_still_water_presses_half_a_column_aside() -> None:
    case = SolitaryWaveColumn(**COARSE)
    simulation = Simulation(case, threads=1)
    simulation.advance()
    across = case.reference_density * case.gravity * case.column_radius * case.depth**2
    for force in simulation.wall_forces()["column"]:
        assert force[1] == pytest.approx(-across, rel=0.03)
        assert abs(force[0]) < 0.03 * across
    assert simulation.particles_outside() == 0


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:particle_spacing .* particles over the depth")
def test_the_wave_pushes_and_pulls_the_column_as_in_theory(tmp_path: Path) -> None:
    with run(
        SolitaryWaveColumn(**COARSE | {"particle_spacing": 0.25 / 8.0}), output=tmp_path / "run.nc", threads=1
    ).dataset as dataset:
        assert int(dataset["particles_outside"].max()) == 0
        found = dataset.sph.summary()["errors"]
    assert found["wave_height"] < 0.1
    assert found["push"] < 0.15
    assert found["pull"] < 0.35
    assert found["column_force"] < 0.25
