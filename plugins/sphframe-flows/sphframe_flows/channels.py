"""Flow between two parallel walls, driven by a body force or by a wall that slides."""

import math
from abc import abstractmethod
from collections.abc import Mapping
from typing import ClassVar, Literal, final

import numpy as np
import xarray as xr

from sphframe import Array, Case, InputError
from sphframe.cases import Benchmark, Component, Derived, ExactCase, Scene, downward_gravity, quantity, with_default
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe_flows.solutions import late_mean, sample_times, variable

_TERMS = 200


class Channel(ExactCase):
    """Viscous fluid between the walls ``bed``, y = 0, and ``lid``, y = L, periodic along x, from rest, without gravity.

    ``errors``: ``velocity`` is the largest difference from the solution in the last frame, ``start_up`` that in all
    frames, both over the largest steady velocity; ``stress`` that of the forces on both walls per area, means over the
    last fifth of the run, over the steady stress.
    """

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    channel_width: float = quantity(1.0, "m", "distance L of the walls", gt=0)
    channel_length: float = quantity(
        Derived("16 spacings", lambda case: 16.0 * case.particle_spacing), "m", "length of a period", gt=0
    )
    periodic: tuple[Literal["x", "y", "z"], ...] = with_default(Case, "periodic", ("x",))
    gravity: float = downward_gravity(0.0)
    kinematic_viscosity: float = with_default(Case, "kinematic_viscosity", 0.1)
    viscosity_model: Literal["morris", "monaghan-gingold"] = with_default(Case, "viscosity_model", "morris")
    artificial_viscosity: float = with_default(Case, "artificial_viscosity", 0.0)
    slip: Literal["free", "no"] = with_default(Case, "slip", "no")
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "free")
    sound_speed: float | None = with_default(
        Case, "sound_speed", Derived("10 times the largest velocity", lambda case: 10.0 * case.largest_velocity)
    )
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("channel_width / 32", lambda case: case.channel_width / 32.0)
    )
    until: float = with_default(
        Case, "until", Derived("L^2 / nu", lambda case: case.channel_width**2 / case.kinematic_viscosity)
    )
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 50", lambda case: case.until / 50.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("until / 500", lambda case: case.until / 500.0)
    )

    @property
    @abstractmethod
    def largest_velocity(self) -> float:
        """Largest steady velocity, m/s."""

    @property
    @abstractmethod
    def lid_velocity(self) -> float:
        """Velocity of the upper wall, m/s."""

    @abstractmethod
    def velocity(self, y: Array, time: float) -> Array:
        """Return the velocity (n,) at heights ``y`` (n,), m/s."""

    @abstractmethod
    def stresses(self, time: Array) -> tuple[Array, Array]:
        """Return the stresses (n,) along x on the bed and on the lid, Pa."""

    def scene(self) -> Scene:
        """Draw a period of the channel."""
        if self.kinematic_viscosity == 0.0 or self.largest_velocity == 0.0 or self.periodic != ("x",):
            raise InputError('a channel needs a kinematic_viscosity, a flow that is not zero, and periodic = ["x"]')
        width, length = self.channel_width, self.channel_length
        speed = (self.lid_velocity, 0.0)
        return Scene(
            walls=(
                PolygonWall(name="bed", points=((0.0, 0.0), (length, 0.0))),
                PolygonWall(name="lid", points=((0.0, width), (length, width)), surface_velocity=speed),
            ),
            fluid=(PolygonRegion(points=((0.0, 0.0), (length, 0.0), (length, width), (0.0, width))),),
            depth=width,
            domain=((0.0, -width), (length, 2.0 * width)),
        )

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the ``velocity`` at the heights of the particles in the last frame, and the stresses on both walls."""
        y, time = dataset["position"].isel(time=-1, space=1).values, dataset["probe_time"].values
        velocity, (bed, lid) = self.velocity(y, float(dataset["time"][-1])), self.stresses(time)
        return xr.Dataset(
            {
                "velocity": variable("y", velocity, "m s-1", "velocity along the channel"),
                "bed_stress": variable("probe_time", bed, "Pa", "stress on the bed"),
                "lid_stress": variable("probe_time", lid, "Pa", "stress on the lid"),
            },
            coords={"y": variable("y", y, "m", "height above the bed"), "probe_time": sample_times(dataset)},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        exact = self.exact(dataset)
        values = {"velocity": dataset["velocity"].isel(time=-1, space=0).values}
        for wall in ("bed", "lid"):
            values[f"{wall}_stress"] = dataset["wall_force"].sel(wall=wall, space="x").values / self.channel_length
        return exact.assign({name: (exact[name].dims, value, exact[name].attrs) for name, value in values.items()})

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of velocity and stress."""
        exact, run = self.exact(dataset), self.measured(dataset)
        height, found = dataset["position"].isel(space=1).values, dataset["velocity"].isel(space=0).values
        times = dataset["time"].values
        largest = [np.abs(u - self.velocity(y, t)).max() for y, u, t in zip(height, found, times, strict=True)]
        steady = max(abs(float(stress[0])) for stress in self.stresses(np.array([math.inf])))
        differences = [late_mean(run[f"{w}_stress"] - exact[f"{w}_stress"]) for w in ("bed", "lid")]
        return {
            "velocity": float(largest[-1]) / self.largest_velocity,
            "start_up": float(max(largest)) / self.largest_velocity,
            "stress": float(np.abs(differences).max()) / steady,
        }


