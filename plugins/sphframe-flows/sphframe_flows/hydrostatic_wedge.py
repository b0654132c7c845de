"""Still water above a wedge on the bed."""

from collections.abc import Mapping
from typing import ClassVar, Literal

import numpy as np
import xarray as xr

from sphframe import Case, InputError
from sphframe.cases import Benchmark, Derived, ExactCase, Scene, WallPart, downward_gravity, quantity, with_default
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe_flows.solutions import sample_times, variable


class HydrostaticWedge(ExactCase):
    """Still water above a wedge that stands on the bed of a tank: straight walls across the lattice, and sharp corners.

    Parts of the wall ``tank``: ``wedge``, on which the water presses down by rho g b (2 d - a) per metre of width, with
    the half base b and the height a, and its ``left`` face, with the horizontal force rho g (d^2 - (d - a)^2) / 2.
    The forces are integrals of the pressure, since ghosts in corners act for two faces.
    ``errors``: RMS of the particles' pressure over rho g d in the last frame, of the two forces (means over the second
    half of the run), relative, and ``kinetic_energy``, over the mean potential energy rho g d / 2 per volume.

    Source: A. English et al. (2022), doi:10.1007/s40571-021-00403-3.
    """

    title: ClassVar[str] = "still water above a wedge"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "hydrostatic-wedge": Benchmark(
            "pressure",
            "Pressure at slopes across the lattice, and at sharp corners.",
            (0.04, 0.02),
            {"tank_length": 1.2, "until": 1.0, "guards": {"filling": "report"}},
        )
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    gravity: float = downward_gravity()
    depth: float = quantity(0.5, "m", "depth d of the water", gt=0)
    tank_length: float = quantity(2.4, "m", "length of the tank", gt=0)
    wedge_height: float = quantity(0.24, "m", "height a of the wedge's apex", gt=0)
    half_base: float = quantity(0.27733, "m", "half b of the wedge's base", gt=0)
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("depth / 25", lambda case: case.depth / 25.0)
    )
    until: float = with_default(Case, "until", 2.0)
    frame_interval: float = with_default(Case, "frame_interval", 0.1)
    probe_interval: float = with_default(Case, "probe_interval", 0.005)

    def scene(self) -> Scene:
        """Draw the tank with its wedge."""
        length, depth, apex, half = self.tank_length, self.depth, self.wedge_height, self.half_base
        if not (apex < depth and half < 0.5 * length):
            raise InputError("the wedge must be lower than the water is deep, and its base shorter than the tank")
        middle, height = 0.5 * length, 1.5 * depth
        bed = ((0.0, 0.0), (middle - half, 0.0), (middle, apex), (middle + half, 0.0), (length, 0.0))
        margin = 0.01 * self.particle_spacing
        foot, top = -margin, apex + margin
        return Scene(
            walls=(PolygonWall(name="tank", points=((0.0, height), *bed, (length, height))),),
            fluid=(PolygonRegion(points=(*bed, (length, depth), (0.0, depth))),),
            depth=depth,
            domain=((-0.1 * depth, -0.1 * depth), (length + 0.1 * depth, 2.0 * height)),
            wall_parts=(
                WallPart(name="left", wall="tank", lower=(middle - half, foot), upper=(middle, top)),
                WallPart(name="wedge", wall="tank", lower=(middle - half, foot), upper=(middle + half, top)),
            ),
        )

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the ``pressure`` at rest at the heights of the particles, and both forces."""
        depth, apex, c2 = self.depth, self.wedge_height, self.reference_sound_speed(self.depth) ** 2
        weight = self.reference_density * self.gravity
        y = dataset["position"].isel(time=-1, space=1).values
        pressure = self.reference_density * c2 * np.expm1(self.gravity * np.maximum(depth - y, 0.0) / c2)
        ones = np.ones(dataset.sizes["probe_time"])
        down, across = -weight * self.half_base * (2.0 * depth - apex), 0.5 * weight * (depth**2 - (depth - apex) ** 2)
        return xr.Dataset(
            {
                "pressure": variable("y", pressure, "Pa", "pressure"),
                "downward_force": variable("probe_time", down * ones, "N m-1", "vertical force on the wedge"),
                "horizontal_force": variable("probe_time", across * ones, "N m-1", "horizontal force on its left face"),
            },
            coords={"y": variable("y", y, "m", "height"), "probe_time": sample_times(dataset)},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        force = dataset["part_force_by_pressure"]
        down, across = force.sel(part="wedge", space="y").values, force.sel(part="left", space="x").values
        return self.exact(dataset).assign(
            pressure=variable("y", dataset["pressure"].isel(time=-1).values, "Pa", "pressure"),
            downward_force=variable("probe_time", down, "N m-1", "vertical force on the wedge"),
            horizontal_force=variable("probe_time", across, "N m-1", "horizontal force on its left face"),
        )

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of pressure and forces, and the kinetic energy."""
        exact, run = self.exact(dataset), self.measured(dataset)
        scale = self.reference_density * self.gravity * self.depth
        result = {"pressure": float(np.sqrt(((run["pressure"] - exact["pressure"]) ** 2).mean())) / scale}
        later = slice(dataset.sizes["probe_time"] // 2, None)
        for name in ("downward_force", "horizontal_force"):
            result[name] = abs(float((run[name] / exact[name]).isel(probe_time=later).mean()) - 1.0)
        volume = float(dataset["mass"][0]) / self.reference_density
        result["kinetic_energy"] = float(dataset["kinetic_energy"][-1]) / (0.5 * scale * volume)
        return result
