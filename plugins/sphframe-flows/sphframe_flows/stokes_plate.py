"""Viscous fluid between two plates that oscillate."""

import math
from collections.abc import Mapping
from typing import ClassVar, Literal

import numpy as np
import xarray as xr

from sphframe import Array, Case
from sphframe.cases import Benchmark, Component, Derived, ExactCase, Scene, downward_gravity, quantity, with_default
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe_flows.solutions import variable


class StokesPlate(ExactCase):
    """Viscous fluid between two plates that oscillate together along x, seen from the plates; periodic in x.

    The plates have the velocity A W sin W t, so that the fluid is driven by the body force ``surge``. With
    alpha^2 = i W / nu the velocity relative to the plates is::

        u = Re{-i A W exp(i W t) [cosh(alpha (y - H/2)) / cosh(alpha H/2) - 1]}

    with which the fluid starts. Layers of the thickness sqrt(2 nu / W) form at the plates y = 0 and y = H, Stokes'
    second problem if they are thin. ``errors``: RMS of the velocity in the last frame over A W.

    Source: G. G. Stokes (1851), On the effect of the internal friction of fluids on the motion of pendulums.
    """

    title: ClassVar[str] = "fluid between oscillating plates"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "stokes-plate": Benchmark(
            "velocity",
            "Friction that changes in time, through a thin layer along the wall.",
            (0.1, 0.05),
            {"kinematic_viscosity": 0.2, "until": 0.8},
        )
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    gap: float = quantity(1.0, "m", "distance H of the plates", gt=0)
    displacement: float = quantity(0.1, "m", "amplitude A of the plates", gt=0)
    angular_frequency: float = quantity(5.0, "rad s-1", "angular frequency W", gt=0)
    gravity: float = downward_gravity(0.0)
    kinematic_viscosity: float = with_default(Case, "kinematic_viscosity", 0.05)
    artificial_viscosity: float = with_default(Case, "artificial_viscosity", 0.0)
    slip: Literal["free", "no"] = with_default(Case, "slip", "no")
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "free")
    periodic: tuple[Literal["x", "y", "z"], ...] = with_default(Case, "periodic", ("x",))
    particle_spacing: float = with_default(Case, "particle_spacing", 0.05)
    sound_speed: float | None = with_default(Case, "sound_speed", Derived("20 A W", lambda case: 20.0 * case.speed))
    acceleration: Component = with_default(
        Case, "acceleration", Derived("surge of the plates", lambda case: Component(name="surge", options=case.surge()))
    )
    until: float = with_default(
        Case, "until", Derived("2.3 periods", lambda case: 4.6 * math.pi / case.angular_frequency)
    )
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 20", lambda case: case.until / 20.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("until / 200", lambda case: case.until / 200.0)
    )

    @property
    def speed(self) -> float:
        """Largest speed A W of the plates, m/s."""
        return self.displacement * self.angular_frequency

    def surge(self) -> dict[str, float]:
        """Return the options of the body force."""
        return {"amplitude": self.displacement, "angular_frequency": self.angular_frequency}

    def velocity(self, y: Array, time: float) -> Array:
        """Return the velocity (n,) along x at the heights ``y`` (n,), m/s."""
        alpha = np.sqrt(1j * self.angular_frequency / self.kinematic_viscosity)
        shape = np.cosh(alpha * (y - 0.5 * self.gap)) / np.cosh(0.5 * alpha * self.gap) - 1.0
        return np.asarray((-1j * self.speed * np.exp(1j * self.angular_frequency * time) * shape).real)

    def scene(self) -> Scene:
        """Draw one period of the gap."""
        gap, length = self.gap, math.ceil(20.0 * self.smoothing_length_ratio / 1.3) * self.particle_spacing
        corners = ((0.0, 0.0), (length, 0.0), (length, gap), (0.0, gap))

        def start(position: Array) -> Array:
            return np.column_stack([self.velocity(position[:, 1], 0.0), np.zeros(len(position))])

        return Scene(
            walls=(
                PolygonWall(name="lower", points=((0.0, 0.0), (length, 0.0))),
                PolygonWall(name="upper", points=((length, gap), (0.0, gap))),
            ),
            fluid=(PolygonRegion(points=corners, pressure=0.0),),
            depth=gap,
            domain=((0.0, -0.1 * gap), (length, 1.1 * gap)),
            initial_velocity=start,
        )

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the ``velocity`` along x at the heights of the particles in the last frame."""
        y = dataset["position"].isel(time=-1, space=1).values
        velocity = self.velocity(y, float(dataset["time"][-1]))
        return xr.Dataset(
            {"velocity": variable("y", velocity, "m s-1", "velocity along x")}, coords={"y": variable("y", y, "m", "y")}
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        velocity = dataset["velocity"].isel(time=-1, space=0).values
        return self.exact(dataset).assign(velocity=variable("y", velocity, "m s-1", "velocity along x"))

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the RMS difference over the largest speed of the plates."""
        difference = self.measured(dataset)["velocity"].values - self.exact(dataset)["velocity"].values
        return {"velocity": float(np.sqrt(np.square(difference).mean())) / self.speed}
