"""A standing wave between two walls."""

import math
from collections.abc import Mapping
from typing import ClassVar, Literal

import numpy as np
import xarray as xr

from sphframe import Array, Case
from sphframe.cases import (
    Benchmark,
    Derived,
    Diagnostic,
    ExactCase,
    Fields,
    Scene,
    downward_gravity,
    quantity,
    with_default,
)
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe_flows.solutions import fitted_oscillation, sample_times, variable, viscous_wave


class StandingWave(ExactCase):
    """A standing wave between two vertical walls with free slip, which starts from a level surface.

    With k = mode pi / tank_length, the height y above the bed and omega^2 = g k tanh kd the velocity at the start is::

        (u, v) = a omega / sinh(kd) (-cosh(ky) sin(kx), sinh(ky) cos(kx))

    The diagnostic ``mode_velocity`` is the least-squares amplitude of this field in the velocities, a omega at the
    start. Exactly it is that of a damped oscillator with frequency and damping of the linearised Navier-Stokes
    equations (``sphframe_flows.solutions.viscous_wave``), where the viscosity is nu + alpha c0 h / 8, with the
    artificial one. The viscosity is that of Monaghan and Gingold; the form of Morris does not satisfy the condition of
    no stress at a free surface, and damps by 45 % too little. With ``tension = "bounded"`` fixed
    ghosts above the water line act on the water, and at a Reynolds number of 500 damp by 7 % too much with 40 spacings.
    A finite amplitude lowers the frequency of a deep wave by (ka)^2 / 8. ``errors``: ``frequency`` and, with viscosity,
    ``damping`` of a fit, relative to the exact ones.
    """

    title: ClassVar[str] = "standing wave between walls"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "standing-wave": Benchmark(
            "frequency",
            "A free surface between vertical walls over many periods.",
            (0.05, 0.025),
            {"tension": "bounded"},
        )
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    gravity: float = downward_gravity()
    depth: float = quantity(1.0, "m", "depth d of the water", gt=0)
    tank_length: float = quantity(1.0, "m", "distance of the walls", gt=0)
    mode: int = quantity(1, "1", "half waves between the walls", ge=1)
    amplitude: float = quantity(
        Derived("depth / 40", lambda case: case.depth / 40.0), "m", "amplitude a of the elevation", gt=0
    )
    viscosity_model: Literal["morris", "monaghan-gingold"] = with_default(Case, "viscosity_model", "monaghan-gingold")
    artificial_viscosity: float = with_default(Case, "artificial_viscosity", 0.0)
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "none")
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("depth / 40", lambda case: case.depth / 40.0)
    )
    until: float = with_default(Case, "until", Derived("5 periods", lambda case: 5.0 * case.period))
    frame_interval: float = with_default(Case, "frame_interval", Derived("period / 4", lambda case: case.period / 4.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("period / 50", lambda case: case.period / 50.0)
    )

    @property
    def wavenumber(self) -> float:
        """Wavenumber k, 1/m."""
        return self.mode * math.pi / self.tank_length

    @property
    def rate(self) -> complex:
        """Growth rate of the wave, -damping + i frequency, 1/s."""
        h = self.smoothing_length_ratio * self.particle_spacing
        sound_speed = self.reference_sound_speed(self.depth)
        viscosity = self.kinematic_viscosity + self.artificial_viscosity * sound_speed * h / 8.0
        return viscous_wave(self.wavenumber, self.depth, self.gravity, viscosity)

    @property
    def frequency(self) -> float:
        """Angular frequency omega of an inviscid fluid, rad/s."""
        return math.sqrt(self.gravity * self.wavenumber * math.tanh(self.wavenumber * self.depth))

    @property
    def period(self) -> float:
        """Period of an inviscid fluid, s."""
        return 2.0 * math.pi / self.frequency

    def _mode_field(self, position: Array) -> Array:
        """Return the velocity (n, 2) of unit amplitude."""
        k, (x, y) = self.wavenumber, position.T
        field = np.column_stack([-np.cosh(k * y) * np.sin(k * x), np.sinh(k * y) * np.cos(k * x)])
        return field / math.sinh(k * self.depth)

    def scene(self) -> Scene:
        """Draw the tank."""
        length, depth, height = self.tank_length, self.depth, 1.5 * self.depth
        size = self.amplitude * self.frequency

        def mode_velocity(fluid: Fields) -> float:
            mode = self._mode_field(fluid.position)
            return float(np.sum(mode * fluid.velocity) / np.sum(mode * mode))

        return Scene(
            walls=(PolygonWall(name="tank", points=((0, height), (0, 0), (length, 0), (length, height))),),
            fluid=(PolygonRegion(points=((0, 0), (length, 0), (length, depth), (0, depth))),),
            depth=depth,
            domain=((-0.1 * depth, -0.1 * depth), (length + 0.1 * depth, 2.0 * height)),
            initial_velocity=lambda position: size * self._mode_field(position),
            diagnostics=(Diagnostic("mode_velocity", "m s-1", "amplitude of the wave's velocity", mode_velocity),),
        )

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return ``mode_velocity`` over time."""
        t, rate = dataset["probe_time"].values, self.rate
        shape = np.exp(rate.real * t) * (np.cos(rate.imag * t) + rate.real / rate.imag * np.sin(rate.imag * t))
        values = self.amplitude * self.frequency * shape
        return xr.Dataset(
            {"mode_velocity": variable("probe_time", values, "m s-1", "amplitude of the wave's velocity")},
            coords={"probe_time": sample_times(dataset)},
        )

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the relative errors of frequency and damping, and the RMS one over the largest value of the series."""
        result, rate = super().errors(dataset), self.rate
        if dataset["probe_time"].values[-1] > self.period:
            t, values = dataset["probe_time"].values, dataset["mode_velocity"].values
            frequency, damping = fitted_oscillation(t, values, rate.imag, -rate.real)
            result["frequency"] = abs(frequency / rate.imag - 1.0)
            if rate.real < 0.0:
                result["damping"] = abs(damping / -rate.real - 1.0)
        return result
