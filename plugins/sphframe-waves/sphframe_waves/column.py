"""A solitary wave that runs past a round column, in three dimensions."""

import math
from typing import Any, ClassVar, Literal, final

import xarray as xr
from pydantic import TypeAdapter

from sphframe import Array, Case, InputError
from sphframe.analysis import running_mean
from sphframe.cases import Derived, ExactCase, Gauge, Scene, downward_gravity, quantity, with_default
from sphframe.geometry import Box, BoxWall, Cylinder, DifferenceRegion, Wall
from sphframe_waves.column_diffraction import ColumnDiffraction
from sphframe_waves.flume import SolitaryWaveFlume
from sphframe_waves.solitary_wave_paddle import SolitaryWavePaddle

_WALL: TypeAdapter[Any] = TypeAdapter(Wall)
_MEAN = 0.2
"""time over which forces are averaged before their extremes are compared, times wavenumber and speed"""


@final
class SolitaryWaveColumn(ExactCase):
    """A solitary wave runs past a round column that stands on the bed of a flume and rises above the water.

    The paddle starts at x = 0, or up to half a particle spacing from it, by the convention of
    :class:`sphframe_waves.SolitaryWavePaddle`; the column is in the middle of the flume. The flow is symmetric, so that
    only the half of the flume with y > 0 is simulated: its side walls, which have free slip, are the middle plane and
    the side wall of the flume. The force on the column in ``exact`` and ``measured``, ``column_force``, is that on the
    whole column: twice the x component of ``wall_force`` on the wall ``column``, less that in still water, which is not
    zero, since front and back of the half column share single ghosts with the middle plane in different ways.

    ``exact`` is linear theory, :class:`sphframe_waves.ColumnDiffraction`, for long waves in a channel as wide as the
    flume. It knows neither the end of the flume, whose reflection comes later than ``until`` by default, nor what is
    of second order in A / d. ``elevation`` is that at the gauge ``G1``, halfway to
    the column; the exact one is of the wave alone, without what the column reflects, which follows the crest.

    The smoothing length is 1.3 spacings. With 1.1, the default of other cases in 3-D, the lattice of particles gives
    way where the front of the wave has strained it, and the sound of that pushes the column more than the wave does.

    ``errors``: ``column_force`` and ``elevation`` are RMS differences over the largest exact values; ``push`` and
    ``pull`` are relative, of the largest force forwards and backwards as means over 0.2 / (k c), and ``wave_height``
    is that of the largest elevation.

    Source: M. de St Q. Isaacson (1983), doi:10.1061/(ASCE)0733-950X(1983)109:1(121), for the open sea.

    Examples
    --------
    The side walls of the flume change the largest forces by 0.6 and 4.6 % from those in the open sea:

    >>> from dataclasses import replace
    >>> import numpy as np
    >>> theory = SolitaryWaveColumn().diffraction()
    >>> [[round(float(pick(wave.force(np.linspace(-1, 1, 2001)))), 2) for pick in (np.max, np.min)]
    ...  for wave in (theory, replace(theory, width=np.inf))]
    [[19.14, -18.99], [19.03, -19.9]]
    """

    title: ClassVar[str] = "solitary wave past a round column, three-dimensional"

    dimension: Literal[3] = quantity(3, "1", "dimension of space")
    gravity: float = downward_gravity()
    depth: float = with_default(SolitaryWaveFlume, "depth", 0.25)
    wave_height: float = with_default(SolitaryWaveFlume, "wave_height", 0.0375)
    wave_theory: Literal["rayleigh", "boussinesq"] = quantity("rayleigh", "1", "theory of the paddle's motion")
    column_position: float = quantity(2.0, "m", "distance from the paddle at the start to the axis of the column", gt=0)
    column_radius: float = quantity(
        Derived("0.75 depth", lambda case: 0.75 * case.depth), "m", "radius a of the column", gt=0
    )
    flume_width: float = quantity(
        Derived("8 column_radius", lambda case: 8.0 * case.column_radius),
        "m",
        "width W of the flume, of which one half is simulated",
        gt=0,
    )
    flume_length: float = quantity(
        Derived("2 column_position", lambda case: 2.0 * case.column_position),
        "m",
        "distance from the paddle at the start to the end of the flume",
        gt=0,
    )
    tank_height: float = quantity(
        Derived("depth + 4 wave_height", lambda case: case.depth + 4.0 * case.wave_height),
        "m",
        "height of paddle, walls and column",
        gt=0,
    )
    sound_speed: float | None = with_default(
        Case,
        "sound_speed",
        Derived("10 sqrt(g depth)", lambda case: 10.0 * math.sqrt(max(case.gravity, 1e-12) * case.depth)),
    )
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("depth / 10", lambda case: case.depth / 10.0)
    )
    smoothing_length_ratio: float = with_default(Case, "smoothing_length_ratio", 1.3)
    until: float = with_default(
        Case,
        "until",
        Derived(
            "arrival at the column + 2 / (wavenumber speed)",
            lambda case: case.arrival_time() + 2.0 / (case.paddle().wavenumber * case.paddle().speed),
        ),
    )
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 20", lambda case: case.until / 20.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("until / 400", lambda case: case.until / 400.0)
    )

    def paddle(self) -> SolitaryWavePaddle:
        """Return the paddle, which computes the theoretical speed and time of arrival of the wave."""
        return SolitaryWavePaddle(
            wave_height=self.wave_height, depth=self.depth, theory=self.wave_theory, gravity=self.gravity
        )

    def arrival_time(self) -> float:
        """Return the time at which the crest would pass the axis of the column, s, at the speed of the theory."""
        return self.paddle().arrival_time(self.column_position)

    def diffraction(self) -> ColumnDiffraction:
        """Return the linear theory of the force on the column."""
        paddle = self.paddle()
        return ColumnDiffraction(
            wave_height=self.wave_height,
            wavenumber=paddle.wavenumber,
            speed=paddle.speed,
            depth=self.depth,
            radius=self.column_radius,
            width=self.flume_width,
            density=self.reference_density,
            gravity=self.gravity,
        )

    def scene(self) -> Scene:
        """Draw one half of the flume and of the column."""
        self._check_places()
        dx, length, height, half = self.particle_spacing, self.flume_length, self.tank_height, 0.5 * self.flume_width
        start, place = length - round(length / dx) * dx, self.column_position
        behind = start - 10.0 * dx  # there are ghosts of the bed in the corner behind the paddle, too
        column = Cylinder(start=(place, 0.0, -6.0 * dx), stop=(place, 0.0, height), radius=self.column_radius)
        water = Box(lower=(start, 0.0, 0.0), upper=(length, half, self.depth))
        return Scene(
            walls=(
                BoxWall(name="tank", lower=(behind, 0.0, 0.0), upper=(length, half, height), open_faces=("+z",)),
                BoxWall(name="paddle", lower=(behind, 0.0, 0.0), upper=(start, half, height), body="paddle"),
                _WALL.validate_python({"name": "column", **column.model_dump()}),
            ),
            fluid=(DifferenceRegion(of=water, minus=(column,)),),
            depth=self.depth,
            domain=((behind, -dx, -dx), (length + dx, half + dx, 2.0 * height)),
            gauges=(Gauge(name="G1", position=(0.5 * place, 0.5 * half)),),
            bodies={"paddle": self.paddle()},
        )

    def _check_places(self) -> None:
        """Check that the column stands in the water and out of the way of the paddle.

        Raises
        ------
        InputError
            when it does not.
        """
        front, back = self.column_position - self.column_radius, self.column_position + self.column_radius
        if self.flume_width <= 2.0 * self.column_radius:
            raise InputError(
                f"flume_width = {self.flume_width:g} m leaves no water beside the column: give more than its diameter,"
                f" {2.0 * self.column_radius:g} m"
            )
        if front <= self.paddle().stroke or back >= self.flume_length:
            raise InputError(
                f"the column reaches from x = {front:g} to {back:g} m, the water from the end of the paddle's stroke,"
                f" {self.paddle().stroke:g} m, to the end of the flume, {self.flume_length:g} m: give a"
                " column_position between them, or a longer flume_length"
            )

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return ``column_force`` and ``elevation`` at the gauge over time, by linear theory."""
        theory, time = self.diffraction(), dataset["probe_time"].values - self.arrival_time()
        return self._series(dataset, theory.force(time), theory.elevation(-0.5 * self.column_position, time))

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        half = dataset["wall_force"].sel(wall="column", space="x").values
        return self._series(
            dataset, 2.0 * (half - half[0]), dataset["gauge_elevation"].isel(gauge=0).values - self.depth
        )

    @staticmethod
    def _series(dataset: xr.Dataset, force: Array, elevation: Array) -> xr.Dataset:
        """Return force (t,), N, and elevation (t,), m, over the times of the samples of a run."""
        time = dataset["probe_time"].values
        return xr.Dataset(
            {
                "column_force": ("probe_time", force, {"units": "N", "long_name": "force on the column"}),
                "elevation": ("probe_time", elevation, {"units": "m", "long_name": "elevation at G1"}),
            },
            coords={"probe_time": ("probe_time", time, {"units": "s", "long_name": "time"})},
            attrs={"label": "linear theory"},
        )

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of force and wave, without extremes that the run has not come to."""
        exact, run = self.exact(dataset), self.measured(dataset)
        time, rate = dataset["probe_time"].values, self.paddle().wavenumber * self.paddle().speed
        force, theory = (
            running_mean(time, series["column_force"], _MEAN / rate, self.probe_interval) for series in (run, exact)
        )
        after = (time[-1] - self.arrival_time()) * rate
        found = super().errors(dataset)
        if after > 0.0:
            found["wave_height"] = abs(float(run["elevation"].max()) / self.wave_height - 1.0)
            found["push"] = abs(float(force.max() / theory.max()) - 1.0)
        if after > 1.5:
            found["pull"] = abs(float(force.min() / theory.min()) - 1.0)
        return found
