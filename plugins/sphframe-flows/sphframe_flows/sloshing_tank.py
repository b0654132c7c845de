"""Water in a tank that is shaken."""

import math
from collections.abc import Mapping
from typing import ClassVar, Literal

import numpy as np
import xarray as xr

from sphframe import Array, Case
from sphframe.cases import (
    Benchmark,
    Component,
    Derived,
    Diagnostic,
    ExactCase,
    Fields,
    Gauge,
    Scene,
    downward_gravity,
    quantity,
    with_default,
)  # fmt: skip
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe_flows.solutions import sample_times, variable

_MODES = 199


class SloshingTank(ExactCase):
    """Water at rest in a tank that is displaced by X = A (1 - cos W t), seen from the tank.

    The ``acceleration`` is the force -X'' of the body force ``surge``. In linear potential flow the elevation is::

        eta = sum_(n odd) a_n cos kx,    k = n pi / L,    w_n^2 = g k tanh kd
        a_n = 4 tanh(kd) / (L k) A W^2 (cos W t - cos w_n t) / (w_n^2 - W^2)

    The gauge ``left`` stands at L/20 from the left wall. The diagnostic ``mass_offset``, the mean x of the water less
    L/2, is -2 / (L d) sum a_n / k^2; it resolves elevations smaller than a particle.
    ``errors``: ``amplitude`` is the least-squares factor of run over solution, of the offset, less one.

    Source: O. M. Faltinsen, J. Ship Res. 22 (1978) 224.
    """

    title: ClassVar[str] = "sloshing in a shaken tank"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "sloshing-tank": Benchmark("amplitude", "Waves in a tank that is shaken.", (0.05, 0.025))
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    gravity: float = downward_gravity()
    depth: float = quantity(0.5, "m", "depth d of the water", gt=0)
    tank_length: float = quantity(1.0, "m", "length L of the tank", gt=0)
    displacement: float = quantity(0.01, "m", "amplitude A of the tank's displacement", gt=0)
    angular_frequency: float = quantity(3.0, "rad s-1", "angular frequency W of the tank", gt=0)
    acceleration: Component = with_default(
        Case, "acceleration", Derived("surge of the tank", lambda case: Component(name="surge", options=case.surge()))
    )
    artificial_viscosity: float = with_default(Case, "artificial_viscosity", 0.0)
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("depth / 20", lambda case: case.depth / 20.0)
    )
    until: float = with_default(Case, "until", 5.0)
    frame_interval: float = with_default(Case, "frame_interval", 0.1)
    probe_interval: float = with_default(Case, "probe_interval", 0.01)

    def surge(self) -> dict[str, float]:
        """Return the options of the body force."""
        return {"amplitude": self.displacement, "angular_frequency": self.angular_frequency}

    def scene(self) -> Scene:
        """Draw the tank."""
        length, depth, height = self.tank_length, self.depth, 2.0 * self.depth

        def mass_offset(fluid: Fields) -> float:
            return float(fluid.position[:, 0].mean()) - 0.5 * length

        return Scene(
            walls=(PolygonWall(name="tank", points=((0, height), (0, 0), (length, 0), (length, height))),),
            fluid=(PolygonRegion(points=((0, 0), (length, 0), (length, depth), (0, depth))),),
            depth=depth,
            domain=((-0.1 * depth, -0.1 * depth), (length + 0.1 * depth, 2.0 * height)),
            gauges=(Gauge(name="left", position=(0.05 * length,)),),
            diagnostics=(Diagnostic("mass_offset", "m", "mean x of the water from the middle", mass_offset),),
        )

    def modes(self, time: Array) -> tuple[Array, Array]:
        """Return the wavenumbers (n,), 1/m, and the amplitudes (n, t), m, of the odd modes at ``time`` (t,), s."""
        forced, size = self.angular_frequency, self.displacement * self.angular_frequency**2
        k = np.arange(1, _MODES, 2) * math.pi / self.tank_length
        w2 = self.gravity * k * np.tanh(k * self.depth)
        near = np.abs(w2 - forced**2) < 1e-9 * forced**2
        w = np.sqrt(w2)[:, None]
        response = np.cos(forced * time) - np.cos(w * time)
        response = response / np.where(near, 1.0, w2 - forced**2)[:, None]
        response[near] = 0.5 * time * np.sin(forced * time) / forced
        return k, (4.0 * np.tanh(k * self.depth) / (self.tank_length * k) * size)[:, None] * response

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return ``elevation`` at the gauge above still water and ``mass_offset``, over time."""
        k, modes = self.modes(dataset["probe_time"].values)
        gauge = np.cos(0.05 * self.tank_length * k) @ modes
        offset = -2.0 / (self.tank_length * self.depth) * (modes / k[:, None] ** 2).sum(axis=0)
        return xr.Dataset(
            {
                "elevation": variable("probe_time", gauge, "m", "elevation at the gauge"),
                "mass_offset": variable("probe_time", offset, "m", "mean x of the water from the middle"),
            },
            coords={"probe_time": sample_times(dataset)},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        elevation = dataset["gauge_elevation"].isel(gauge=0, drop=True) - self.depth
        return dataset[["mass_offset"]].assign(elevation=elevation)

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the error of the amplitude, and the RMS differences over the largest exact values."""
        exact, run = self.exact(dataset)["mass_offset"].values, dataset["mass_offset"].values
        square = float(exact @ exact)
        return {"amplitude": abs(float(run @ exact) / square - 1.0) if square else 0.0, **super().errors(dataset)}
