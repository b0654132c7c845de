"""Fluid in a drum: it turns as a rigid body, or slows down by friction."""

import math
from collections.abc import Mapping
from typing import ClassVar, Literal, final

import numpy as np
import xarray as xr
from scipy.special import j0, j1, jn_zeros

from sphframe import Array, Case, InputError
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
from sphframe.geometry import CircleRegion, CircleWall
from sphframe_flows.solutions import sample_times, variable

_TERMS = 60


@final
class Drum(ExactCase):
    """Fluid that fills a drum of radius R at rest and turns with the angular speed W at the start, without gravity.

    With ``slip = "free"`` it turns for ever, u = W r, with the pressure p = p_b + rho W^2 (r^2 - R^2 / 2) / 2. With
    ``slip = "no"`` and a viscosity the wall slows it down, with the roots l_n of J1::

        u = -2 W R sum_n J1(l_n r / R) / [l_n J0(l_n)] exp(-l_n^2 nu t / R^2)

    and the angular momentum falls as sum_n 8 / l_n^2 exp(-l_n^2 nu t / R^2). ``errors``: ``velocity``, RMS of the
    velocity around the centre in the last frame over W R; ``angular_momentum``, largest difference over its start;
    ``radial_velocity``, RMS of the other component over W R.

    Source: G. K. Batchelor, An Introduction to Fluid Dynamics (1967), section 4.5.
    """

    title: ClassVar[str] = "fluid that turns in a drum"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "drum-rotation": Benchmark(
            "velocity",
            "Free slip along a curved wall, and the pressure of a centripetal force.",
            (0.05, 0.025),
            {"slip": "free"},
        ),
        "drum-spin-down": Benchmark(
            "angular_momentum", "Friction of a curved wall that brakes a flow.", (0.05, 0.025), {"slip": "no"}
        ),
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    radius: float = quantity(0.5, "m", "radius R of the drum", gt=0)
    angular_speed: float = quantity(2.0, "rad s-1", "angular speed W at the start", gt=0)
    gravity: float = downward_gravity(0.0)
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "free")
    kinematic_viscosity: float = with_default(
        Case, "kinematic_viscosity", Derived("W R^2 / 50 with no slip, else 0", lambda case: case.viscosity_for_slip)
    )
    viscosity_model: Literal["morris", "monaghan-gingold"] = with_default(Case, "viscosity_model", "monaghan-gingold")
    artificial_viscosity: float = with_default(Case, "artificial_viscosity", 0.0)
    sound_speed: float | None = with_default(
        Case, "sound_speed", Derived("10 W R", lambda case: 10.0 * case.angular_speed * case.radius)
    )
    background_pressure: float = quantity(
        Derived("2 rho (W R)^2", lambda case: 2.0 * case.reference_density * (case.angular_speed * case.radius) ** 2),
        "Pa",
        "mean pressure p_b",
    )
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("radius / 20", lambda case: case.radius / 20.0)
    )
    until: float = with_default(Case, "until", Derived("2 pi / W", lambda case: 2.0 * math.pi / case.angular_speed))
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 20", lambda case: case.until / 20.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("until / 500", lambda case: case.until / 500.0)
    )

    @property
    def viscosity_for_slip(self) -> float:
        """W R^2 / 50 with no slip, else 0, m^2/s."""
        return self.angular_speed * self.radius**2 / 50.0 if self.slip == "no" else 0.0

    def scene(self) -> Scene:
        """Draw the drum."""
        if self.slip == "free" and self.kinematic_viscosity > 0.0:
            raise InputError(
                'with slip = "free" the solution holds without kinematic_viscosity: give 0, or slip = "no"'
            )
        speed, radius, reach = self.angular_speed, self.radius, 1.2 * self.radius

        def pressure(position: Array) -> Array:
            square = np.sum(position**2, axis=1)
            return self.background_pressure + 0.5 * self.reference_density * speed**2 * (square - 0.5 * radius**2)

        def angular_momentum(fluid: Fields) -> float:
            (x, y), (u, v) = fluid.position.T, fluid.velocity.T
            return float(np.mean(x * v - y * u))

        return Scene(
            walls=(CircleWall(name="drum", centre=(0, 0), radius=radius),),
            fluid=(CircleRegion(centre=(0, 0), radius=radius),),
            depth=2.0 * radius,
            domain=((-reach, -reach), (reach, reach)),
            initial_pressure=pressure,
            initial_velocity=lambda position: speed * np.column_stack([-position[:, 1], position[:, 0]]),
            diagnostics=(Diagnostic("angular_momentum", "m2 s-1", "angular momentum per mass", angular_momentum),),
        )

    def _decay(self, time: Array) -> tuple[Array, Array]:
        """Return the roots l_n (terms,), and the factors (terms, n) at ``time`` (n,), s."""
        roots = jn_zeros(1, _TERMS)
        return roots, np.exp(-np.outer(roots**2, self.kinematic_viscosity * time / self.radius**2))

    def velocity(self, radius: Array, time: float) -> Array:
        """Return the velocity (n,) around the centre at ``radius`` (n,), m, and ``time``, s; m/s."""
        if self.slip == "free" or time == 0.0:
            return self.angular_speed * radius
        roots, decay = self._decay(np.array([time]))
        shape = j1(np.outer(roots, radius / self.radius)) / (roots * j0(roots))[:, None]
        return np.asarray(-2.0 * self.angular_speed * self.radius * (shape * decay).sum(axis=0))

    def momentum_left(self, time: Array) -> Array:
        """Return the angular momentum (n,) at ``time`` (n,), s, over that at the start."""
        if self.slip == "free":
            return np.ones_like(time)
        roots, decay = self._decay(time)
        return np.asarray((8.0 / roots[:, None] ** 2 * decay).sum(axis=0))

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the ``velocity`` at the particles' radii in the last frame, and the ``angular_momentum``."""
        last = dataset.isel(time=-1)
        radius = np.hypot(*last["position"].values.T)
        time = dataset["probe_time"].values
        start = float(dataset["angular_momentum"][0])
        momentum = start * np.where(time > 0.0, self.momentum_left(time), 1.0)
        return xr.Dataset(
            {
                "velocity": variable("radius", self.velocity(radius, float(last["time"])), "m s-1", "velocity"),
                "angular_momentum": variable("probe_time", momentum, "m2 s-1", "angular momentum per mass"),
            },
            coords={"radius": variable("radius", radius, "m", "radius"), "probe_time": sample_times(dataset)},
        )

    def _components(self, dataset: xr.Dataset) -> tuple[Array, Array]:
        """Return the velocities (n,) around and away from the centre in the last frame, m/s."""
        (x, y), (u, v) = (dataset[name].isel(time=-1).values.T for name in ("position", "velocity"))
        radius = np.maximum(np.hypot(x, y), 1e-300)
        return (x * v - y * u) / radius, (x * u + y * v) / radius

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        around, _ = self._components(dataset)
        return self.exact(dataset).assign(
            velocity=variable("radius", around, "m s-1", "velocity"),
            angular_momentum=variable(
                "probe_time", dataset["angular_momentum"].values, "m2 s-1", "angular momentum per mass"
            ),
        )

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of both components of the velocity, and of the angular momentum."""
        exact, run = self.exact(dataset), self.measured(dataset)
        scale = self.angular_speed * self.radius
        _, away = self._components(dataset)
        momentum = np.abs(run["angular_momentum"] - exact["angular_momentum"]).max() / exact["angular_momentum"][0]
        return {
            "velocity": float(np.sqrt(((run["velocity"] - exact["velocity"]) ** 2).mean())) / scale,
            "angular_momentum": float(momentum),
            "radial_velocity": float(np.sqrt(np.mean(away**2))) / scale,
        }
