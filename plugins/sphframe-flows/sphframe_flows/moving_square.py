"""A square that starts to move in a closed box."""

from collections.abc import Mapping
from typing import ClassVar, Literal, final

import numpy as np
import xarray as xr

from sphframe import Array, Case, InputError
from sphframe.cases import Benchmark, Derived, Scene, quantity, with_default
from sphframe.geometry import DifferenceRegion, Polygon, PolygonWall
from sphframe_flows.confined import ConfinedFlow
from sphframe_flows.smooth_start import SmoothStart
from sphframe_flows.solutions import variable

_WIDTH = 0.2
"""time scale T of the start, over D / U"""
_MEAN_OVER = 0.1
"""window of the means of the drag, over D / U"""
_DRAG = np.array([
    (0.3, 2.17), (0.4, 5.29), (0.5, 8.17), (0.56, 8.66), (0.6, 8.33), (0.7, 6.12), (0.8, 3.95), (0.9, 2.86),
    (1.0, 2.50), (1.25, 2.18), (1.5, 2.08), (2.0, 1.93), (2.5, 1.92), (3.0, 1.93), (3.5, 1.87), (4.0, 1.88),
    (4.5, 1.89), (5.0, 1.84), (5.5, 1.87), (6.0, 1.88),
])  # fmt: skip
"""time over D / U, drag over rho U^2 D / 2, as means over _MEAN_OVER"""


@final
class MovingSquare(ConfinedFlow):
    """A square of side D starts along x to the speed U in a box 10 D x 5 D full of fluid at rest, with no slip.

    This is SPHERIC's test 6, after A. Colagrossi (INSEAN). The centre starts 1.5 D from the left wall, half way up, and
    reaches U within D / U, see :class:`SmoothStart`; at 7 D / U the end of the box is felt. ``exact`` is the published
    drag at the Reynolds number U D / nu of 100, computed with finite differences: means over 0.1 D / U at instants up
    to 6 D / U. It scatters by about 2 %, and contains the force by which the fluid is accelerated. At another Reynolds
    number there is none, and no error. ``errors``: ``drag``, RMS of the relative differences from D / U on,
    ``largest_drag``, the largest of these, ``mean_drag``, relative difference of the means from 1.5 D / U on, and
    ``start``, RMS before D / U over the largest drag. Sound that the box reflects makes the drag swing, which
    ``mean_drag`` averages.
    """

    title: ClassVar[str] = "square that moves in a closed box"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "moving-square": Benchmark(
            "mean_drag", "A moving body with sharp edges and no slip.", (0.1, 0.05), {"until": 3.0}
        )
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    side: float = quantity(1.0, "m", "side D of the square", gt=0)
    speed: float = quantity(1.0, "m s-1", "speed U of the square", gt=0)
    reynolds_number: float = quantity(100.0, "1", "Reynolds number U D / nu", gt=0)
    kinematic_viscosity: float = with_default(
        Case,
        "kinematic_viscosity",
        Derived("speed side / reynolds_number", lambda case: case.speed * case.side / case.reynolds_number),
    )
    sound_speed: float | None = with_default(Case, "sound_speed", Derived("25 speed", lambda case: 25.0 * case.speed))
    background_pressure: float = quantity(
        Derived("3 rho U^2", lambda case: 3.0 * case.reference_density * case.speed**2), "Pa", "pressure at rest"
    )
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("side / 16", lambda case: case.side / 16.0)
    )
    until: float = with_default(Case, "until", Derived("5.1 side / speed", lambda case: 5.1 * case.side / case.speed))
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 20", lambda case: case.until / 20.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("side / speed / 200", lambda case: case.side / case.speed / 200.0)
    )

    @property
    def time_scale(self) -> float:
        """D / U, s."""
        return self.side / self.speed

    def scene(self) -> Scene:
        """Draw box and square."""
        side, pressure = self.side, self.background_pressure
        length, height = 10.0 * side, 5.0 * side
        square = ((side, 2.0 * side), (2.0 * side, 2.0 * side), (2.0 * side, 3.0 * side), (side, 3.0 * side))
        box = ((0.0, 0.0), (length, 0.0), (length, height), (0.0, height))
        motion = SmoothStart(self.speed, _WIDTH * self.time_scale)
        nothing = np.zeros(3)
        if motion.motion(self.until, nothing, nothing, nothing).position[0] > 8.0 * side - self.particle_spacing:
            raise InputError(f"the square would reach the end of the box before until = {self.until:g} s: give less")
        return Scene(
            walls=(
                PolygonWall(name="box", points=box, closed=True),
                PolygonWall(name="square", points=square, closed=True, body="square"),
            ),
            fluid=(DifferenceRegion(of=Polygon(points=box), minus=(Polygon(points=square),)),),
            depth=height,
            domain=((-0.5 * side, -0.5 * side), (length + 0.5 * side, height + 0.5 * side)),
            bodies={"square": motion},
            initial_pressure=lambda position: np.full(len(position), pressure),
        )

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the published ``drag`` over time, at the instants that the run has reached."""
        last = float(dataset["probe_time"][-1]) / self.time_scale
        time, drag = _DRAG[(_DRAG[:, 0] + 0.5 * _MEAN_OVER <= last) & (self.reynolds_number == 100.0)].T
        force = 0.5 * self.reference_density * self.speed**2 * self.side
        return xr.Dataset(
            {"drag": variable("instant", force * drag, "N m-1", "drag, means")},
            coords={"instant": variable("instant", time * self.time_scale, "s", "time")},
        )

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        exact, time = self.exact(dataset), dataset["probe_time"].values
        force = self._drag(dataset)
        half = 0.5 * _MEAN_OVER * self.time_scale
        means = [force[np.abs(time - instant) <= half * (1.0 + 1e-9)].mean() for instant in exact["instant"].values]
        return exact.assign(drag=variable("instant", means, "N m-1", "drag, means"))

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of the drag; none before the square moves steadily, nor at other Reynolds numbers."""
        exact, run = self.exact(dataset), self.measured(dataset)
        instant = exact["instant"].values / self.time_scale
        steady, late = instant >= 0.99, instant >= 1.49
        if not steady.any():
            return {}
        difference, drag = (run["drag"] - exact["drag"]).values, exact["drag"].values
        relative = difference[steady] / drag[steady]
        found = {
            "drag": float(np.sqrt(np.mean(relative**2))),
            "largest_drag": float(np.abs(relative).max()),
            "start": float(np.sqrt(np.mean(difference[~steady] ** 2)) / drag.max()),
        }
        if late.sum() > 1:
            time, force = dataset["probe_time"].values / self.time_scale, self._drag(dataset)
            within = (time >= instant[late][0]) & (time <= instant[late][-1])
            published = np.trapezoid(drag[late], instant[late]) / (instant[-1] - instant[late][0])
            found["mean_drag"] = abs(float(force[within].mean() / published) - 1.0)
        return found

    def _drag(self, dataset: xr.Dataset) -> Array:
        """Return the drag of the run at each sample (n,), N/m."""
        return np.asarray(-dataset["wall_force"].sel(wall="square", space="x").values)
