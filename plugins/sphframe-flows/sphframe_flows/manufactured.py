"""Flows that are chosen first; the sources that make them solutions are then added to the equations."""

import math
from typing import ClassVar, Literal, final

import numpy as np
import xarray as xr

from sphframe import Array, Case, InputError
from sphframe.cases import Derived, ExactCase, Scene, Sources, downward_gravity, quantity, with_default
from sphframe.geometry import CircleRegion, CircleWall, PolygonRegion, PolygonWall, Region, Wall
from sphframe_flows.manufactured_fields import AMPLITUDE, FIELDS, RADIUS, Manufactured
from sphframe_flows.solutions import sample_times, variable

Name = Literal[
    "noslip-box", "freeslip-box", "shearslip-box", "noslip-disc", "stressfree-disc", "noslip-wave", "tangent-wave",
    "periodic",
]  # fmt: skip


@final
class ManufacturedFlow(ExactCase):
    """A vortex in a closed domain, or four in a square that repeats itself, which sources keep as they are.

    ``field`` names psi, with u = (psi_y, -psi_x), and the domain: the unit square, a disc of radius 0.5, or the unit
    square above a wavy bed, y = 0.1 cos 2 pi x. ``periodic`` is the flow of ``freeslip-box`` with its mirror images, in
    a square of side 2 without walls. ``pressure`` is one without normal gradient at the walls, or one with, for which
    the walls are given grad p as the force that balances it. All speeds are about 1 m/s.

    ``errors``: RMS of ``velocity`` over the exact RMS; with the mean taken off, RMS of ``pressure`` over the exact one,
    and ``wall_pressure``, the same for particles within 1.5 spacings of a wall; ``mean_pressure``, the error of the
    mean, over the same scale. All are those of the last frame; :meth:`norms` returns them against time.

    Source of the idea: P. Negi, P. Ramachandran (2022), arXiv:2208.10848.
    """

    title: ClassVar[str] = "manufactured flow"

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    field: Name = quantity("noslip-box", "1", "stream function and domain")
    pressure: Literal["zero", "gradient"] = quantity(
        Derived("zero where there is one", lambda case: "gradient" if FIELDS[case.field].zero is None else "zero"),
        "1",
        "normal gradient of the pressure at the walls",
    )
    decay: float = quantity(0.0, "s-1", "rate at which the flow decays", ge=0)
    periodic: tuple[Literal["x", "y", "z"], ...] = with_default(
        Case, "periodic", Derived("x and y without walls", lambda case: ("x", "y") if case.field == "periodic" else ())
    )
    slip: Literal["free", "no"] = with_default(
        Case, "slip", Derived("that of the field", lambda case: "free" if FIELDS[case.field].slips else "no")
    )
    gravity: float = downward_gravity(0.0)
    reference_density: float = with_default(Case, "reference_density", 1.0)
    kinematic_viscosity: float = with_default(
        Case,
        "kinematic_viscosity",
        Derived("0.01, or 0 where the field has shear at a wall that slips", lambda case: _viscosity(case.field)),
    )
    viscosity_model: Literal["morris", "monaghan-gingold"] = with_default(Case, "viscosity_model", "morris")
    artificial_viscosity: float = with_default(Case, "artificial_viscosity", 0.0)
    shifting: float = with_default(Case, "shifting", 2.0)
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "free")
    sound_speed: float = with_default(Case, "sound_speed", 20.0)
    particle_spacing: float = with_default(Case, "particle_spacing", 0.02)
    until: float = with_default(Case, "until", 1.0)
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 20", lambda case: case.until / 20.0))
    probe_interval: float = with_default(
        Case, "probe_interval", Derived("until / 500", lambda case: case.until / 500.0)
    )

    @property
    def solution(self) -> Manufactured:
        """The flow."""
        return Manufactured(
            FIELDS[self.field],
            self.pressure == "gradient",
            self.reference_density,
            self.sound_speed,
            self.kinematic_viscosity,
            self.decay,
        )

    def scene(self) -> Scene:
        """Draw the domain."""
        given = FIELDS[self.field]
        if self.pressure == "zero" and given.zero is None:
            raise InputError(f'the field {self.field!r} has no pressure without normal gradient: pressure = "gradient"')
        if self.periodic != (("x", "y") if self.field == "periodic" else ()):
            raise InputError(f"periodic = {list(self.periodic)} contradicts field = {self.field!r}: leave it out")
        wall, fluid = self._drawn()
        solution, margin = self.solution, 0.0 if self.periodic else 0.3
        low, high = {"disc": (-RADIUS, RADIUS), "square": (0.0, 2.0)}.get(given.domain, (0.0, 1.0))
        return Scene(
            walls=() if self.periodic else (wall,),
            fluid=(fluid,),
            depth=1.0,
            domain=((low - margin, low - margin), (high + margin, high + margin)),
            initial_pressure=lambda points: solution.state(points, 0.0).pressure,
            initial_velocity=lambda points: solution.state(points, 0.0).velocity,
            sources=Sources(solution.force, solution.density_rate, solution.wall_force),
        )

    def _drawn(self) -> tuple[Wall, Region]:
        if FIELDS[self.field].domain == "disc":
            return CircleWall(centre=(0.0, 0.0), radius=RADIUS), CircleRegion(centre=(0.0, 0.0), radius=RADIUS)
        side = 2.0 if self.field == "periodic" else 1.0
        x = np.array([0.0, side])
        if FIELDS[self.field].domain == "wave":
            x = np.linspace(0.0, 1.0, 4 * math.ceil(1.0 / self.particle_spacing) + 1)
        height = AMPLITUDE * np.cos(2.0 * np.pi * x) if FIELDS[self.field].domain == "wave" else 0.0 * x
        points = (*zip(x.tolist(), height.tolist(), strict=True), (side, side), (0.0, side))
        return PolygonWall(points=points, closed=True), PolygonRegion(points=points)

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the ``kinetic_energy``, that of the exact velocity of the particles in the first frame."""
        first = dataset.isel(time=0)
        velocity = self.solution.state(first["position"].values, 0.0).velocity
        energy = 0.5 * float((first["particle_mass"].values * np.square(velocity).sum(axis=1)).sum())
        decay = np.exp(-2.0 * self.decay * dataset["probe_time"].values)
        return xr.Dataset(
            {"kinetic_energy": variable("probe_time", energy * decay, "J m-1", "kinetic energy")},
            coords={"probe_time": sample_times(dataset)},
        )

    def norms(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the errors ``velocity``, ``pressure``, ``wall_pressure`` and ``mean_pressure`` (time,)."""
        found: dict[str, list[float]] = {"velocity": [], "pressure": [], "wall_pressure": [], "mean_pressure": []}
        for index, time in enumerate(dataset["time"].values):
            frame = dataset.isel(time=index)
            position = frame["position"].values
            state = self.solution.state(position, float(time))
            off = frame["pressure"].values - state.pressure
            mean, scale = float(off.mean()), float(np.std(state.pressure))
            off = off - mean
            speed = float(np.sqrt(np.square(state.velocity).sum(axis=1).mean()))
            near = self._beside_walls(position)
            velocity = np.square(frame["velocity"].values - state.velocity).sum(axis=1)
            found["velocity"].append(float(np.sqrt(velocity.mean())) / speed)
            found["pressure"].append(float(np.sqrt(np.square(off).mean())) / scale)
            found["wall_pressure"].append(float(np.sqrt(np.square(off[near]).mean())) / scale if near.any() else 0.0)
            found["mean_pressure"].append(mean / scale)
        time = variable("time", dataset["time"].values, "s", "time")
        return xr.Dataset(
            {name: variable("time", values, "1", name) for name, values in found.items()}, coords={"time": time}
        )

    def _beside_walls(self, position: Array) -> Array:
        """Return which particles (n,) are within 1.5 spacings of a wall."""
        x, y = position.T
        if self.field == "periodic":
            return np.zeros(len(x), np.bool_)
        if FIELDS[self.field].domain == "disc":
            distance = RADIUS - np.hypot(x, y)
        else:
            bed = AMPLITUDE * np.cos(2.0 * np.pi * x) if FIELDS[self.field].domain == "wave" else 0.0
            distance = np.minimum.reduce([x, 1.0 - x, y - bed, 1.0 - y])
        return np.asarray(distance < 1.5 * self.particle_spacing)

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors in the last frame."""
        return {str(name): float(values[-1]) for name, values in self.norms(dataset).data_vars.items()}


def _viscosity(field: str) -> float:
    return 0.01 if FIELDS[field].viscous else 0.0
