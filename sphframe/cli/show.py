"""CLI: ``sphframe show``."""

import inspect
import re
from pathlib import Path
from typing import Any

from pydantic import BaseModel
from pydantic_core import PydanticUndefined
from rich.console import Console
from rich.table import Table
from rich.text import Text

from sphframe.cases import Case, Component, Derived, load_case
from sphframe.registry import KINDS, available, load

__all__ = ["show_command"]


def show_command(name: str, preset: str | None) -> None:
    """Print the parameters of a case, or the options of a component."""
    kinds = [kind for kind in KINDS if any(entry.name == name for entry in available(kind))]
    if kinds and "cases" not in kinds:
        _show_component(kinds[0], name)
    elif Path(name).suffix in (".toml", ".nc"):
        case = load_case(name, preset)
        _show_case(type(case), name, case)
    else:
        model = load("cases", name)
        _show_case(model, name, load_case(name, preset) if preset else None)


def _show_case(model: type[Case], name: str, case: Case | None) -> None:
    """Print parameters with their values in ``case``, or their defaults; the case's own come first."""
    console = Console(highlight=False)
    console.print(f"{name}: {model.title}\n", markup=False)
    console.print(_prose(model.__doc__) + "\n", markup=False)
    table = Table(box=None, pad_edge=False)
    for heading in ("parameter", "default" if case is None else "value", "unit", "meaning"):
        table.add_column(heading, overflow="fold")
    own = [field for field in model.model_fields if field not in Case.model_fields]
    for field in [*own, *Case.model_fields]:
        info = model.model_fields[field]
        value = info.default if case is None else getattr(case, field)
        extra = info.json_schema_extra
        unit = str(extra.get("unit", "")) if isinstance(extra, dict) else ""
        table.add_row(field, Text(_written(value)), "" if unit == "1" else unit, Text(info.description or ""))
    console.print(table)
    for preset, values in model.presets.items():
        console.print(f"\n--preset {preset}", markup=False)
        for field, value in values.items():
            console.print(f"  {field} = {_written(value)}", markup=False)
    console.print(f"\nsphframe run {name} --set particle_spacing=0.02 --interpolator normalized", markup=False)


def _show_component(kind: str, name: str) -> None:
    component = load(kind, name)
    console = Console(highlight=False)
    console.print(f"{name}, one of {kind}\n", markup=False)
    console.print(_prose(component.__doc__) + "\n", markup=False)
    parameters = inspect.signature(component).parameters if inspect.isclass(component) else {}
    for parameter in parameters.values():
        default = "" if parameter.default is parameter.empty else f" = {parameter.default!r}"
        console.print(f"  {parameter.name}{default}", markup=False)


def _prose(docstring: str | None) -> str:
    """A docstring without examples and markup, paragraphs of prose on one line, equations and lists as they are."""
    text = inspect.cleandoc(docstring or "").partition("Examples\n---")[0].strip()
    text = re.sub(r":\w+:`~?([^`]+)`", r"\1", text).replace("``", "")
    as_written = re.compile(r"^\s|\n\s|\n---")
    blocks = (block if as_written.search(block) else " ".join(block.split()) for block in text.split("\n\n"))
    return "\n\n".join(blocks)


def _written(value: Any) -> str:
    """A value as it would be given, a derived default as its formula."""
    if value is PydanticUndefined:
        return "(required)"
    if isinstance(value, Derived):
        return value.text
    if isinstance(value, Component):
        table = value.model_dump()
        return value.name if len(table) == 1 else str(table)
    if isinstance(value, BaseModel):
        return ", ".join(f"{name} = {_written(inner)}" for name, inner in value)
    if value is None:
        return "(automatic)"
    if isinstance(value, tuple | dict) and not value:
        return "(none)"
    return f"{value:g}" if isinstance(value, float) else str(value)
