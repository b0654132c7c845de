"""A jet that meets a plate."""

import math
from collections.abc import Mapping
from typing import ClassVar, Literal

import numpy as np
import xarray as xr

from sphframe import Array, Case, InputError
from sphframe.cases import Benchmark, Derived, ExactCase, Probe, Scene, downward_gravity, quantity, with_default
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe_flows.solutions import sample_times, variable

_PROBES = 16


class JetOnPlate(ExactCase):
    """A plane jet of width b and speed U that meets a plate at right angles, without gravity.

    The jet starts in contact with the plate and is ``length`` long; from 2 b / U on the flow near the plate is steady
    as long as the jet lasts. The force on the wall ``plate`` is rho U^2 b per metre, and with 0 <= q < 1::

        p = rho U^2 / 2 (1 - q^2)    at    x = b / pi [ln((1 + q) / (1 - q)) + 2 arctan q]

    The probes P0, P1, ... lie from the middle to x = 1.5 b. ``errors``: of the mean force in the steady time,
    relative, and RMS of the mean pressure at the probes over rho U^2 / 2.

    Source: G. K. Batchelor, An Introduction to Fluid Dynamics (1967), section 6.3, by conformal mapping.
    """

    title: ClassVar[str] = "jet on a plate"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "jet-on-plate": Benchmark("force", "Force of a steady flow that a wall turns aside.", (0.01, 0.00625))
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    gravity: float = downward_gravity(0.0)
    width: float = quantity(0.1, "m", "width b of the jet", gt=0)
    speed: float = quantity(1.0, "m s-1", "speed U of the jet", gt=0)
    length: float = quantity(1.0, "m", "length of the jet", gt=0)
    sound_speed: float | None = with_default(Case, "sound_speed", Derived("20 speed", lambda case: 20.0 * case.speed))
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("width / 10", lambda case: case.width / 10.0)
    )
    until: float = with_default(
        Case, "until", Derived("0.7 length / speed", lambda case: 0.7 * case.length / case.speed)
    )
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 20", lambda case: case.until / 20.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("until / 1000", lambda case: case.until / 1000.0)
    )

    @property
    def dynamic_pressure(self) -> float:
        """Rho U^2 / 2, Pa."""
        return 0.5 * self.reference_density * self.speed**2

    def scene(self) -> Scene:
        """Draw the plate and the jet above it."""
        if self.until < 3.0 * self.width / self.speed:
            raise InputError(f"until = {self.until:g} s ends before the flow is steady; give 3 width / speed or more")
        half, end = 0.5 * self.width, 1.3 * self.speed * self.until + 2.0 * self.width
        high = 1.5 * self.length
        return Scene(
            walls=(PolygonWall(name="plate", points=((-end, high), (-end, 0.0), (end, 0.0), (end, high))),),
            fluid=(
                PolygonRegion(
                    points=((-half, 0.0), (half, 0.0), (half, self.length), (-half, self.length)),
                    velocity=(0.0, -self.speed),
                    pressure=0.0,
                ),
            ),
            depth=self.width,
            domain=((-1.1 * end, -self.width), (1.1 * end, 2.0 * high)),
            probes=tuple(Probe(name=f"P{i}", position=(float(x), 0.0)) for i, x in enumerate(self._places())),
        )

    def _places(self) -> Array:
        return np.linspace(0.0, 1.5 * self.width, _PROBES)

    def pressure(self, x: Array) -> Array:
        """Return the pressure (n,), Pa, on the plate at the distances ``x`` (n,), m, from the middle."""
        q = 1.0 - np.logspace(0.0, -12.0, 4001)
        place = (np.log((1.0 + q) / (1.0 - q)) + 2.0 * np.arctan(q)) * self.width / math.pi
        return np.asarray(self.dynamic_pressure * (1.0 - np.interp(np.abs(x), place, q) ** 2))

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the ``force`` on the plate over time and the ``pressure`` at the probes."""
        force = -2.0 * self.dynamic_pressure * self.width * np.ones(dataset.sizes["probe_time"])
        return xr.Dataset(
            {
                "force": variable("probe_time", force, "N m-1", "force on the plate"),
                "pressure": variable("x", self.pressure(self._places()), "Pa", "mean pressure on the plate"),
            },
            coords={"probe_time": sample_times(dataset), "x": variable("x", self._places(), "m", "x")},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run; the pressure is the mean over the steady time."""
        pressure = dataset["probe_pressure"].values[self._steady(dataset)].mean(axis=0)
        force = dataset["wall_force"].isel(wall=0, space=1).values
        return self.exact(dataset).assign(
            force=variable("probe_time", force, "N m-1", "force on the plate"),
            pressure=variable("x", pressure, "Pa", "mean pressure on the plate"),
        )

    def _steady(self, dataset: xr.Dataset) -> Array:
        """Return which samples (n,) are of the steady time; the last one in any case."""
        t = dataset["probe_time"].values
        return np.asarray(t >= min(2.0 * self.width / self.speed, t[-1]))

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of force and pressure."""
        exact, run = self.exact(dataset), self.measured(dataset)
        force = run["force"].values[self._steady(dataset)].mean() / exact["force"].values[0]
        rms = float(np.sqrt(((run["pressure"] - exact["pressure"]) ** 2).mean()))
        return {"force": abs(float(force) - 1.0), "pressure": rms / self.dynamic_pressure}
