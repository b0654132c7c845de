"""Cases: what every case has, numerical and physical parameters, checked once when the case is made."""

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, Self

import numpy as np
from pydantic import (
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    ModelWrapValidatorHandler,
    Tag,
    ValidationError,
    field_validator,
    model_validator,
)

from sphframe.arrays import Array
from sphframe.cases.explain import explain
from sphframe.cases.open_boundaries import OpenBoundaries
from sphframe.cases.parameters import Component, Derived, quantity, unit_of, written
from sphframe.cases.scene import Scene
from sphframe.errors import InputError
from sphframe.interfaces.body_force import gravity_vector
from sphframe.registry.options import boolean_numbers
from sphframe.representation import html_table

Gravity = Annotated[
    Annotated[float, Field(ge=0), Tag("<number>")] | Annotated[tuple[float, ...], Tag("<vector>")],
    Discriminator(lambda given: "<vector>" if isinstance(given, list | tuple) else "<number>"),
]
"""a number, downwards along the last axis, or a vector"""


class Guards(BaseModel):
    """What a run does when its state is not physical. NaN and a vanishing time step always stop it."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    domain: Literal["stop", "remove"] = "stop"
    """when a particle has left the domain: stop, or remove and count it"""
    density: Literal["stop", "count"] = "stop"
    """when a density lies outside the band: stop, or count the particles"""
    density_band: tuple[float, float] = (0.5, 1.5)
    """lowest and highest density over the reference density"""
    filling: Literal["stop", "report"] = "stop"
    """when fluid and ghosts fill the kernel beside a wall by less than 75 % or more than 125 % at the start: refuse the
    case, or only report the place, as from 5 % on"""
    fallbacks: Literal["stop", "count"] = "count"
    """when the share of wet ghosts that use the interpolator's fallback exceeds the limit: stop, or only count them"""
    fallback_limit: float = Field(default=0.5, ge=0, le=1)
    """share of wet ghosts"""

    @model_validator(mode="after")
    def _band_holds_the_reference(self) -> Self:
        low, high = self.density_band
        if not 0.0 <= low < 1.0 < high:
            raise ValueError("density_band must hold 1, the reference density, such as [0.5, 1.5]")
        return self


