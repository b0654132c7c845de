"""CLI: ``sphframe show``."""

import inspect
import re
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from sphframe.cases import Case, load_case, parameters_of, written
from sphframe.cli.values import allow_imports_from_here
from sphframe.geometry import SHAPES
from sphframe.registry import KINDS, available, load


def show_command(name: str, preset: str | None) -> None:
    """Print the parameters of a case, the options of a component, or what a shape is made of."""
    allow_imports_from_here([name])
    if name in SHAPES:
        _show_shape(name)
        return
    kinds = [kind for kind in KINDS if any(entry.name == name for entry in available(kind))]
    if kinds and "cases" not in kinds:
        _show_component(kinds[0], name)
    elif Path(name).suffix.lower() in (".toml", ".nc"):
        case = load_case(name, preset)
        _show_case(type(case), name, case)
    else:
        model = load("cases", name)
        _show_case(model, name, load_case(name, preset) if preset else None)


def _show_case(model: type[Case], name: str, case: Case | None) -> None:
    """Print the parameters with their values in ``case``, or with their defaults; the case's own come first."""
    console = Console(markup=False, highlight=False)
    console.print(f"{name}: {model.title}\n", markup=False)
    console.print(_prose(model.__doc__) + "\n", markup=False)
    table = Table(box=None, pad_edge=False)
    for heading in ("parameter", "default" if case is None else "value", "unit", "meaning"):
        table.add_column(heading, overflow="fold")
    for name_of, value, unit, meaning in parameters_of(model if case is None else case):
        table.add_row(name_of, Text(value), unit, Text(meaning))
    console.print(table)
    for preset, values in model.presets.items():
        console.print(f"\n--preset {preset}", markup=False)
        for field, value in values.items():
            console.print(f"  {field} = {written(value)}", markup=False)
    console.print(f"\nsphframe run {name} --set particle_spacing=0.02 --interpolator normalized", markup=False)


def _show_component(kind: str, name: str) -> None:
    component = load(kind, name)
    console = Console(markup=False, highlight=False)
    console.print(f"{name}, one of {kind}\n", markup=False)
    console.print(_prose(component.__doc__) + "\n", markup=False)
    parameters = inspect.signature(component).parameters if inspect.isclass(component) else {}
    for parameter in parameters.values():
        default = "" if parameter.default is parameter.empty else f" = {parameter.default!r}"
        console.print(f"  {parameter.name}{default}", markup=False)


def _show_shape(name: str) -> None:
    model = SHAPES[name]
    console = Console(highlight=False)
    console.print(f'{name}, one of the shapes: shape = "{name}"\n', markup=False)
    console.print(_prose(model.__doc__) + "\n", markup=False)
    for field, info in model.model_fields.items():
        if field != "shape":
            console.print(f"  {field}{'' if info.is_required() else f' = {info.default!r}'}", markup=False)
    console.print(f"\nThe shapes: {', '.join(SHAPES)}", markup=False)


def _prose(docstring: str | None) -> str:
    """A docstring without examples and markup: prose paragraphs on one line, equations and lists unchanged."""
    text = inspect.cleandoc(docstring or "").partition("Examples\n---")[0].strip()
    text = re.sub(r":\w+:`~?([^`]+)`", r"\1", text).replace("``", "")
    as_written = re.compile(r"^\s|\n\s|\n---")
    blocks = (block if as_written.search(block) else " ".join(block.split()) for block in text.split("\n\n"))
    return "\n\n".join(blocks)
