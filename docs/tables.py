"""Documentation: writes the tables of keys, components, cases and variables, in ``generated/``, from the code."""

import dataclasses
import importlib
import inspect
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from sphinx.pycode import ModuleAnalyzer

import sphframe
from sphframe.analysis.figures import printed_unit
from sphframe.cases import Case, Custom, ExactCase, Gauge, Guards, OpenBoundaries, Probe, WallPart, parameters_of
from sphframe.cases.parameters import written
from sphframe.cli.show import meanings
from sphframe.geometry import SHAPES, Region, Wall
from sphframe.geometry.regions import InitialState
from sphframe.geometry.walls import BoxWall, CylinderWall, Drawn, PolygonWall
from sphframe.output.schema import VARIABLES
from sphframe.registry import available, load

KINDS = {
    "interpolators": "interpolator",
    "wall_treatments": "wall_treatment",
    "kernels": "kernel",
    "equations_of_state": "equation_of_state",
    "integrators": "integrator",
    "rigid_bodies": "body",
    "body_forces": "acceleration",
}
"""kinds of components, and the key of a case that chooses one"""
MODULES = ("sphframe", "analysis", "cases", "geometry", "studies", "testing")
FILES = ("case", "tables", "shapes", "cases", *KINDS, "variables", *(f"api_{module}" for module in MODULES))

_WALLS = "Each wall has a `shape` with [its keys](gallery_shapes.md), and may have"
_FLUID = "Each region of fluid has a closed `shape` with [its keys](gallery_shapes.md), and may have"


def write(folder: Path) -> None:
    """Write a Markdown file for each of :data:`FILES`."""
    folder.mkdir(exist_ok=True)
    contents = {
        "case": _case_keys(),
        "tables": _tables_of_a_case(),
        "shapes": _shapes(),
        "cases": _cases(),
        "variables": _variables(),
        **{kind: _components(kind) for kind in KINDS},
        **{f"api_{module}": _summary(module) for module in MODULES},
    }
    for name in FILES:
        path = folder / f"{name}.md"
        if not path.exists() or path.read_text(encoding="utf-8") != contents[name]:
            path.write_text(contents[name], encoding="utf-8")


def _table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    cells = (" | ".join(" ".join(cell.replace("|", "\\|").split()) for cell in row) for row in rows)
    return "\n".join(
        [f"| {' | '.join(headings)} |", f"|{'---|' * len(headings)}", *(f"| {row} |" for row in cells), ""]
    )


def _code(text: str) -> str:
    return f"`{text}`" if text else ""


def _markdown(text: str) -> str:
    """Return text of a docstring as Markdown."""
    text = re.sub(r":\w+:`~?(?:[\w.]*\.)?(\w+)(?: <[^>]*>)?`", r"`\1`", text).replace("``", "`")
    return re.sub(r"\^([23])(?!\d)", lambda power: "²³"[int(power[1]) - 2], text).replace(" * ", " \\* ")


def _first_sentence(component: Any) -> str:
    text = (inspect.getdoc(component) or "").partition("\n\n")[0].replace("\n", " ")
    return _markdown(text.removesuffix("::"))


def _prose(component: Any) -> str:
    """Return the text of a docstring before its sections, as Markdown."""
    return _markdown(re.split(r"\n\n\w+\n---", inspect.getdoc(component) or "")[0])


def _values(annotation: Any) -> list[str]:
    """Return the values that a type lists."""
    if get_origin(annotation) is Literal:
        return [f'"{value}"' if isinstance(value, str) else str(value) for value in get_args(annotation)]
    if get_origin(annotation) in (Union, UnionType, Annotated, tuple):
        return [value for inner in get_args(annotation) for value in _values(inner)]
    return []


def _attribute_docs(model: type) -> dict[str, str]:
    """Return the docstrings below the fields of a class and of those that it extends."""
    found: dict[str, str] = {}
    for base in reversed(model.__mro__):
        if base.__module__.startswith("sphframe"):
            analyzer = ModuleAnalyzer.for_module(base.__module__)
            docs = analyzer.find_attr_docs().items()
            found |= {name: " ".join(lines).strip() for (owner, name), lines in docs if owner == base.__name__}
    return found


def _fields(model: type[BaseModel], names: Iterable[str]) -> str:
    """Return the table of some fields of a model."""
    docs = _attribute_docs(model)
    rows = []
    for name in names:
        info = model.model_fields[name]
        default = "required" if info.is_required() else _code(_as_toml(info.default))
        allowed = ", ".join(map(_code, _values(info.annotation)))
        meaning = _markdown(info.description or docs.get(name, ""))
        rows.append((_code(name), default, f"{meaning}{': ' if meaning and allowed else ''}{allowed}"))
    return _table(("key", "default", "meaning"), rows)


def _as_toml(value: Any) -> str:
    if value is None or value in ((), {}, ""):
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return f"[{', '.join(_as_toml(inner) for inner in value)}]"
    return f'"{value}"' if isinstance(value, str) else written(value)


def _case_keys() -> str:
    rows = []
    for name, value, unit, meaning in parameters_of(Custom):
        info = Custom.model_fields[name]
        allowed = ", ".join(map(_code, _values(info.annotation)))
        default = {"(required)": "required", "(automatic)": "", "(none)": ""}.get(value, _code(value))
        default = "[table](#guards)" if name == "guards" else default
        rows.append(
            (_code(name), default, printed_unit(unit), _markdown(meaning) + (f": {allowed}" if allowed else ""))
        )
    return _table(("key", "default", "unit", "meaning"), rows)