@final
class Poiseuille(Channel):
    """Flow between two walls at rest that a body force f along x drives, with k = (2 n + 1) pi / L::

        u = f y (L - y) / (2 nu) - sum_(n >= 0) 4 f L^2 / (nu pi^3 (2 n + 1)^3) sin(k y) exp(-nu k^2 t)
        stress on each wall = rho f L / 2 [1 - sum_(n >= 0) 8 / (pi^2 (2 n + 1)^2) exp(-nu k^2 t)]

    Source: G. K. Batchelor, An Introduction to Fluid Dynamics (1967), section 4.3.
    """

    title: ClassVar[str] = "plane Poiseuille flow"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "poiseuille": Benchmark(
            "velocity", "Friction of straight walls: the velocity of ghosts with no slip.", (0.0625, 0.03125)
        )
    }

    body_force: float = quantity(0.8, "m s-2", "body force f per mass, along x")
    acceleration: Component = with_default(
        Case,
        "acceleration",
        Derived("body_force along x", lambda case: Component(name="uniform", options={"vector": (case.body_force, 0)})),
    )

    @property
    def largest_velocity(self) -> float:
        """F L^2 / (8 nu), m/s."""
        return float(abs(self.body_force) * self.channel_width**2 / (8.0 * max(self.kinematic_viscosity, 1e-300)))

    @property
    def lid_velocity(self) -> float:
        """Zero."""
        return 0.0

    def _decay(self, time: Array) -> tuple[Array, Array]:
        """Return 2 n + 1 (terms,), and exp(-nu k^2 t) (terms, n)."""
        odd = 2.0 * np.arange(_TERMS) + 1.0
        rate = self.kinematic_viscosity * (odd * np.pi / self.channel_width) ** 2
        return odd, np.exp(-np.outer(rate, time))

    def velocity(self, y: Array, time: float) -> Array:
        """Return the velocity (n,) at heights ``y`` (n,), m/s."""
        width, scale = self.channel_width, self.body_force / self.kinematic_viscosity
        odd, decay = self._decay(np.array([time]))
        waves = np.sin(np.outer(odd, np.pi * y / width)) * decay / odd[:, None] ** 3
        velocity: Array = 0.5 * scale * y * (width - y) - 4.0 * scale * width**2 / np.pi**3 * waves.sum(axis=0)
        return velocity

    def stresses(self, time: Array) -> tuple[Array, Array]:
        """Return the stresses (n,) along x on the bed and on the lid, Pa."""
        odd, decay = self._decay(time)
        grown = 1.0 - (8.0 / np.pi**2) * (decay / odd[:, None] ** 2).sum(axis=0)
        stress = 0.5 * self.reference_density * self.body_force * self.channel_width * grown
        return stress, stress


@final
class Couette(Channel):
    """Flow between a wall at rest and one that slides along x with the speed U from the start::

        u = U y / L + sum_(n >= 1) 2 U / (n pi) (-1)^n sin(n pi y / L) exp(-nu (n pi / L)^2 t)

    Source: G. K. Batchelor, An Introduction to Fluid Dynamics (1967), section 4.3.
    """

    title: ClassVar[str] = "plane Couette flow"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "couette": Benchmark("velocity", "Friction of a wall that slides along itself.", (0.0625, 0.03125))
    }

    wall_speed: float = quantity(1.0, "m s-1", "speed U of the lid")

    @property
    def largest_velocity(self) -> float:
        """The speed of the lid, m/s."""
        return abs(self.wall_speed)

    @property
    def lid_velocity(self) -> float:
        """The velocity of the lid, m/s."""
        return self.wall_speed

    def _decay(self, time: Array) -> tuple[Array, Array]:
        """Return n (terms,), and exp(-nu (n pi / L)^2 t) (terms, n)."""
        number = np.arange(_TERMS) + 1.0
        rate = self.kinematic_viscosity * (number * np.pi / self.channel_width) ** 2
        return number, np.exp(-np.outer(rate, time))

    def velocity(self, y: Array, time: float) -> Array:
        """Return the velocity (n,) at heights ``y`` (n,), m/s; at rest at the time 0."""
        if time == 0.0:
            return np.zeros_like(y)
        number, decay = self._decay(np.array([time]))
        waves = (-1.0) ** number[:, None] * np.sin(np.outer(number, np.pi * y / self.channel_width)) * decay
        velocity: Array = self.wall_speed * (
            y / self.channel_width + 2.0 / np.pi * (waves / number[:, None]).sum(axis=0)
        )
        return velocity

    def stresses(self, time: Array) -> tuple[Array, Array]:
        """Return the stresses (n,) along x on the bed and on the lid, Pa; NaN on the lid at the start."""
        number, decay = self._decay(time)
        scale = self.reference_density * self.kinematic_viscosity * self.wall_speed / self.channel_width
        bed = 1.0 + 2.0 * ((-1.0) ** number[:, None] * decay).sum(axis=0)
        lid = 1.0 + 2.0 * decay.sum(axis=0)
        early = time < (0.02 * self.channel_width) ** 2 / self.kinematic_viscosity
        return np.where(early, 0.0, scale * bed), np.where(early, np.nan, -scale * lid)
