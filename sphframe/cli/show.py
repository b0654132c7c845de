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


_OPTIONS = re.compile(r"(?:Attributes|Parameters)\n-+\n(.*?)(?=\n\n\w[^\n]*\n---|\n\n\n|\Z)", flags=re.DOTALL)
"""the section of a docstring that explains the options"""


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
    table, told = Table(box=None, pad_edge=False), meanings(component)
    for heading in ("option", "default", "meaning"):
        table.add_column(heading, overflow="fold")
    for parameter in parameters.values():
        default = "" if parameter.default is parameter.empty else repr(parameter.default)
        table.add_row(parameter.name, Text(default), Text(told.get(parameter.name, "")))
    if parameters:
        console.print(table)


def meanings(component: type) -> dict[str, str]:
    """Return what the docstring of ``component`` says about its options, below "Attributes" or "Parameters"."""
    section = re.search(_OPTIONS, _plain(component.__doc__))
    items = re.findall(r"^(\w[\w, ]*)\n((?: {4}.*\n?)+)", section[1] if section else "", flags=re.MULTILINE)
    return {name: " ".join(meaning.split()) for names, meaning in items for name in names.split(", ")}


def _show_shape(name: str) -> None:
    model = SHAPES[name]
    console = Console(highlight=False)
    console.print(f'{name}, one of the shapes: shape = "{name}"\n', markup=False)
    console.print(_prose(model.__doc__) + "\n", markup=False)
    for field, info in model.model_fields.items():
        if field != "shape":
            console.print(f"  {field}{'' if info.is_required() else f' = {info.default!r}'}", markup=False)
    console.print(f"\nThe shapes: {', '.join(SHAPES)}", markup=False)


def _plain(docstring: str | None) -> str:
    """Return a docstring without the markup of names."""
    return re.sub(r":\w+:`~?([^`]+)`", r"\1", inspect.cleandoc(docstring or "")).replace("``", "")


def _prose(docstring: str | None) -> str:
    """A docstring without options, examples and markup: prose paragraphs on one line, equations and lists unchanged."""
    text = re.sub(_OPTIONS, "", _plain(docstring).partition("Examples\n---")[0]).strip()
    text = re.sub(r"^Notes\n-+\n|^::\n\n", "", text, flags=re.MULTILINE)
    text = re.sub(r"\n{3,}", "\n\n", text).replace("::\n", ":\n")
    as_written = re.compile(r"^\s|\n\s|\n---")
    blocks = (block if as_written.search(block) else " ".join(block.split()) for block in text.split("\n\n"))
    return "\n\n".join(blocks)
