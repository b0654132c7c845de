"""Flow between two cylinders that turn."""

import math
from collections.abc import Mapping
from typing import ClassVar, Literal

import numpy as np
import xarray as xr

from sphframe import Array, Case, InputError
from sphframe.cases import Benchmark, Derived, ExactCase, Scene, downward_gravity, quantity, with_default
from sphframe.geometry import Circle, CircleWall, DifferenceRegion
from sphframe_flows.solutions import late_mean, sample_times, variable
from sphframe_flows.spinning import Spinning


class TaylorCouette(ExactCase):
    """Viscous fluid between two cylinders that turn, full of fluid under a background pressure, without gravity.

    From rest, the cylinders reach their speeds in a tenth of the viscous time (r2 - r1)^2 / nu. The steady flow is::

        u = A r + B / r,    A = (W2 r2^2 - W1 r1^2) / (r2^2 - r1^2),    B = (W1 - W2) r1^2 r2^2 / (r2^2 - r1^2)

    with the torques -4 pi mu B of the fluid on the inner, +4 pi mu B on the outer cylinder, per metre. The walls
    ``inner`` and ``outer`` are those of the bodies of these names. The viscosity is that of Monaghan and Gingold: the
    form of Morris does not conserve angular momentum, and gives a torque on the inner cylinder that is a quarter too
    small. ``errors``: RMS of the velocity in the last frame over the largest speed, and of both torques (means over the
    last fifth of the run), relative.
    """

    title: ClassVar[str] = "flow between turning cylinders"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "taylor-couette": Benchmark("velocity", "Friction on a convex and on a concave wall.", (0.05, 0.025))
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    inner_radius: float = quantity(0.5, "m", "radius r1 of the inner cylinder", gt=0)
    outer_radius: float = quantity(1.0, "m", "radius r2 of the outer cylinder", gt=0)
    inner_speed: float = quantity(2.0, "rad s-1", "angular speed W1 of the inner cylinder")
    outer_speed: float = quantity(0.0, "rad s-1", "angular speed W2 of the outer cylinder")
    gravity: float = downward_gravity(0.0)
    kinematic_viscosity: float = with_default(Case, "kinematic_viscosity", 0.05)
    viscosity_model: Literal["morris", "monaghan-gingold"] = with_default(Case, "viscosity_model", "monaghan-gingold")
    artificial_viscosity: float = with_default(Case, "artificial_viscosity", 0.0)
    slip: Literal["free", "no"] = with_default(Case, "slip", "no")
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "free")
    sound_speed: float | None = with_default(
        Case, "sound_speed", Derived("10 times the largest speed", lambda case: 10.0 * case.largest_speed)
    )
    background_pressure: float = quantity(
        Derived("2 rho U^2", lambda case: 2.0 * case.reference_density * case.largest_speed**2),
        "Pa",
        "pressure at rest",
    )
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("gap / 20", lambda case: (case.outer_radius - case.inner_radius) / 20.0)
    )
    until: float = with_default(Case, "until", Derived("the viscous time", lambda case: case.viscous_time))
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 10", lambda case: case.until / 10.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("until / 500", lambda case: case.until / 500.0)
    )

    @property
    def largest_speed(self) -> float:
        """Largest speed of a wall, m/s."""
        return max(abs(self.inner_speed) * self.inner_radius, abs(self.outer_speed) * self.outer_radius)

    @property
    def viscous_time(self) -> float:
        """(r2 - r1)^2 / nu, s."""
        return float((self.outer_radius - self.inner_radius) ** 2 / self.kinematic_viscosity)

    @property
    def constants(self) -> tuple[float, float]:
        """A, 1/s, and B, m^2/s, of the steady flow."""
        one, two = self.inner_radius**2, self.outer_radius**2
        a = (self.outer_speed * two - self.inner_speed * one) / (two - one)
        return a, (self.inner_speed - self.outer_speed) * one * two / (two - one)

    def scene(self) -> Scene:
        """Draw the cylinders."""
        if not (self.inner_radius < self.outer_radius and self.kinematic_viscosity > 0.0 and self.largest_speed > 0.0):
            raise InputError("give inner_radius < outer_radius, a kinematic_viscosity, and a speed that is not zero")
        inner, outer = (Circle(centre=(0, 0), radius=r) for r in (self.inner_radius, self.outer_radius))
        ramp, pressure, reach = 0.1 * self.viscous_time, self.background_pressure, 1.2 * self.outer_radius
        return Scene(
            walls=(
                CircleWall(name="inner", centre=(0, 0), radius=self.inner_radius, body="inner"),
                CircleWall(name="outer", centre=(0, 0), radius=self.outer_radius, body="outer"),
            ),
            fluid=(DifferenceRegion(of=outer, minus=(inner,)),),
            depth=2.0 * self.outer_radius,
            domain=((-reach, -reach), (reach, reach)),
            bodies={"inner": Spinning(self.inner_speed, ramp), "outer": Spinning(self.outer_speed, ramp)},
            initial_pressure=lambda position: np.full(len(position), pressure),
        )

    def velocity(self, radius: Array) -> Array:
        """Return the velocity (n,) of the steady flow at ``radius`` (n,), m/s."""
        a, b = self.constants
        return a * radius + b / radius

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the ``velocity`` at the particles' radii, and the torques on both walls."""
        radius = np.hypot(*dataset["position"].isel(time=-1).values.T)
        torque = 4.0 * math.pi * self.reference_density * self.kinematic_viscosity * self.constants[1]
        ones = np.ones(dataset.sizes["probe_time"])
        return xr.Dataset(
            {
                "velocity": variable("radius", self.velocity(radius), "m s-1", "velocity around the axis"),
                "inner_torque": variable("probe_time", -torque * ones, "N", "torque on the inner cylinder"),
                "outer_torque": variable("probe_time", torque * ones, "N", "torque on the outer cylinder"),
            },
            coords={"radius": variable("radius", radius, "m", "radius"), "probe_time": sample_times(dataset)},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        exact = self.exact(dataset)
        (x, y), (u, v) = (dataset[name].isel(time=-1).values.T for name in ("position", "velocity"))
        values = {"velocity": (x * v - y * u) / exact["radius"].values}
        for wall in ("inner", "outer"):
            values[f"{wall}_torque"] = dataset["wall_moment"].sel(wall=wall).values
        return exact.assign({name: (exact[name].dims, value, exact[name].attrs) for name, value in values.items()})

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of velocity and torques."""
        exact, run = self.exact(dataset), self.measured(dataset)
        rms = float(np.sqrt(((run["velocity"] - exact["velocity"]) ** 2).mean()))
        torques = {name: late_mean(run[name]) / float(exact[name][0]) for name in ("inner_torque", "outer_torque")}
        return {"velocity": rms / self.largest_speed} | {k: abs(value - 1.0) for k, value in torques.items()}
