"""A jet that meets a plate at an angle."""

import math
from collections.abc import Mapping
from typing import ClassVar, final

import numpy as np
import xarray as xr

from sphframe import Array
from sphframe.cases import Benchmark, Scene, quantity
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe_flows.jet_on_plate import JetOnPlate
from sphframe_flows.solutions import sample_times, variable


@final
class ObliqueJet(JetOnPlate):
    """A plane jet of width b and speed U that meets a plate at an angle, without gravity; it comes from the left.

    It splits into sheets of the widths b (1 + cos angle) / 2 to the right, and b (1 - cos angle) / 2 to the left, and
    the wall ``plate`` is pushed by rho U^2 b sin angle per metre. ``errors``: ``force``, the mean in the steady time,
    relative; ``split``, of the share of the flow that goes right through x = 2 b, of all that goes through |x| = 2 b.

    Source: G. K. Batchelor, An Introduction to Fluid Dynamics (1967), section 6.3.
    """

    title: ClassVar[str] = "jet on a plate at an angle"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "oblique-jet": Benchmark("split", "How a wall splits a flow: any friction of the wall shows.", (0.01, 0.00625))
    }

    angle: float = quantity(45.0, "degree", "angle between jet and plate", ge=40, lt=90)

    def scene(self) -> Scene:
        """Draw the plate and the jet above it."""
        plain = super().scene()
        along, up = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        half = 0.5 * self.width / up
        back = (-along * self.length, up * self.length)
        wall = plain.walls[0]
        assert isinstance(wall, PolygonWall)
        return Scene(
            walls=plain.walls,
            fluid=(
                PolygonRegion(
                    points=((-half, 0), (half, 0), (half + back[0], back[1]), (-half + back[0], back[1])),
                    velocity=(along * self.speed, -up * self.speed),
                    pressure=0.0,
                ),
            ),
            depth=self.width,
            domain=plain.domain,
        )

    @property
    def right_share(self) -> float:
        """Share of the flow that goes to the right."""
        return 0.5 * (1.0 + math.cos(math.radians(self.angle)))

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the ``force`` on the plate, and the mass per metre that has gone ``right`` and ``left``."""
        force = -2.0 * self.dynamic_pressure * self.width * math.sin(math.radians(self.angle))
        t = dataset["time"].values
        rate = self.reference_density * self.speed * self.width
        start = self._steady_frames(dataset)[0]
        right, left = (self._gone(dataset, side)[start] for side in (1.0, -1.0))
        since = rate * (t - t[start])
        return xr.Dataset(
            {
                "force": variable("probe_time", np.full(dataset.sizes["probe_time"], force), "N m-1", "force"),
                "right": variable("time", right + self.right_share * since, "kg m-1", "mass gone right"),
                "left": variable("time", left + (1.0 - self.right_share) * since, "kg m-1", "mass gone left"),
            },
            coords={"time": variable("time", t, "s", "time"), "probe_time": sample_times(dataset)},
        )

    def _gone(self, dataset: xr.Dataset, side: float) -> Array:
        """Return the mass (frames,) of the sheet beyond two widths of the jet on one side, kg per metre."""
        x, y = (dataset["position"].isel(space=axis).values for axis in (0, 1))
        beyond = (side * x > 2.0 * self.width) & (y < self.width)
        return np.asarray(float(dataset["mass"][0]) * beyond.mean(axis=-1))

    def _steady_frames(self, dataset: xr.Dataset) -> tuple[int, int]:
        """Return the first and the last frame of the steady flow through both places."""
        t = dataset["time"].values
        return min(int(np.searchsorted(t, 4.0 * self.width / self.speed)), len(t) - 1), len(t) - 1

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        return self.exact(dataset).assign(
            force=variable("probe_time", dataset["wall_force"].isel(wall=0, space=1).values, "N m-1", "force"),
            right=variable("time", self._gone(dataset, 1.0), "kg m-1", "mass gone right"),
            left=variable("time", self._gone(dataset, -1.0), "kg m-1", "mass gone left"),
        )

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of the force and of the split."""
        exact, run = self.exact(dataset), self.measured(dataset)
        force = run["force"].values[self._steady(dataset)].mean() / exact["force"].values[0]
        start, end = self._steady_frames(dataset)
        right, left = (float(run[name][end] - run[name][start]) for name in ("right", "left"))
        result = {"force": abs(float(force) - 1.0)}
        if right + left > 0.0:
            result["split"] = abs(right / (right + left) - self.right_share)
        return result
