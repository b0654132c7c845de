"""Fluid that meets a wall, or leaves it, all at once."""

import math
from collections.abc import Mapping
from typing import ClassVar, Literal, final

import numpy as np
import xarray as xr

from sphframe import Case
from sphframe.cases import Benchmark, Derived, ExactCase, Scene, WallPart, downward_gravity, quantity, with_default
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe_flows.solutions import sample_times, variable


@final
class ColumnImpact(ExactCase):
    """A column of length L between two walls with free slip meets a plate with the speed U, without gravity.

    The flow has one dimension. A shock runs through the column, and the wall ``channel`` feels, on its part ``plate``,
    the pressure p until the shock has returned from the free end at about 2 L / c; then the fluid rebounds::

        p = rho U [U + sqrt(U^2 + 4 c^2)] / 2

    ``errors``: ``plateau``, of the mean pressure between 0.3 and 1.7 L / c, relative; ``overshoot``, of the largest
    pressure; ``suction``, the mean magnitude of the pressure after 2.4 L / c, over p: zero where walls do not pull.

    Source: Rankine-Hugoniot conditions of the linear equation of state.
    """

    title: ClassVar[str] = "impact of a column on a plate"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "column-impact": Benchmark("plateau", "The pressure of a shock on a wall, and the rebound.", (0.04, 0.02))
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    gravity: float = downward_gravity(0.0)
    length: float = quantity(1.0, "m", "length L of the column", gt=0)
    width: float = quantity(0.2, "m", "width of the column", gt=0)
    speed: float = quantity(1.0, "m s-1", "speed U of the column", gt=0)
    sound_speed: float | None = with_default(Case, "sound_speed", Derived("50 speed", lambda case: 50.0 * case.speed))
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "none")
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("width / 10", lambda case: case.width / 10.0)
    )
    until: float = with_default(Case, "until", Derived("3 L / c", lambda case: 3.0 * case.crossing))
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 20", lambda case: case.until / 20.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("L / c / 200", lambda case: case.crossing / 200.0)
    )

    @property
    def crossing(self) -> float:
        """The time L / c, s."""
        return self.length / self.reference_sound_speed(self.length)

    @property
    def shock_pressure(self) -> float:
        """The pressure p on the plate, Pa."""
        speed, c = self.speed, self.reference_sound_speed(self.length)
        return 0.5 * self.reference_density * speed * (speed + math.sqrt(speed**2 + 4.0 * c**2))

    def scene(self) -> Scene:
        """Draw the channel and the column in it."""
        length, width = self.length, self.width
        far, margin = 2.0 * length, 0.01 * self.particle_spacing
        return Scene(
            walls=(PolygonWall(name="channel", points=((far, 0), (0, 0), (0, width), (far, width))),),
            fluid=(
                PolygonRegion(
                    points=((0, 0), (length, 0), (length, width), (0, width)), velocity=(-self.speed, 0.0), pressure=0.0
                ),
            ),
            depth=length,
            domain=((-0.1 * length, -width), (far, 2.0 * width)),
            wall_parts=(
                WallPart(name="plate", wall="channel", lower=(-margin, margin), upper=(margin, width - margin)),
            ),
        )

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the ``pressure`` on the plate over time; unknown while the rebound begins."""
        t = dataset["probe_time"].values / self.crossing
        pressure = np.select([t <= 0.0, t < 1.7, t > 2.4], [np.nan, self.shock_pressure, 0.0], np.nan)
        return xr.Dataset(
            {"pressure": variable("probe_time", pressure, "Pa", "pressure on the plate")},
            coords={"probe_time": sample_times(dataset)},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        force = dataset["part_force_by_pressure"].sel(part="plate", space="x").values
        return self.exact(dataset).assign(
            pressure=variable("probe_time", np.abs(force) / self.width, "Pa", "pressure on the plate")
        )

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of the plateau, the overshoot and the suction."""
        t = dataset["probe_time"].values / self.crossing
        pressure = self.measured(dataset)["pressure"].values / self.shock_pressure
        result = {}
        if (plateau := (t > 0.3) & (t < 1.7)).any():
            result["plateau"] = abs(float(pressure[plateau].mean()) - 1.0)
            result["overshoot"] = max(float(pressure.max()) - 1.0, 0.0)
        if (later := t > 2.4).any():
            result["suction"] = float(pressure[later].mean())
        return result


@final
class CeilingRelease(ExactCase):
    """A block of water without pressure hangs under a ceiling, and is released: it falls freely.

    The centre of the block falls by g t^2 / 2, without a force on the ``ceiling``, and the block keeps its shape.
    ``errors``: ``fall``, of the centre in the last frame, over its fall; ``force``, the largest force on the ceiling
    over the weight of the block; ``shape``, the largest change of a particle's place in the block, over the spacing.
    """

    title: ClassVar[str] = "release of a block from a ceiling"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "ceiling-release": Benchmark("fall", "Tension: whether a wall holds fluid back.", (0.04, 0.02))
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    gravity: float = downward_gravity()
    width: float = quantity(0.4, "m", "width of the block", gt=0)
    height: float = quantity(0.4, "m", "height of the block", gt=0)
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "none")
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("width / 20", lambda case: case.width / 20.0)
    )
    until: float = with_default(
        Case,
        "until",
        Derived(
            "sqrt(20 spacings / gravity)",
            lambda case: math.sqrt(20.0 * case.particle_spacing / max(case.gravity, 1e-12)),
        ),
    )
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 20", lambda case: case.until / 20.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("until / 200", lambda case: case.until / 200.0)
    )

    def scene(self) -> Scene:
        """Draw the ceiling, y = 0, and the block below it."""
        half, high = 0.5 * self.width, self.height
        end, low = 3.0 * half, -2.0 * high - self.gravity * self.until**2
        return Scene(
            walls=(PolygonWall(name="ceiling", points=((-end, 0), (end, 0)), one_sided=True),),
            fluid=(PolygonRegion(points=((-half, -high), (half, -high), (half, 0), (-half, 0)), pressure=0.0),),
            depth=high,
            domain=((-1.2 * end, 1.1 * low), (1.2 * end, 0.2 * high)),
        )

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the height ``centre`` of the block's centre over the frames, and the ``force`` on the ceiling."""
        t = dataset["time"].values
        centre = -0.5 * self.height - 0.5 * self.gravity * t**2
        return xr.Dataset(
            {
                "centre": variable("time", centre, "m", "height of the centre"),
                "force": variable("probe_time", np.zeros(dataset.sizes["probe_time"]), "N m-1", "force on the ceiling"),
            },
            coords={"time": variable("time", t, "s", "time"), "probe_time": sample_times(dataset)},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        force = dataset["wall_force"].isel(wall=0, space=1).values
        return self.exact(dataset).assign(
            centre=variable(
                "time", dataset["position"].isel(space=1).mean("particle").values, "m", "height of the centre"
            ),
            force=variable("probe_time", force, "N m-1", "force on the ceiling"),
        )

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of the fall, and the force on the ceiling."""
        run, t = self.measured(dataset), float(dataset["time"][-1])
        if t == 0.0:
            return {}
        fall = 0.5 * self.gravity * t**2
        weight = self.reference_density * self.gravity * self.width * self.height
        last, first = (dataset["position"].isel(time=k).values for k in (-1, 0))
        moved = last - first
        shape = np.linalg.norm(moved - moved.mean(axis=0), axis=1).max()
        return {
            "fall": abs(float(run["centre"][-1] - run["centre"][0]) / -fall - 1.0),
            "force": float(np.abs(run["force"]).max()) / weight,
            "shape": float(shape) / self.particle_spacing,
        }
