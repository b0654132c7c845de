"""Cases: the scene that a case draws: walls, fluid, bodies, probes, gauges and diagnostics."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, model_validator

from sphframe.arrays import Array
from sphframe.geometry import Region, Wall
from sphframe.interfaces import Fields, RigidBody


class Probe(BaseModel):
    """A pressure sensor: a point, or a disc of ``radius`` whose pressure is averaged along its ``tangent``."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    name: str = Field(min_length=1, max_length=64)
    """name of the probe in outputs"""
    position: tuple[float, ...] = Field(min_length=2, max_length=3)
    """where it is, m: on a wall, on its wet side"""
    radius: Annotated[float, Field(ge=0)] = 0.0
    """of the disc over which it averages, m; 0 for a point"""
    tangent: Annotated[tuple[float, ...], Field(min_length=2, max_length=3)] | None = None
    """direction along the wall, of any length, needed for a disc"""
    body: str | None = None
    """name of the body that carries the probe; None means a probe at rest"""

    @model_validator(mode="after")
    def _disc_has_a_direction(self) -> "Probe":
        if self.radius > 0 and self.tangent is None:
            raise ValueError("a probe with a radius is a disc: give its tangent, a vector along the wall")
        if self.tangent is not None and not any(self.tangent):
            raise ValueError("tangent is the zero vector: give a vector along the wall, such as [0, 1]")
        return self


class Gauge(BaseModel):
    """A free-surface elevation gauge at the horizontal position ``position`` (x in 2-D; x, y in 3-D)."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    name: str = Field(min_length=1, max_length=64)
    """name of the gauge in outputs"""
    position: tuple[float, ...] = Field(min_length=1, max_length=2)
    """horizontal position, m: [x] in 2-D, [x, y] in 3-D"""
    body: str | None = None
    """name of the body with which the gauge moves horizontally; None means a gauge at rest"""


class WallPart(BaseModel):
    """A part of the wall ``wall``, as drawn, within a box: force and moment on it are recorded by its name."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    name: str = Field(min_length=1, max_length=64)
    """name of the part in outputs"""
    wall: str
    """name of the wall"""
    lower: tuple[float, ...] = Field(min_length=2, max_length=3)
    """corner of the box with the smallest coordinates, as drawn, m"""
    upper: tuple[float, ...] = Field(min_length=2, max_length=3)
    """corner of the box with the largest coordinates, m"""


@dataclass(frozen=True)
class Diagnostic:
    """A number computed from the fluid whenever the probes are sampled.

    With a ``body``, the function sees the fluid's positions in the frame in which that body was drawn.
    """

    name: str
    unit: str
    long_name: str
    function: Callable[[Fields], float]
    body: str | None = None


@dataclass(frozen=True)
class Sources:
    """What is added to the equations of the fluid at positions x (n, dim) and a time t, such that a flow solves them.

    ``acceleration`` (n, dim), m/s^2, and ``density_rate`` (n,), kg/(m^3 s); ``wall_force`` (n, dim), Pa/m, at points of
    walls: the gradient that the pressure has there, in place of rho0 f.
    """

    acceleration: Callable[[Array, float], Array]
    density_rate: Callable[[Array, float], Array]
    wall_force: Callable[[Array, float], Array]


@dataclass(frozen=True)
class Scene:
    """What is simulated, in SI units; the last axis is the height."""

    walls: tuple[Wall, ...]
    fluid: tuple[Region, ...]
    depth: float
    """still water depth H: the scale of pressure (rho g H), time (sqrt(H/g)) and of the default sound speed"""
    domain: tuple[tuple[float, ...], tuple[float, ...]]
    """lower and upper corner of the box that no particle may leave"""
    probes: tuple[Probe, ...] = ()
    gauges: tuple[Gauge, ...] = ()
    bodies: Mapping[str, RigidBody] = field(default_factory=dict)
    """the bodies that carry walls, by the name that the walls refer to"""
    initial_pressure: Callable[[Array], Array] | None = None
    """p(position (n, dim)) -> (n,), Pa; None is the compressible rest state below the still water level"""
    initial_velocity: Callable[[Array], Array] | None = None
    """u(position (n, dim)) -> (n, dim), m/s; None is the velocity of each region, by default zero"""
    sources: Sources | None = None
    diagnostics: tuple[Diagnostic, ...] = ()
    wall_parts: tuple[WallPart, ...] = ()