class Case(BaseModel, ABC):
    """A case: its parameters are fields with units, and :meth:`scene` returns what they describe.

    Raises
    ------
    InputError
        one line for every parameter that is unknown, missing or outside its bounds, when the case is made.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    title: ClassVar[str]
    """one line that says what the case is"""
    presets: ClassVar[Mapping[str, Mapping[str, Any]]] = {}
    """named sets of parameters, such as those of a paper"""

    dimension: Literal[2, 3] = quantity(2, "1", "dimension of space")
    particle_spacing: float = quantity(..., "m", "spacing of the particles at the start", gt=0)
    smoothing_length_ratio: float = quantity(
        Derived("1.3 in 2-D, 1.1 in 3-D", lambda case: 1.3 if case.dimension == 2 else 1.1),
        "1",
        "smoothing length over particle spacing",
        ge=1.0,
        le=3.0,
    )
    jitter: float = quantity(
        0.0, "1", "largest random displacement of the particles at the start, over the spacing", ge=0, le=0.2
    )
    seed: int = quantity(0, "1", "seed of these displacements", ge=0)
    reference_density: float = quantity(1000.0, "kg m-3", "density of the fluid at zero pressure", gt=0)
    periodic: tuple[Literal["x", "y", "z"], ...] = quantity(
        (), "1", "directions in which the domain repeats itself; the domain's extent is the period"
    )
    open_boundaries: OpenBoundaries | None = quantity(
        None, "1", "inflow at the left end of the fluid and outflow at its right end, or none"
    )
    gravity: Gravity = quantity(9.81, "m s-2", "acceleration of gravity, downwards along the last axis, or a vector")
    acceleration: Component = quantity(
        Component(name="uniform"), "m s-2", "further body force, from the start on: a vector, or a body force by name"
    )
    sound_speed: float | None = quantity(None, "m s-1", "reference sound speed; by default 20 sqrt(g H)", gt=0)
    density_diffusion: float = quantity(0.1, "1", "coefficient delta of the density diffusion", ge=0)
    artificial_viscosity: float = quantity(0.02, "1", "coefficient alpha of the artificial viscosity", ge=0)
    kinematic_viscosity: float = quantity(0.0, "m2 s-1", "laminar viscosity of the fluid", ge=0)
    viscosity_model: Literal["morris", "monaghan-gingold"] = quantity("morris", "1", "form of the laminar viscosity")
    shifting: float = quantity(0.0, "1", "coefficient of particle shifting; 0: none, 1: as published", ge=0, le=2)
    tensile_control: Literal["off", "on"] = quantity(
        "off", "1", "whether pairs do not attract where the pressure is negative and no free surface is near"
    )
    slip: Literal["free", "no"] = quantity("free", "1", "slip condition at the walls")
    hydrostatic_lift: Literal["balanced", "mirror"] = quantity(
        "balanced", "1", "how the hydrostatic pressure difference to the ghost is added"
    )
    ghost_velocity: Literal["corrected", "interpolated"] = quantity(
        "corrected", "1", "velocity of the ghosts: corrected so that walls do no spurious work, or as interpolated"
    )
    wall_treatment: Component = quantity(Component(name="fixed-ghosts"), "1", "how walls act on the fluid")
    tension: Literal["none", "bounded", "free"] = quantity(
        "bounded",
        "1",
        "whether walls hold fluid by negative pressure: not at all, down to a lowest pressure, or freely",
    )
    lowest_pressure: float = quantity(0.0, "Pa", 'lowest pressure at walls with tension = "bounded"', le=0)
    interpolator: Component = quantity(Component(name="improved-shepard"), "1", "boundary interpolation method")
    kernel: Component = quantity(Component(name="gaussian"), "1", "smoothing kernel")
    equation_of_state: Component = quantity(Component(name="linear"), "1", "equation of state")
    integrator: Component = quantity(Component(name="symplectic"), "1", "time integration scheme")
    guards: Guards = quantity(Guards(), "1", "what a run does when its state is not physical")
    time_step: float | None = quantity(None, "s", "fixed time step; by default adaptive by the Courant number", gt=0)
    courant_number: float | None = quantity(
        None, "1", "(c0 + |u|max) dt / h of the adaptive time step; by default the integrator's own", gt=0
    )
    until: float = quantity(..., "s", "time at which the run ends", gt=0)
    frame_interval: float = quantity(..., "s", "time between stored frames of all particles", gt=0)
    probe_interval: float = quantity(..., "s", "time between samples of probes, energies and diagnostics", gt=0)

    def __init__(self, **parameters: Any) -> None:
        try:
            super().__init__(**parameters)
        except ValidationError as error:
            raise InputError(explain(error, type(self))) from None

    @field_validator("acceleration", mode="before")
    @classmethod
    def _uniform_acceleration(cls, given: Any) -> Any:
        return {"name": "uniform", "vector": tuple(given)} if isinstance(given, list | tuple) else given

    @field_validator("*", mode="before")
    @classmethod
    def _no_boolean_numbers(cls, given: Any) -> Any:
        if isinstance(given, bool):
            raise ValueError("must be a number, a text or a table, not true or false")
        return given

    @model_validator(mode="wrap")
    @classmethod
    def _no_boolean_numbers_in_tables(cls, given: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        made = handler(given)
        for place in boolean_numbers(given, made):
            raise ValueError(f"{place.removeprefix('.')} must be a number, not true or false")
        return made

    @model_validator(mode="after")
    def _derive_defaults(self) -> Self:
        for name in type(self).model_fields:
            value = getattr(self, name)
            if isinstance(value, Derived):
                object.__setattr__(self, name, value.function(self))
        return self

    @abstractmethod
    def scene(self) -> Scene:
        """Return the walls, fluid, bodies and probes of the case."""

    def references(self) -> Mapping[str, Path]:
        """Return CSV files of p/(rho0 g H) over t sqrt(g/H) that are drawn with the probes, by the name to show."""
        return {}

    @property
    def gravity_vector(self) -> Array:
        """The acceleration of gravity (dim,), m/s^2.

        Raises
        ------
        InputError
            when it has another number of components.
        """
        try:
            return gravity_vector(self.gravity, self.dimension)
        except ValueError as error:
            raise InputError(str(error)) from None

    @property
    def weight(self) -> float:
        """The magnitude of gravity, m/s^2."""
        return math.hypot(*self.gravity) if isinstance(self.gravity, tuple) else self.gravity

    @property
    def upward(self) -> Array:
        """The unit vector (dim,) against gravity; along the last axis without gravity."""
        pressing = self.pressing_gravity
        g = math.hypot(*pressing)
        return pressing / -g if g > 0.0 else gravity_vector(-1.0, self.dimension)

    @property
    def pressing_gravity(self) -> Array:
        """The part of gravity (dim,) across the directions that repeat themselves, m/s^2, which pressure balances."""
        repeats = [axis in self.periodic for axis in "xyz"[: self.dimension]]
        return np.where(repeats, 0.0, self.gravity_vector)

    def reference_sound_speed(self, depth: float) -> float:
        """Return c0 in m/s: ``sound_speed``, or 20 sqrt(g H) for a still water ``depth`` H in m where it is None."""
        return self.sound_speed or 20.0 * math.sqrt(max(self.weight, 1e-12) * depth)

    @property
    def wall_method(self) -> str:
        """How walls are treated, in words."""
        if self.wall_treatment.name == "fixed-ghosts":
            return f"{self.interpolator.name} interpolation, {self.hydrostatic_lift} lift"
        return f"{self.wall_treatment.name} walls"

    def __repr_args__(self) -> Iterator[tuple[str | None, Any]]:
        """Show the parameters that were given; all others have their defaults."""
        for name, value in super().__repr_args__():
            if name in self.model_fields_set:
                given = isinstance(value, Component) and (value.model_dump() if value.options else value.name)
                yield name, given or value

    def _repr_html_(self) -> str:
        important = {
            "wall_treatment",
            "interpolator",
            "hydrostatic_lift",
            "particle_spacing",
            "until",
            *self.model_fields_set,
        }
        important |= type(self).model_fields.keys() - Case.model_fields.keys()
        every = parameters_of(self)
        title = f"{type(self).__name__}: {self.title}"
        first = html_table(title, Parameter._fields, [p for p in every if p.name in important])
        rest = html_table("", Parameter._fields, [p for p in every if p.name not in important])
        return f"{first}<details><summary>other parameters</summary>{rest}</details>"


class Parameter(NamedTuple):
    """A parameter of a case, in words."""

    name: str
    value: str
    unit: str
    meaning: str


def parameters_of(case: Case | type[Case]) -> list[Parameter]:
    """Return the parameters of a case with their values, or those of a case class with their defaults.

    Parameters that only this case has come first.

    Examples
    --------
    >>> from sphframe.cases import load_case
    >>> parameters_of(load_case("dam-break"))[0]
    Parameter(name='water_height', value='0.6', unit='m', meaning='height H of the water column')
    """
    model = case if isinstance(case, type) else type(case)
    own = [name for name in model.model_fields if name not in Case.model_fields]
    result = []
    for name in [*own, *Case.model_fields]:
        info = model.model_fields[name]
        value = written(info.default if isinstance(case, type) else getattr(case, name))
        result.append(Parameter(name, value, unit_of(info), info.description or ""))
    return result
