"""Slow flow through a square array of cylinders."""

import math
from collections.abc import Mapping
from typing import ClassVar, Literal, final

import numpy as np
import xarray as xr

from sphframe import Case, InputError
from sphframe.cases import Benchmark, Component, Derived, ExactCase, Scene, downward_gravity, quantity, with_default
from sphframe.geometry import Box, Circle, CircleWall, DifferenceRegion
from sphframe_flows.solutions import late_mean, sample_times, variable

_DRAG = {0.05: 15.558, 0.1: 24.832, 0.2: 51.527, 0.3: 102.88, 0.4: 217.89, 0.5: 532.55}
"""drag factor of a cylinder by the share of the area that the cylinders take"""


@final
class CylinderArray(ExactCase):
    """Slow flow through a square array of cylinders at the distance L, of which one period is simulated, driven by f.

    The force on the wall ``cylinder`` per metre is F = rho f L^2 (1 - c), with the share c of the area that cylinders
    take. A pressure gradient rho f in place of the body force adds rho f L^2 c, its force on the cylinder's area. The
    drag factor rho f L^2 / (mu U) = F / [(1 - c) mu U], with the mean velocity U over the whole square, is a function
    of c alone. It was computed for this project by collocation of the biharmonic series, and agrees with Sangani and
    Acrivos.

    ``errors``: ``drag_factor`` and ``force``, of means over the last fifth of the run, relative.

    Source: A. S. Sangani, A. Acrivos (1982), doi:10.1016/0301-9322(82)90029-5.
    """

    title: ClassVar[str] = "slow flow through an array of cylinders"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "cylinder-array": Benchmark("drag_factor", "Drag of a curved wall with no slip in slow flow.", (0.05, 0.025))
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    distance: float = quantity(1.0, "m", "distance L of the cylinders", gt=0)
    solid_share: float = quantity(0.2, "1", "share c of the area within cylinders: 0.05, 0.1, 0.2, 0.3, 0.4 or 0.5")
    reynolds_number: float = quantity(0.05, "1", "Reynolds number U L / nu", gt=0)
    periodic: tuple[Literal["x", "y", "z"], ...] = with_default(Case, "periodic", ("x", "y"))
    gravity: float = downward_gravity(0.0)
    kinematic_viscosity: float = with_default(Case, "kinematic_viscosity", 0.1)
    viscosity_model: Literal["morris", "monaghan-gingold"] = with_default(Case, "viscosity_model", "morris")
    artificial_viscosity: float = with_default(Case, "artificial_viscosity", 0.0)
    acceleration: Component = with_default(
        Case,
        "acceleration",
        Derived(
            "that of the Reynolds number, along x",
            lambda case: Component(name="uniform", options={"vector": (case.body_force, 0)}),
        ),
    )
    slip: Literal["free", "no"] = with_default(Case, "slip", "no")
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "free")
    sound_speed: float | None = with_default(
        Case, "sound_speed", Derived("larger of 20 U and 5 sqrt(f L)", lambda case: case.fastest)
    )
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("distance / 40", lambda case: case.distance / 40.0)
    )
    until: float = with_default(
        Case, "until", Derived("0.2 L^2 / nu", lambda case: 0.2 * case.distance**2 / case.kinematic_viscosity)
    )
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 20", lambda case: case.until / 20.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("until / 500", lambda case: case.until / 500.0)
    )

    @property
    def mean_velocity(self) -> float:
        """U, m/s."""
        return self.reynolds_number * self.kinematic_viscosity / self.distance

    @property
    def body_force(self) -> float:
        """The body force f that drives U, m/s^2."""
        factor = _DRAG.get(self.solid_share, math.nan)
        return factor * self.kinematic_viscosity * self.mean_velocity / self.distance**2

    @property
    def fastest(self) -> float:
        """Sound speed, m/s, with which the density varies by less than four per cent."""
        return max(20.0 * self.mean_velocity, 5.0 * math.sqrt(self.body_force * self.distance))

    def scene(self) -> Scene:
        """Draw a period of the array."""
        if self.solid_share not in _DRAG or self.kinematic_viscosity == 0.0 or self.periodic != ("x", "y"):
            raise InputError(
                f"an array of cylinders needs a solid_share of {', '.join(map(str, _DRAG))}, a kinematic_viscosity, and"
                ' periodic = ["x", "y"]'
            )
        side, half = self.distance, 0.5 * self.distance
        radius = side * math.sqrt(self.solid_share / math.pi)
        circle = Circle(centre=(half, half), radius=radius)
        return Scene(
            walls=(CircleWall(name="cylinder", centre=(half, half), radius=radius),),
            fluid=(DifferenceRegion(of=Box(lower=(0, 0), upper=(side, side)), minus=(circle,)),),
            depth=side,
            domain=((0.0, 0.0), (side, side)),
            initial_pressure=lambda position: np.zeros(len(position)),
        )

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the mean velocity and the force on the cylinder at the end of the start-up."""
        ones = np.ones(dataset.sizes["time"])
        force = self.reference_density * self.body_force * self.distance**2 * (1.0 - self.solid_share)
        samples = np.ones(dataset.sizes["probe_time"])
        return xr.Dataset(
            {
                "mean_velocity": variable("time", self.mean_velocity * ones, "m s-1", "mean velocity"),
                "force": variable("probe_time", force * samples, "N m-1", "force on the cylinder"),
            },
            coords={"time": variable("time", dataset["time"].values, "s", "time"), "probe_time": sample_times(dataset)},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        flux = (dataset["velocity"].isel(space=0) * dataset["particle_mass"]).sum("particle").values
        exact = self.exact(dataset)
        return exact.assign(
            mean_velocity=(("time",), flux / (self.reference_density * self.distance**2), exact["mean_velocity"].attrs),
            force=(("probe_time",), dataset["wall_force"].sel(wall="cylinder", space="x").values, exact["force"].attrs),
        )

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of drag factor and force."""
        exact, run = self.exact(dataset), self.measured(dataset)
        ratio = {name: late_mean(run[name]) / float(exact[name][-1]) for name in ("mean_velocity", "force")}
        return {"drag_factor": abs(ratio["force"] / ratio["mean_velocity"] - 1.0), "force": abs(ratio["force"] - 1.0)}
