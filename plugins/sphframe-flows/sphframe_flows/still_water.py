"""Still water beside walls that cross the lattice, curve, are submerged or are thin."""

import math
from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar, Literal, NamedTuple, final

import numpy as np
import xarray as xr

from sphframe import Array, Case, InputError
from sphframe.cases import Benchmark, Derived, ExactCase, Scene, WallPart, downward_gravity, quantity, with_default
from sphframe.geometry import Box, DifferenceRegion, Polygon, PolygonRegion, PolygonWall
from sphframe_flows.solutions import sample_times, variable

_DEGREES_PER_CHORD = 2.0


class Load(NamedTuple):
    """An exact load: what it is, the recorded variable, the wall or part, its component along ``axis``, its value.

    A moment has no axis. Values are in N per metre of width, or N m per metre.
    """

    long_name: str
    variable: str
    place: str
    axis: str | None
    value: float


class StillWater(ExactCase):
    """Water at rest in a tank. Subclasses draw the tank and give the loads on its walls.

    ``errors``: RMS of the particles' pressure over rho g d in the last frame; of each load, the mean over the second
    half of the run, relative, or over the largest exact load where it is zero; and ``kinetic_energy``, over
    rho g d / 2 per volume.
    """

    dimension: Literal[2] = quantity(2, "1", "dimension of space")
    gravity: float = downward_gravity()
    depth: float = quantity(0.5, "m", "depth d of the water", gt=0)
    particle_spacing: float = with_default(
        Case, "particle_spacing", Derived("depth / 25", lambda case: case.depth / 25.0)
    )
    until: float = with_default(Case, "until", 2.0)
    frame_interval: float = with_default(Case, "frame_interval", Derived("until / 20", lambda case: case.until / 20.0))
    probe_interval: float = with_default(Case, "probe_interval", 0.005)

    @abstractmethod
    def loads(self) -> dict[str, Load]:
        """Return the exact loads, by name."""

    def level(self, position: Array) -> Array:
        """Return the still water level (n,) at ``position`` (n, 2), m."""
        return np.full(len(position), self.depth)

    @property
    def weight_scale(self) -> float:
        """Rho g, N/m^3."""
        return self.reference_density * self.gravity

    def exact(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the ``pressure`` at rest at the depths of the particles, and the loads."""
        position = dataset["position"].isel(time=-1).values
        below, (place, where) = np.maximum(self.level(position) - position[:, 1], 0.0), self._place(position)
        c2 = self.reference_sound_speed(self.depth) ** 2
        pressure = self.reference_density * c2 * np.expm1(self.gravity * below / c2)
        ones = np.ones(dataset.sizes["probe_time"])
        loads = {
            name: variable("probe_time", load.value * ones, "N m-1" if load.axis else "N", load.long_name)
            for name, load in self.loads().items()
        }
        return xr.Dataset(
            {"pressure": variable(place, pressure, "Pa", "pressure"), **loads},
            coords={place: where, "probe_time": sample_times(dataset)},
        )

    def _place(self, position: Array) -> tuple[str, tuple[str, Any, dict[str, str]]]:
        """Return name and values of the coordinate over which the pressure at ``position`` (n, 2), m, is given."""
        below = np.maximum(self.level(position) - position[:, 1], 0.0)
        return "depth_below", variable("depth_below", below, "m", "depth below the level")

    def measured(self, dataset: xr.Dataset) -> xr.Dataset:
        """Return the same of the run."""
        result = self.exact(dataset)
        values = {"pressure": dataset["pressure"].isel(time=-1).values}
        for name, load in self.loads().items():
            series = dataset[load.variable].sel({load.variable.split("_")[0]: load.place})
            values[name] = (series if load.axis is None else series.sel(space=load.axis)).values
        return result.assign({name: (result[name].dims, value, result[name].attrs) for name, value in values.items()})

    def errors(self, dataset: xr.Dataset) -> dict[str, float]:
        """Return the errors of pressure and loads, and the kinetic energy."""
        exact, run, loads = self.exact(dataset), self.measured(dataset), self.loads()
        scale = self.weight_scale * self.depth
        result = {"pressure": float(np.sqrt(((run["pressure"] - exact["pressure"]) ** 2).mean())) / scale}
        later = slice(dataset.sizes["probe_time"] // 2, None)
        largest = max((abs(load.value) for load in loads.values()), default=1.0)
        for name, load in loads.items():
            mean = float(run[name].isel(probe_time=later).mean())
            scale_of_load = abs(load.value) or (largest if load.axis else largest * self.arm)
            result[name] = abs(mean - load.value) / scale_of_load
        volume = float(dataset["mass"][0]) / self.reference_density
        result["kinetic_energy"] = float(dataset["kinetic_energy"][-1]) / (0.5 * scale * volume)
        return result

    @property
    def arm(self) -> float:
        """The length, m, by which an error of a moment is divided, beside the largest force."""
        return self.depth

    def _tank(self, *bed: tuple[float, float]) -> tuple[PolygonWall, tuple[tuple[float, float], tuple[float, float]]]:
        """Return the wall ``tank`` of an open tank with a ``bed`` from its left to its right end, and the domain."""
        height, (left, _), (right, _) = 1.5 * self.depth, bed[0], bed[-1]
        wall = PolygonWall(name="tank", points=((left, height), *bed, (right, height)))
        margin = 0.1 * self.depth
        return wall, ((left - margin, -margin), (right + margin, 2.0 * height))


class Obstacle(StillWater):
    """Still water above an obstacle in the middle of the bed of a tank.

    The water presses down on it, the part :attr:`part` of the wall ``tank``, by rho g (2 b d - A) per metre of width,
    with the half base b and the area A, and across on its half ``left`` by rho g (d^2 - (d - a)^2) / 2, with the height
    a. These are integrals of the pressure, since ghosts in corners act for two faces.
    """

    part: ClassVar[str]
    """name of the obstacle"""

    tank_length: float = quantity(1.2, "m", "length of the tank", gt=0)

    @property
    @abstractmethod
    def sizes(self) -> tuple[float, float, float]:
        """Half base b, m, height a, m, and area A, m^2."""

    @abstractmethod
    def outline(self) -> list[tuple[float, float]]:
        """Return the points of the obstacle above the bed, from left to right, with x from its middle, m."""

    def scene(self) -> Scene:
        """Draw the tank with its obstacle."""
        length, depth, (half, top, _) = self.tank_length, self.depth, self.sizes
        if not (top < depth and half < 0.5 * length):
            raise InputError(
                f"the {self.part} must be lower than the water is deep, and its base shorter than the tank"
            )
        middle, margin = 0.5 * length, 0.01 * self.particle_spacing
        above = [(middle + x, y) for x, y in self.outline()]
        bed = ((0.0, 0.0), (middle - half, 0.0), *above, (middle + half, 0.0), (length, 0.0))
        wall, domain = self._tank(*bed)
        lower = (middle - half, -margin)
        return Scene(
            walls=(wall,),
            fluid=(PolygonRegion(points=(*bed, (length, depth), (0.0, depth))),),
            depth=depth,
            domain=domain,
            wall_parts=(
                WallPart(name="left", wall="tank", lower=lower, upper=(middle, top + margin)),
                WallPart(name=self.part, wall="tank", lower=lower, upper=(middle + half, top + margin)),
            ),
        )

    def loads(self) -> dict[str, Load]:
        """Return the force down on the obstacle, and across on one half of it."""
        half, top, area = self.sizes
        down = -self.weight_scale * (2.0 * half * self.depth - area)
        across = 0.5 * self.weight_scale * (self.depth**2 - (self.depth - top) ** 2)
        by_pressure = "part_force_by_pressure"
        return {
            "downward_force": Load(f"vertical force on the {self.part}", by_pressure, self.part, "y", down),
            "horizontal_force": Load("horizontal force on its left half", by_pressure, "left", "x", across),
        }


@final
class TiltedTank(StillWater):
    """Still water in a tank that is turned by an angle: every wall crosses the lattice, in a corner of 90 degrees.

    The lowest corner is the origin. The water presses on the wall ``tank`` with its weight, rho g A, and no force
    across.
    """

    title: ClassVar[str] = "still water in a tilted tank"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "tilted-tank": Benchmark(
            "pressure", "Pressure at straight walls that cross the lattice.", (0.04, 0.02), {"until": 1.0}
        )
    }

    angle: float = quantity(30.0, "degree", "angle of the bed", gt=0, lt=90)
    tank_length: float = quantity(1.0, "m", "length of the bed", gt=0)
    depth: float = quantity(0.6, "m", "depth d of the water above the lowest corner", gt=0)

    def _corners(self) -> list[tuple[float, float]]:
        """Return the upper end of the left wall, the ends of the bed, and the upper end of the right wall."""
        cosine, sine = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        height = 1.3 * self.depth / cosine
        end = (self.tank_length * cosine, self.tank_length * sine)
        return [(-height * sine, height * cosine), (0.0, 0.0), end, (end[0] - height * sine, end[1] + height * cosine)]

    def _water(self) -> DifferenceRegion:
        corners = self._corners()
        left, right = min(x for x, _ in corners) - 1.0, max(x for x, _ in corners) + 1.0
        above = Box(lower=(left, self.depth), upper=(right, 10.0 * self.depth + self.tank_length))
        return DifferenceRegion(of=Polygon(points=tuple(corners)), minus=(above,))

    def scene(self) -> Scene:
        """Draw the tank."""
        corners = self._corners()
        x, y = np.array(corners).T
        margin = 0.2 * self.depth
        return Scene(
            walls=(PolygonWall(name="tank", points=tuple(corners)),),
            fluid=(self._water(),),
            depth=self.depth,
            domain=((x.min() - margin, -margin), (x.max() + margin, y.max() + margin)),
        )

    def loads(self) -> dict[str, Load]:
        """Return the weight of the water."""
        weight = -self.weight_scale * self._water().geometry(1e-6 * self.depth).area
        return {
            "weight": Load("vertical force on the tank", "wall_force", "tank", "y", weight),
            "thrust": Load("horizontal force on the tank", "wall_force", "tank", "x", 0.0),
        }


@final
class CircularSill(Obstacle):
    """Still water above a half circle on the bed of a tank: a curved wall, and sharp re-entrant corners.

    The part ``sill`` of the wall ``tank`` is pressed down by rho g (2 R d - pi R^2 / 2) per metre of width; its half
    ``left`` is pushed by rho g (d^2 - (d - R)^2) / 2.
    """

    title: ClassVar[str] = "still water above a half circle"
    part: ClassVar[str] = "sill"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "circular-sill": Benchmark(
            "downward_force", "Force of still water on a curved wall.", (0.04, 0.02), {"until": 1.0}
        )
    }

    radius: float = quantity(0.24, "m", "radius R of the half circle", gt=0)

    @property
    def sizes(self) -> tuple[float, float, float]:
        """The radius twice, m, and the area of the half circle, m^2."""
        return self.radius, self.radius, 0.5 * math.pi * self.radius**2

    def outline(self) -> list[tuple[float, float]]:
        """Return points of the half circle."""
        angle = np.linspace(np.pi, 0.0, round(180.0 / _DEGREES_PER_CHORD) + 1)[1:-1]
        return [(float(self.radius * np.cos(a)), float(self.radius * np.sin(a))) for a in angle]


@final
class SubmergedBox(StillWater):
    """Still water around a box that is held at an angle below the surface.

    The wall ``box`` is pushed up by the weight of the water that it displaces, rho g A, without a moment
    about its centre. The error of the moment is over rho g A times the box's length.
    """

    title: ClassVar[str] = "still water around a submerged box"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "submerged-box": Benchmark(
            "buoyancy", "Force of still water on a body with corners.", (0.04, 0.02), {"until": 1.0}
        )
    }

    depth: float = quantity(0.6, "m", "depth d of the water", gt=0)
    tank_length: float = quantity(1.0, "m", "length of the tank", gt=0)
    box_length: float = quantity(0.4, "m", "length of the box", gt=0)
    box_height: float = quantity(0.2, "m", "height of the box", gt=0)
    angle: float = quantity(17.0, "degree", "angle of the box", ge=0, lt=90)

    @property
    def arm(self) -> float:
        """The length of the box, m."""
        return self.box_length

    def scene(self) -> Scene:
        """Draw tank and box."""
        length, depth = self.tank_length, self.depth
        cosine, sine = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        half = 0.5 * np.array([self.box_length, self.box_height])
        centre = (0.5 * length, 0.5 * depth)
        corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * half
        turned = corners @ np.array([[cosine, sine], [-sine, cosine]]) + centre
        if not (turned[:, 1].max() < depth and turned.min() > 0.0 and turned[:, 0].max() < length):
            raise InputError("the box must be below the surface and within the tank: give a smaller box or more depth")
        box = tuple((float(x), float(y)) for x, y in turned)
        tank, domain = self._tank((0.0, 0.0), (length, 0.0))
        water = Polygon(points=((0.0, 0.0), (length, 0.0), (length, depth), (0.0, depth)))
        return Scene(
            walls=(tank, PolygonWall(name="box", points=box, closed=True, reference_point=centre)),
            fluid=(DifferenceRegion(of=water, minus=(Polygon(points=box),)),),
            depth=depth,
            domain=domain,
        )

    def loads(self) -> dict[str, Load]:
        """Return the buoyancy; force across and moment vanish."""
        up = self.weight_scale * self.box_length * self.box_height
        return {
            "buoyancy": Load("vertical force on the box", "wall_force", "box", "y", up),
            "moment": Load("moment on the box about its centre", "wall_moment", "box", None, 0.0),
        }


@final
class TwoBasins(StillWater):
    """Still water of two levels on both sides of a plate without thickness.

    The plate is pushed by rho g (d^2 - e^2) / 2 per metre of width towards the lower level e, on the right.
    """

    title: ClassVar[str] = "two basins on both sides of a plate"
    benchmarks: ClassVar[Mapping[str, Benchmark]] = {
        "two-basins": Benchmark(
            "plate_force", "A wall without thickness, wet on both sides.", (0.04, 0.02), {"until": 1.0}
        )
    }

    other_depth: float = quantity(0.2, "m", "depth e of the water on the right of the plate", gt=0)
    tank_length: float = quantity(1.0, "m", "length of the tank, with the plate in its middle", gt=0)
    tension: Literal["none", "bounded", "free"] = with_default(Case, "tension", "none")

    def level(self, position: Array) -> Array:
        """Return the level (n,) of the basin in which ``position`` (n, 2), m, lies."""
        return np.where(position[:, 0] < 0.5 * self.tank_length, self.depth, self.other_depth)

    def scene(self) -> Scene:
        """Draw the basins."""
        length, middle = self.tank_length, 0.5 * self.tank_length
        deep, other = self.depth, self.other_depth
        height = 1.5 * max(deep, other)
        tank = ((0.0, height), (0.0, 0.0), (length, 0.0), (length, height))
        return Scene(
            walls=(
                PolygonWall(name="tank", points=tank),
                PolygonWall(name="plate", points=((middle, 0.0), (middle, height))),
            ),
            fluid=(
                PolygonRegion(points=((0.0, 0.0), (middle, 0.0), (middle, deep), (0.0, deep)), level=deep),
                PolygonRegion(points=((middle, 0.0), (length, 0.0), (length, other), (middle, other)), level=other),
            ),
            depth=deep,
            domain=((-0.1 * deep, -0.1 * deep), (length + 0.1 * deep, 2.0 * height)),
        )

    def loads(self) -> dict[str, Load]:
        """Return the force on the plate."""
        across = 0.5 * self.weight_scale * (self.depth**2 - self.other_depth**2)
        return {"plate_force": Load("horizontal force on the plate", "wall_force", "plate", "x", across)}
