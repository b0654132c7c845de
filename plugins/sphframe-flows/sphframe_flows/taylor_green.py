"""Decaying vortices of Taylor and Green."""

import math
from collections.abc import Mapping
from typing import ClassVar, Literal, final

import numpy as np
import xarray as xr
from scipy.spatial import cKDTree

from sphframe import Array, Case, InputError
from sphframe.cases import Benchmark, Component, Derived, ExactCase, Scene, downward_gravity, quantity, with_default
from sphframe.geometry import PolygonRegion, PolygonWall
from sphframe_flows.solutions import sample_times, variable


@final
class TaylorGreen(ExactCase):
    """Vortices that decay in a square of side L, which repeats itself or has walls that let the fluid slip::

        u = U sin kx cos ky e,    v = -U cos kx sin ky e,    p = p_b + rho U^2 / 4 (cos 2kx + cos 2ky) e^2
        e = exp(-2 nu k^2 t),     kinetic energy = rho U^2 L^2 / 4 e^2

    with k = 2 pi / L. On lines x or y = n pi / k the flow is along the line and without shear, so that walls with free
    slip change nothing: the difference between the two runs is the error of the walls.

    ``errors``: ``kinetic_energy`` is the largest difference from the solution over the initial energy,
    ``last_kinetic_energy`` that of the last frame over the solution; ``velocity`` is the RMS in the last frame over the
    exact RMS; ``largest_hole`` is the radius of the largest empty circle in the last frame over the spacing, less
    sqrt(1/2), that of a lattice.

    The lattice of the start breaks up within a tenth of L / U, which costs energy with little shifting.

    Source: G. I. Taylor, A. E. Green (1937), doi:10.1098/rspa.1937.0036.
    """

    title: ClassVar[str] = "Taylor-Green vortices"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "taylor-green-box": Benchmark(
            "last_kinetic_energy",
            "Free slip: losses along straight walls and in corners.",
            (0.04, 0.02),
            {"walls": "free-slip", "until": 0.5},
        )
    }

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    side: float = quantity(1.0, "m", "side L of the square", gt=0)
    speed: float = quantity(1.0, "m s-1", "largest initial speed U", gt=0)
    reynolds_number: float = quantity(100.0, "1", "Reynolds number U L / nu", gt=0)
    walls: Literal["none", "free-slip"] = quantity("none", "1", "what bounds the square: it repeats itself, or walls")
    periodic: tuple[Literal["x", "y", "z"], ...] = with_default(
        Case, "periodic", Derived("x and y without walls", lambda case: ("x", "y") if case.walls == "none" else ())
    )
    gravity: float = downward_gravity(0.0)
    kinematic_viscosity: float = with_default(
        Case,
        "kinematic_viscosity",
        Derived("speed side / reynolds_number", lambda case: case.speed * case.side / case.reynolds_number),
    )
    viscosity_model: Literal["morris", "monaghan-gingold"] = with_default(Case, "viscosity_model", "morris")
    artificial_viscosity: float = with_default(Case, "artificial_viscosity", 0.0)
    shifting: float = with_default(Case, "shifting", 2.0)
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "free")
    sound_speed: float | None = with_default(Case, "sound_speed", Derived("10 speed", lambda case: 10.0 * case.speed))
    equation_of_state: Component = with_default(
        Case,
        "equation_of_state",
        Derived(
            "linear, with the background pressure rho U^2",
            lambda case: Component(
                name="linear", options={"background_pressure": case.reference_density * case.speed**2}
            ),
        ),
    )
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("side / 50", lambda case: case.side / 50.0)
    )
    until: float = with_default(Case, "until", Derived("side / speed", lambda case: case.side / case.speed))
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 20", lambda case: case.until / 20.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("until / 500", lambda case: case.until / 500.0)
    )

    @property
    def wavenumber(self) -> float:
        """2 pi / L, 1/m."""
        return 2.0 * math.pi / self.side

    def decay(self, time: Array) -> Array:
        """Return e (n,) at the times (n,), s."""
        return np.asarray(np.exp(-2.0 * self.kinematic_viscosity * self.wavenumber**2 * time))

    def velocity(self, position: Array) -> Array:
        """Return the initial velocity (n, 2), m/s."""
        x, y = self.wavenumber * position.T
        return self.speed * np.stack([np.sin(x) * np.cos(y), -np.cos(x) * np.sin(y)], axis=1)

    def pressure(self, position: Array) -> Array:
        """Return the initial pressure (n,), Pa."""
        waves = np.cos(2.0 * self.wavenumber * position).sum(axis=1)
        background = float(self.equation_of_state.options.get("background_pressure", 0.0))
        return np.asarray(background + 0.25 * self.reference_density * self.speed**2 * waves)

    def scene(self) -> Scene:
        """Draw the square."""
        side = self.side
        if self.periodic != (("x", "y") if self.walls == "none" else ()):
            raise InputError(f"periodic = {list(self.periodic)} contradicts walls = {self.walls!r}: leave it out")
        corners = ((0.0, 0.0), (side, 0.0), (side, side), (0.0, side))
        box = PolygonWall(name="box", points=corners, closed=True)
        margin = 0.0 if self.walls == "none" else 0.1 * side
        return Scene(
            walls=() if self.walls == "none" else (box,),
            fluid=(PolygonRegion(points=corners),),
            depth=side,
            domain=((-margin, -margin), (side + margin, side + margin)),
            initial_pressure=self.pressure,
            initial_velocity=self.velocity,
        )

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the ``kinetic_energy``."""
        energy = 0.25 * self.reference_density * self.speed**2 * self.side**2
        decay = self.decay(dataset["probe_time"].values)
        return xr.Dataset(
            {"kinetic_energy": variable("probe_time", energy * decay**2, "J m-1", "kinetic energy")},
            coords={"probe_time": sample_times(dataset)},
        )

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of energy and velocity, and the largest hole."""
        exact = self.exact(dataset)["kinetic_energy"].values
        energy = dataset["kinetic_energy"].values
        last = dataset.isel(time=-1)
        position, decay = last["position"].values, self.decay(dataset["time"].values[-1:])
        velocity = decay * self.velocity(position)
        difference = last["velocity"].values - velocity
        return {
            "kinetic_energy": float(np.abs(energy - exact).max() / exact[0]),
            "last_kinetic_energy": abs(float(energy[-1] / exact[-1]) - 1.0),
            "velocity": float(np.sqrt(np.square(difference).mean() / np.square(velocity).mean())),
            "largest_hole": self._largest_hole(position),
        }

    def _largest_hole(self, position: Array) -> float:
        """Return the radius of the largest empty circle over the spacing, less that of a lattice."""
        margin, step = 3.0 * self.particle_spacing, 0.1 * self.particle_spacing
        places = np.arange(margin, self.side - margin, step)
        x, y = np.meshgrid(places, places)
        distance, _ = cKDTree(position).query(np.column_stack([x.ravel(), y.ravel()]))
        return float(distance.max() / self.particle_spacing - math.sqrt(0.5))
