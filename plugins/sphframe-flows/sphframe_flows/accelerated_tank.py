"""Water at rest in a tank that is accelerated."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Literal, final

import numpy as np
import xarray as xr

from sphframe import Array, Case, InputError, Motion, RigidBody
from sphframe.cases import Benchmark, Derived, ExactCase, Scene, downward_gravity, quantity, with_default
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe_flows.solutions import variable


@final
@dataclass(frozen=True)
class _Accelerated(RigidBody):
    """A body with a constant ``acceleration`` in generalised coordinates, m/s^2 and rad/s^2, from rest."""

    acceleration: tuple[float, float, float]

    def motion(self, time: float, position: Array, velocity: Array, load: Array) -> Motion:
        """Return the motion at ``time``."""
        a = np.array(self.acceleration)
        return Motion(0.5 * a * time**2, a * time, a)


@final
class AcceleratedTank(ExactCase):
    """Water in a tank that moves with a constant acceleration a from the start: it is at rest in the tank.

    Seen from the tank gravity is G = (-a_x, -g - a_y), so that the surface slopes by -a_x / (g + a_y) and the pressure
    is rho |G| times the distance from the surface; a tank that falls freely, a_y = -g, holds water without pressure.
    The water starts in this state. ``errors``: ``pressure``, RMS of the particles in the last frame over rho g d, and
    ``velocity``, RMS relative to the tank over sqrt(g d).
    """

    title: ClassVar[str] = "water in an accelerated tank"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "accelerated-tank": Benchmark(
            "pressure", "Acceleration of walls: water at rest in a tank that is accelerated.", (0.03, 0.015)
        ),
        "falling-tank": Benchmark(
            "pressure",
            "Acceleration of walls: water without pressure in a tank that falls.",
            (0.03, 0.015),
            {"acceleration_along": 0.0, "acceleration_up": -9.81},
        ),
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    gravity: float = downward_gravity()
    depth: float = quantity(0.3, "m", "mean depth d of the water", gt=0)
    tank_length: float = quantity(0.6, "m", "length of the tank", gt=0)
    acceleration_along: float = quantity(3.0, "m s-2", "acceleration a_x of the tank")
    acceleration_up: float = quantity(0.0, "m s-2", "acceleration a_y of the tank")
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "none")
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("depth / 20", lambda case: case.depth / 20.0)
    )
    until: float = with_default(Case, "until", 0.5)
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 20", lambda case: case.until / 20.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("until / 200", lambda case: case.until / 200.0)
    )

    @property
    def slope(self) -> float:
        """Slope of the surface; zero in a free fall."""
        down = self.gravity + self.acceleration_up
        return -self.acceleration_along / down if down > 0.0 else 0.0

    def _pressure(self, position: Array) -> Array:
        """Return the pressure (n,) at ``position`` (n, 2), m, seen from the tank, Pa."""
        c2 = self.reference_sound_speed(self.depth) ** 2
        surface = self.depth + self.slope * (position[:, 0] - 0.5 * self.tank_length)
        work = (self.gravity + self.acceleration_up) * np.maximum(surface - position[:, 1], 0.0)
        return np.asarray(self.reference_density * c2 * np.expm1(work / c2))

    def scene(self) -> Scene:
        """Draw the tank and the water in it."""
        if self.gravity + self.acceleration_up < 0.0 or (self.acceleration_along and not self.slope):
            raise InputError(
                "the water would leave the bed: give g + acceleration_up > 0, or a free fall straight down"
            )
        length, depth = self.tank_length, self.depth
        left, right = (depth + 0.5 * side * self.slope * length for side in (-1.0, 1.0))
        if min(left, right) <= 0.0:
            raise InputError("the bed would be dry at one end: give a smaller acceleration, or more depth")
        height = max(left, right) + 0.5 * depth
        a = np.array([self.acceleration_along, self.acceleration_up, 0.0])
        low, high = np.array([-0.1 * depth, -0.1 * depth]), np.array([length + 0.1 * depth, 2.0 * height])
        way = 0.6 * a[:2] * self.until**2
        return Scene(
            walls=(PolygonWall(name="tank", points=((0, height), (0, 0), (length, 0), (length, height)), body="tank"),),
            fluid=(PolygonRegion(points=((0, 0), (length, 0), (length, right), (0, left))),),
            depth=depth,
            domain=(tuple(np.minimum(low, low + way).tolist()), tuple(np.maximum(high, high + way).tolist())),
            bodies={"tank": _Accelerated(tuple(a.tolist()))},
            initial_pressure=self._pressure,
        )

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return ``pressure`` and ``velocity`` of the particles in the last frame."""
        last = dataset.isel(time=-1)
        t, position = float(last["time"]), last["position"].values
        way = 0.5 * t * t * np.array([self.acceleration_along, self.acceleration_up])
        speed = t * np.hypot(self.acceleration_along, self.acceleration_up)
        x = position[:, 0] - way[0]
        return xr.Dataset(
            {
                "pressure": variable("x", self._pressure(position - way), "Pa", "pressure"),
                "speed": variable("x", np.full(len(x), speed), "m s-1", "speed"),
            },
            coords={"x": variable("x", x, "m", "x, seen from the tank")},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        last = dataset.isel(time=-1)
        return self.exact(dataset).assign(
            pressure=variable("x", last["pressure"].values, "Pa", "pressure"),
            speed=variable("x", np.linalg.norm(last["velocity"].values, axis=1), "m s-1", "speed"),
        )

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of pressure and velocity."""
        exact, run, last = self.exact(dataset), self.measured(dataset), dataset.isel(time=-1)
        tank = float(last["time"]) * np.array([self.acceleration_along, self.acceleration_up])
        relative = last["velocity"].values - tank
        scale = self.reference_density * self.gravity * self.depth
        return {
            "pressure": float(np.sqrt(((run["pressure"] - exact["pressure"]) ** 2).mean())) / scale,
            "velocity": float(np.sqrt((relative**2).sum(axis=1).mean() / (self.gravity * self.depth))),
        }
