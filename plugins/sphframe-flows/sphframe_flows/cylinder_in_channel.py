"""Viscous flow around a cylinder between two walls."""

import math
from collections.abc import Mapping
from typing import ClassVar, Literal, final

import numpy as np
import xarray as xr

from sphframe import Array, Case, InputError
from sphframe.cases import Benchmark, Derived, OpenBoundaries, Probe, Scene, quantity, with_default, zone_length
from sphframe.geometry import Box, Circle, CircleWall, DifferenceRegion, PolygonWall
from sphframe_flows.confined import ConfinedFlow
from sphframe_flows.solutions import late_mean, sample_times, variable

_DRAG, _LIFT, _PRESSURE = 5.579535, 0.010619, 0.117520 / 0.04
"""coefficients of drag and lift, and the pressure difference over rho U^2, at a Reynolds number of 20"""


@final
class CylinderInChannel(ConfinedFlow):
    """A cylinder of diameter D in a channel from an inflow, whose profile is a parabola, to an outflow, with no slip.

    By default this is the stationary flow 2D-1 of Schaefer and Turek at the Reynolds number U D / nu = 20, with the
    mean velocity U: the channel is 22 D long and 4.1 D wide, the centre of the cylinder is 2 D from the inflow and from
    the bed. ``exact`` are the force on the wall ``cylinder`` and the difference of the pressures at its front and at
    its back, as computed by others to six digits; with another width, position or Reynolds number there is none, and no
    error. The coefficients of the forces are 2 F / (rho U^2 D). The lift is 0.2 % of the drag.

    The flow starts with a stream function that is that of the parabola away from the cylinder, and constant to first
    order at its surface, so that no wave starts there. ``errors`` are of means over the last fifth of the run:
    ``drag``, ``pressure_difference``, relative, and ``lift``, over the drag.

    Source: M. Schaefer, S. Turek (1996), doi:10.1007/978-3-322-89849-4_39.
    """

    title: ClassVar[str] = "flow around a cylinder in a channel"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "cylinder-in-channel": Benchmark(
            "drag",
            "Drag of a curved wall with no slip at a finite Reynolds number, between open ends.",
            (0.01, 0.005),
            {"channel_length": 0.6, "until": 1.2},
        )
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    diameter: float = quantity(0.1, "m", "diameter D of the cylinder", gt=0)
    mean_velocity: float = quantity(0.2, "m s-1", "mean velocity U of the inflow", gt=0)
    reynolds_number: float = quantity(20.0, "1", "Reynolds number U D / nu", gt=0)
    channel_width: float = quantity(
        Derived("4.1 diameter", lambda case: 4.1 * case.diameter), "m", "distance of the walls", gt=0
    )
    channel_length: float = quantity(
        Derived("22 diameter", lambda case: 22.0 * case.diameter), "m", "length from inflow to outflow", gt=0
    )
    centre_distance: float = quantity(
        Derived("2 diameter", lambda case: 2.0 * case.diameter), "m", "distance of the centre from the inflow", gt=0
    )
    centre_height: float = quantity(
        Derived("2 diameter", lambda case: 2.0 * case.diameter), "m", "height of the centre above the bed", gt=0
    )
    open_boundaries: OpenBoundaries | None = with_default(
        Case,
        "open_boundaries",
        Derived(
            "a parabola of the mean velocity, and the pressure 5 rho U^2 at the outflow",
            lambda case: OpenBoundaries(
                velocity=1.5 * case.mean_velocity,
                profile="parabola",
                pressure=5.0 * case.reference_density * case.mean_velocity**2,
            ),
        ),
    )
    kinematic_viscosity: float = with_default(
        Case,
        "kinematic_viscosity",
        Derived("U D / reynolds_number", lambda case: case.mean_velocity * case.diameter / case.reynolds_number),
    )
    sound_speed: float | None = with_default(
        Case, "sound_speed", Derived("20 mean_velocity", lambda case: 20.0 * case.mean_velocity)
    )
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("diameter / 10", lambda case: case.diameter / 10.0)
    )
    until: float = with_default(
        Case, "until", Derived("5 D / U", lambda case: 5.0 * case.diameter / case.mean_velocity)
    )
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 20", lambda case: case.until / 20.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("until / 500", lambda case: case.until / 500.0)
    )

    def scene(self) -> Scene:
        """Draw channel and cylinder."""
        width, length, radius = self.channel_width, self.channel_length, 0.5 * self.diameter
        x, y = self.centre_distance, self.centre_height
        if self._gap <= 0.0 or x + radius >= length:
            raise InputError("the cylinder must lie between bed, lid, inflow and outflow: change diameter or centre")
        if self.open_boundaries is None or self.kinematic_viscosity == 0.0:
            raise InputError("the flow around a cylinder needs open_boundaries and a kinematic_viscosity")
        support = self.kernel.create("kernels").support * self.smoothing_length_ratio * self.particle_spacing
        zone = zone_length(self.particle_spacing, support)
        beyond = (-2.0 * zone, length + 2.0 * zone)
        gradient = 12.0 * self.reference_density * self.kinematic_viscosity * self.mean_velocity / width**2
        outflow = self.open_boundaries.pressure or 0.0
        circle = Circle(centre=(x, y), radius=radius)
        return Scene(
            walls=(
                PolygonWall(name="bed", points=((beyond[0], 0.0), (beyond[1], 0.0))),
                PolygonWall(name="lid", points=((beyond[0], width), (beyond[1], width)), one_sided=True),
                CircleWall(name="cylinder", centre=(x, y), radius=radius),
            ),
            fluid=(DifferenceRegion(of=Box(lower=(-zone, 0.0), upper=(length + zone, width)), minus=(circle,)),),
            depth=width,
            domain=((beyond[0], -0.5 * width), (beyond[1], 1.5 * width)),
            probes=(Probe(name="front", position=(x - radius, y)), Probe(name="back", position=(x + radius, y))),
            initial_pressure=lambda position: outflow + gradient * (length - position[:, 0]),
            initial_velocity=self.initial_velocity,
        )

    @property
    def _gap(self) -> float:
        """Smallest distance between the cylinder and bed, lid or inflow, m."""
        nearest = min(self.centre_height, self.channel_width - self.centre_height, self.centre_distance)
        return nearest - 0.5 * self.diameter

    def initial_velocity(self, position: Array) -> Array:
        """Return the velocity (n, 2) at the start at ``position`` (n, 2), m/s.

        Its stream function is psi_c + (psi - psi_c) s(d), with that of the parabola psi, psi_c at the centre of the
        cylinder, the distance d to it over the gap, and s = d^2 (3 - 2 d) up to 1.
        """
        width, gap, highest = self.channel_width, self._gap, 1.5 * self.mean_velocity

        def stream(y: Array | float) -> Array | float:
            return highest * (2.0 * y**2 / width - 4.0 * y**3 / (3.0 * width**2))

        away = position - [self.centre_distance, self.centre_height]
        distance = np.linalg.norm(away, axis=1)
        d = np.clip((distance - 0.5 * self.diameter) / gap, 0.0, 1.0)
        y = position[:, 1]
        parabola = 4.0 * highest * y * (width - y) / width**2
        turning = (stream(y) - stream(self.centre_height)) * 6.0 * d * (1.0 - d) / (gap * distance)
        u = parabola * d**2 * (3.0 - 2.0 * d) + turning * away[:, 1]
        return np.column_stack([u, -turning * away[:, 0]])

    @property
    def _is_published(self) -> bool:
        """Whether the flow is that of the benchmark."""
        given = (self.reynolds_number, self.channel_width, self.centre_distance, self.centre_height)
        diameter = self.diameter
        expected = (20.0, 4.1 * diameter, 2.0 * diameter, 2.0 * diameter)
        return all(math.isclose(one, other, rel_tol=1e-9) for one, other in zip(given, expected, strict=True))

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the published ``drag``, ``lift`` and ``pressure_difference``."""
        if not self._is_published:
            return xr.Dataset()
        ones = np.ones(dataset.sizes["probe_time"])
        pressure = self.reference_density * self.mean_velocity**2
        force = 0.5 * pressure * self.diameter
        return xr.Dataset(
            {
                "drag": variable("probe_time", _DRAG * force * ones, "N m-1", "drag"),
                "lift": variable("probe_time", _LIFT * force * ones, "N m-1", "lift"),
                "pressure_difference": variable(
                    "probe_time", _PRESSURE * pressure * ones, "Pa", "pressure difference, front to back"
                ),
            },
            coords={"probe_time": sample_times(dataset)},
            attrs={"label": "computed by Schaefer and Turek (1996)"},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        exact = self.exact(dataset)
        force, pressure = dataset["wall_force"].sel(wall="cylinder"), dataset["probe_pressure"]
        found = {
            "drag": force.sel(space="x"),
            "lift": force.sel(space="y"),
            "pressure_difference": pressure.sel(probe="front") - pressure.sel(probe="back"),
        }
        return exact.assign({name: (("probe_time",), found[str(name)].values, exact[name].attrs) for name in exact})

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of means over the last fifth of the run."""
        exact, run = self.exact(dataset), self.measured(dataset)
        scale = {name: "drag" if name == "lift" else name for name in map(str, exact)}
        return {
            name: abs(late_mean(run[name]) - float(exact[name][0])) / float(exact[over][0])
            for name, over in scale.items()
        }
