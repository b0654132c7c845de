"""Cases: how a parameter is declared, with its unit and meaning, and how its value is written."""

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from pydantic import BaseModel, ConfigDict, Discriminator, Field, model_serializer, model_validator
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from sphframe.registry import create


class Component(BaseModel):
    """A component chosen by name, with its options: ``"mls-linear"`` or ``{"name": "sfdi", "form": "printed"}``."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: str
    options: dict[str, Any] = {}

    @model_validator(mode="before")
    @classmethod
    def _from_name_or_table(cls, given: Any) -> Any:
        if isinstance(given, str):
            return {"name": given}
        if isinstance(given, Mapping) and "name" in given and not isinstance(given.get("options"), Mapping):
            return {"name": given["name"], "options": {k: v for k, v in given.items() if k != "name"}}
        return given

    def create(self, kind: str) -> Any:
        """Make the component of ``kind``, one of :data:`sphframe.registry.KINDS`, with its options.

        Raises
        ------
        InputError, PluginError
            as :func:`sphframe.registry.create` does.
        """
        return create(kind, self.name, **self.options)

    @model_serializer
    def _as_table(self) -> dict[str, Any]:
        return {"name": self.name, **self.options}


@dataclass(frozen=True)
class Derived:
    """A default that follows from other parameters: ``Derived("2 depth", lambda case: 2 * case.depth)``."""

    text: str
    function: Callable[[Any], Any]


def quantity(default: Any, unit: str, description: str, **bounds: Any) -> Any:
    """Declare a parameter with its unit; ``default`` may be ``...`` for a required one, or :class:`Derived`."""
    return Field(default, description=description, json_schema_extra={"unit": unit}, **bounds)


def downward_gravity(default: float = 9.81) -> Any:
    """Declare ``gravity`` as a number, for a case that is drawn for gravity along the last axis."""
    return quantity(default, "m s-2", "acceleration of gravity, downwards along the last axis", ge=0)


def with_default(model: type[BaseModel], name: str, default: Any) -> Any:
    """Declare again the parameter ``name`` of ``model`` with another default: same unit, meaning and bounds."""
    info = model.model_fields[name]
    bounds = {
        key: value
        for bound in info.metadata
        if not isinstance(bound, Discriminator)
        for key, value in asdict(bound).items()
    }
    return quantity(default, unit_of(info), info.description or "", **bounds)


def unit_of(info: FieldInfo) -> str:
    """Return the unit of a parameter declared by :func:`quantity`; empty where it is dimensionless."""
    extra = info.json_schema_extra
    unit = str(extra.get("unit", "")) if isinstance(extra, dict) else ""
    return "" if unit == "1" else unit


def written(value: Any) -> str:
    """Return a value as it would be given; for a derived default its formula."""
    if value is PydanticUndefined:
        return "(required)"
    if isinstance(value, Derived):
        return value.text
    if isinstance(value, Component):
        table = {name: _shortened(option) for name, option in value.model_dump().items()}
        return value.name if len(table) == 1 else str(table)
    if isinstance(value, BaseModel):
        return ", ".join(f"{name} = {written(inner)}" for name, inner in value)
    if value is None:
        return "(automatic)"
    if isinstance(value, tuple | dict) and not value:
        return "(none)"
    if isinstance(value, dict):
        return ", ".join(f"{name} = {written(inner)}" for name, inner in value.items())
    return f"{value:g}" if isinstance(value, float) else str(value)


def _shortened(option: Any) -> Any:
    """Return an option as it is; for a long text, such as the contents of a file, its length and hash."""
    if not isinstance(option, str) or len(option) <= 100:
        return option
    return f"{len(option)} characters, sha256 {hashlib.sha256(option.encode()).hexdigest()[:16]}"
