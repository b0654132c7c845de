"""A cylinder that oscillates in a closed drum."""

import math
from collections.abc import Mapping
from typing import ClassVar, Literal

import numpy as np
import xarray as xr

from sphframe import Array, Case, InputError
from sphframe.cases import Benchmark, Derived, ExactCase, Scene, downward_gravity, quantity, with_default
from sphframe.geometry import Circle, CircleWall, DifferenceRegion
from sphframe_flows.oscillating import Oscillating
from sphframe_flows.solutions import sample_times, variable


class OscillatingCylinder(ExactCase):
    """A cylinder of radius r oscillates along x in a drum of radius R full of fluid, with free slip.

    The displacement X = a sin(omega t) grows in the first period. In potential flow, for a << r, the forces per metre
    are F = -C rho pi r^2 X'' on the cylinder and F = D rho pi r^2 X'' on the drum, with the added-mass coefficients::

        C = (R^2 + r^2) / (R^2 - r^2),    D = 2 R^2 / (R^2 - r^2)

    ``errors``: of both coefficients, fitted after the first period, relative, and ``quadrature``, the part of the force
    on the cylinder in phase with the velocity, over that in phase with the acceleration: zero without losses.
    """

    title: ClassVar[str] = "cylinder that oscillates in a drum"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "oscillating-cylinder": Benchmark(
            "added_mass_inner", "Pressure on a curved wall that accelerates.", (0.02, 0.01)
        )
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    inner_radius: float = quantity(0.1, "m", "radius r of the cylinder", gt=0)
    outer_radius: float = quantity(0.2, "m", "radius R of the drum", gt=0)
    amplitude: float = quantity(
        Derived("inner_radius / 20", lambda case: case.inner_radius / 20.0), "m", "amplitude a of the oscillation", gt=0
    )
    angular_frequency: float = quantity(8.0, "rad s-1", "angular frequency omega", gt=0)
    gravity: float = downward_gravity(0.0)
    sound_speed: float | None = with_default(
        Case,
        "sound_speed",
        Derived("12 omega inner_radius", lambda case: 12.0 * case.angular_frequency * case.inner_radius),
    )
    background_pressure: float = quantity(
        Derived("four times rho a omega^2 R", lambda case: 4.0 * case.pressure_scale), "Pa", "pressure at rest"
    )
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("inner_radius / 10", lambda case: case.inner_radius / 10.0)
    )
    until: float = with_default(Case, "until", Derived("3 periods", lambda case: 3.0 * case.period))
    frame_interval: float = with_default(
        Case, "frame_interval", Derived("period / 10", lambda case: case.period / 10.0)
    )
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("period / 200", lambda case: case.period / 200.0)
    )

    @property
    def period(self) -> float:
        """Period of the oscillation, s."""
        return 2.0 * math.pi / self.angular_frequency

    @property
    def pressure_scale(self) -> float:
        """Rho a omega^2 R, Pa."""
        return self.reference_density * self.amplitude * self.angular_frequency**2 * self.outer_radius

    def motion(self) -> Oscillating:
        """Return the body that carries the cylinder."""
        return Oscillating(self.amplitude, self.angular_frequency)

    def scene(self) -> Scene:
        """Draw cylinder and drum."""
        if not self.inner_radius + self.amplitude < self.outer_radius:
            raise InputError("the cylinder must have room in the drum: give a larger outer_radius")
        inner, outer = (Circle(centre=(0, 0), radius=r) for r in (self.inner_radius, self.outer_radius))
        reach, pressure = 1.2 * self.outer_radius, self.background_pressure
        return Scene(
            walls=(
                CircleWall(name="inner", centre=(0, 0), radius=self.inner_radius, body="cylinder"),
                CircleWall(name="outer", centre=(0, 0), radius=self.outer_radius),
            ),
            fluid=(DifferenceRegion(of=outer, minus=(inner,)),),
            depth=2.0 * self.outer_radius,
            domain=((-reach, -reach), (reach, reach)),
            bodies={"cylinder": self.motion()},
            initial_pressure=lambda position: np.full(len(position), pressure),
        )

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the forces on ``inner`` and ``outer`` wall over time."""
        acceleration = np.array([self.motion().along_x(t)[2] for t in dataset["probe_time"].values])
        one, two = self.inner_radius**2, self.outer_radius**2
        scale = self.reference_density * math.pi * one * acceleration
        return xr.Dataset(
            {
                "inner_force": variable(
                    "probe_time", -(two + one) / (two - one) * scale, "N m-1", "force on the cylinder"
                ),
                "outer_force": variable("probe_time", 2.0 * two / (two - one) * scale, "N m-1", "force on the drum"),
            },
            coords={"probe_time": sample_times(dataset)},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        force = dataset["wall_force"].sel(space="x")
        return self.exact(dataset).assign(
            {f"{name}_force": ("probe_time", force.sel(wall=name).values) for name in ("inner", "outer")}
        )

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of the added masses, after the first period."""
        t = dataset["probe_time"].values
        later = t >= self.period
        if t[-1] < 1.5 * self.period:
            return {}
        motion = np.array([self.motion().along_x(time)[:0:-1] for time in t[later]])
        waves = np.column_stack([motion, np.ones(len(motion))])
        exact, run = self.exact(dataset), self.measured(dataset)

        def fit(values: Array) -> Array:
            return np.asarray(np.linalg.lstsq(waves, values[later], rcond=None)[0])

        found = {name: fit(run[name].values) for name in ("inner_force", "outer_force")}
        masses = {name: value[0] / fit(exact[name].values)[0] - 1.0 for name, value in found.items()}
        inner = found["inner_force"]
        return {f"added_mass_{name.removesuffix('_force')}": abs(float(value)) for name, value in masses.items()} | {
            "quadrature": abs(float(inner[1] / (inner[0] * self.angular_frequency)))
        }