def _tables_of_a_case() -> str:
    sections = {
        "walls": (
            Drawn,
            list(Drawn.model_fields),
            "Each wall is one of the [shapes](#shapes-of-walls-and-fluid) and may have",
        ),
        "fluid": (InitialState, list(InitialState.model_fields), _FLUID),
        "probes": (Probe, list(Probe.model_fields), ""),
        "gauges": (Gauge, list(Gauge.model_fields), ""),
        "wall_parts": (WallPart, list(WallPart.model_fields), ""),
        "open_boundaries": (OpenBoundaries, list(OpenBoundaries.model_fields), ""),
        "guards": (Guards, list(Guards.model_fields), ""),
    }
    parts = []
    for name, (model, names, text) in sections.items():
        about = text or _first_sentence(model)
        end = "" if about.endswith(".") else ":"
        heading = f"[[{name}]]" if name not in ("open_boundaries", "guards") else f"[{name}]"
        parts.append(f"({name})=\n\n### `{heading}`\n\n{about}{end}\n\n{_fields(model, names)}")
    return "\n".join(parts)


def _shapes() -> str:
    """Return a section for each shape: picture, keys, and whether it can be a wall, fluid or both."""
    walls, regions = ({_shape(model) for model in get_args(get_args(kind)[0])} for kind in (Wall, Region))
    special = {"box": BoxWall, "polygon": PolygonWall, "cylinder": CylinderWall}
    parts = []
    for name, model in SHAPES.items():
        drawn = [name for name in model.model_fields if name not in ("shape", "sha256") and not _filled_in(model, name)]
        used = " or ".join(word for word, names in (("a wall", walls), ("fluid", regions)) if name in names)
        parts.append(f"## {name}\n\n{_prose(model)} It can be {used}.\n\n{_fields(model, drawn)}")
        if wall := special.get(name):
            own = [key for key in wall.model_fields if key not in model.model_fields and key not in Drawn.model_fields]
            parts.append(f"As a wall also:\n\n{_fields(wall, own)}")
        if (Path(__file__).parent / f"shapes/{name}.png").is_file():
            parts.append(f"![{name}: walls, ghosts with their mirror points, and fluid](shapes/{name}.png)\n")
            parts.append(f"```{{literalinclude}} shapes/{name}.toml\n:language: toml\n```\n")
    return "\n".join(parts)


def _shape(model: type[BaseModel]) -> str:
    return str(model.model_fields["shape"].default)


def _filled_in(model: type[BaseModel], name: str) -> bool:
    return name == "points" and "file" in model.model_fields


def _cases() -> str:
    rows = []
    for entry in available("cases"):
        model: type[Case] = load("cases", entry.name)
        extra = [f"preset `{name}`" for name in model.presets]
        extra += ["exact solution"] if issubclass(model, ExactCase) else []
        rows.append((_code(entry.name), model.title, ", ".join(extra), entry.distribution))
    return _table(("case", "what it is", "", "package"), rows)


def _components(kind: str) -> str:
    """Return the table of the components of a kind, and a table of the options of each that has some."""
    entries = available(kind)
    loaded = {entry.name: load(kind, entry.name) for entry in entries}
    rows = [(_code(entry.name), _first_sentence(loaded[entry.name]), entry.distribution) for entry in entries]
    options = []
    for name, component in loaded.items():
        told = meanings(component)
        hints = (
            {field.name: field.type for field in dataclasses.fields(component)}
            if dataclasses.is_dataclass(component)
            else {}
        )
        for option, parameter in inspect.signature(component).parameters.items() if _takes_options(component) else ():
            default = getattr(parameter.default, "text", parameter.default)
            default = "required" if parameter.default is parameter.empty else _code(_as_toml(default))
            allowed = ", ".join(map(_code, _values(hints.get(option, parameter.annotation))))
            meaning = _markdown(told.get(option, ""))
            options.append((_code(name), _code(option), default, meaning + (f" {allowed}" if allowed else "")))
    text = _table(("name", "what it is", "package"), rows)
    return f"{text}\n{_table(('name', 'option', 'default', 'meaning'), options)}" if options else text


def _takes_options(component: type) -> bool:
    return component.__init__ is not object.__init__  # type: ignore[misc]


def _variables() -> str:
    rows = []
    for name, variable in VARIABLES.items():
        unit = (
            ""
            if variable.unit == "1"
            else printed_unit(variable.unit) + (" (in 2-D per m)" if variable.per_width else "")
        )
        rows.append((_code(name), ", ".join(variable.dimensions), unit, variable.long_name))
    return _table(("variable", "dimensions", "unit", "meaning"), rows)


def _summary(module: str) -> str:
    """Return a table of the public names of a module, each with its first line and a link."""
    path = "sphframe" if module == "sphframe" else f"sphframe.{module}"
    public = importlib.import_module(path)
    rows = []
    for name in sorted(public.__all__, key=str.lower):
        value = getattr(public, name)
        if callable(value) and getattr(value, "__module__", "").startswith("sphframe"):
            home = "sphframe" if name in sphframe.__all__ else path
            rows.append((f"{{py:obj}}`{name} <{home}.{name}>`", _first_sentence(value)))
    return _table(("name", "what it is"), rows)
