"""Water in a bucket that turns about its axis."""

from collections.abc import Mapping
from typing import ClassVar, Literal

import numpy as np
import xarray as xr

from sphframe import Array, Case, InputError
from sphframe.cases import (
    Benchmark,
    Component,
    Derived,
    ExactCase,
    Gauge,
    Scene,
    downward_gravity,
    quantity,
    with_default,
)
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe_flows.solutions import variable

_GAUGES = 21


class RotatingBucket(ExactCase):
    """Water at rest in a plane bucket that turns about its middle, x = 0, seen from the bucket.

    The ``acceleration`` is the centrifugal force W^2 x of the body force ``rotating-frame``. Surface and pressure are::

        z = z0 + W^2 x^2 / (2 g),    p = rho [g (z0 - y) + W^2 x^2 / 2],    z0 = d - W^2 L^2 / (24 g)

    so that the mean depth is d. The water starts in this state, and nothing should move. ``errors``: ``surface``, the
    largest difference of the mean elevation at the gauges over the second half of the run, over the particle spacing.
    """

    title: ClassVar[str] = "water in a rotating bucket"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "rotating-bucket": Benchmark(
            "surface",
            "Still water under a force that varies in space; the error is over the particle spacing.",
            (0.03, 0.015),
            {"until": 1.0},
        )
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    gravity: float = downward_gravity()
    depth: float = quantity(0.3, "m", "mean depth d of the water", gt=0)
    tank_length: float = quantity(1.0, "m", "width L of the bucket", gt=0)
    angular_speed: float = quantity(3.0, "rad s-1", "angular speed W", ge=0)
    acceleration: Component = with_default(
        Case,
        "acceleration",
        Derived(
            "that of the rotating frame",
            lambda case: Component(name="rotating-frame", options={"angular_speed": case.angular_speed}),
        ),
    )
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("depth / 20", lambda case: case.depth / 20.0)
    )
    until: float = with_default(Case, "until", 2.0)
    frame_interval: float = with_default(Case, "frame_interval", 0.1)
    probe_interval: float = with_default(Case, "probe_interval", 0.01)

    def surface(self, x: Array) -> Array:
        """Return the height of the surface (n,) at ``x`` (n,), m."""
        curvature = self.angular_speed**2 / (2.0 * self.gravity)
        height: Array = self.depth + curvature * (np.square(x) - self.tank_length**2 / 12.0)
        return height

    def scene(self) -> Scene:
        """Draw the bucket."""
        half = 0.5 * self.tank_length
        x = np.linspace(half, -half, 101)
        if self.surface(np.zeros(1))[0] <= 0.0:
            raise InputError("the bed would be dry in the middle: give a smaller angular_speed, or more depth")
        height = float(self.surface(np.array([half]))[0]) + 0.5 * self.depth
        c2 = self.reference_sound_speed(self.depth) ** 2

        def pressure(position: Array) -> Array:
            below = self.surface(position[:, 0]) - position[:, 1]
            return np.asarray(self.reference_density * c2 * np.expm1(self.gravity * np.maximum(below, 0.0) / c2))

        surface = tuple(zip(x.tolist(), self.surface(x).tolist(), strict=True))
        return Scene(
            walls=(PolygonWall(name="bucket", points=((-half, height), (-half, 0), (half, 0), (half, height))),),
            fluid=(PolygonRegion(points=((-half, 0), (half, 0), *surface)),),
            depth=self.depth,
            domain=((-1.1 * half, -0.1 * self.depth), (1.1 * half, 2.0 * height)),
            initial_pressure=pressure,
            gauges=tuple(Gauge(name=f"G{i}", position=(float(x),)) for i, x in enumerate(self._gauges())),
        )

    def _gauges(self) -> Array:
        return np.linspace(-0.475, 0.475, _GAUGES) * self.tank_length

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the ``elevation`` of the surface at the gauges."""
        x = self._gauges()
        return xr.Dataset(
            {"elevation": variable("x", self.surface(x), "m", "elevation of the surface")},
            coords={"x": variable("x", x, "m", "x")},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the mean elevation at the gauges over the second half of the run."""
        series = dataset["gauge_elevation"].isel(probe_time=slice(dataset.sizes["probe_time"] // 2, None))
        elevation = variable("x", series.mean("probe_time").values, "m", "elevation of the surface")
        return xr.Dataset({"elevation": elevation}, coords={"x": variable("x", self._gauges(), "m", "x")})

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the largest difference of the surface over the particle spacing."""
        difference = self.measured(dataset)["elevation"] - self.exact(dataset)["elevation"]
        return {"surface": float(np.abs(difference).max()) / self.particle_spacing}
