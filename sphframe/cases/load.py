"""Cases: from a name, a TOML file or an output file, a preset and overrides, to a checked case."""

import json
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from sphframe.cases.case import Case, Parameter, parameters_of
from sphframe.cases.checks import check_case
from sphframe.cases.parameters import Component
from sphframe.errors import InputError
from sphframe.geometry import SHAPES
from sphframe.input_files import text_of
from sphframe.registry import is_address, load
from sphframe.registry.nearest import did_you_mean


def load_case(
    source: str | Path | Case,
    preset: str | None = None,
    overrides: Mapping[str, Any] | None = None,
    *,
    trusted: bool = False,
) -> Case:
    """Return the case that ``source`` names, checked.

    Parameters
    ----------
    source
        the name of an installed case; a path that ends in ``.toml``, a case file (see ``read_toml``); a path
        that ends in ``.nc``, an output of sphframe whose run is to be repeated; or a case.
    preset
        name of one of the case's presets.
    trusted
        whether a file may name components as ``module:attribute``, whose code is then imported.
    overrides
        parameters by name, ``interpolator.mu`` for an option of a component or any other value in a table.

    Notes
    -----
    Where the same parameter is given twice, overrides come before the preset, and the preset before the source.

    A file is data: nothing in it is executed, and it names components by their installed names only.

    Raises
    ------
    InputError
        when a parameter is unknown, missing, of the wrong type, outside its bounds, or contradicts another;
        when a file cannot be read, or names a component as ``module:attribute``.
    PluginError
        when the case or a component is not installed or broken.

    Examples
    --------
    >>> case = load_case("hydrostatic-tank", "paper", {"particle_spacing": 0.02, "equation_of_state.name": "tait"})
    >>> case.until, case.particle_spacing, case.equation_of_state.name
    (35.0, 0.02, 'tait')
    """
    if isinstance(source, Case):
        model = type(source)
        parameters = {name: getattr(source, name) for name in source.model_fields_set}
    elif (kind := Path(source).suffix.lower()) in (".toml", ".nc"):
        name, file_preset, parameters = read_toml(source) if kind == ".toml" else _read_output(Path(source))
        if kind == ".toml":
            parameters = _beside(parameters, Path(source).parent)
        if not trusted:
            _refuse_addresses(source, name, parameters, overrides or {})
        model = load("cases", name)
        parameters = {**_preset(model, file_preset), **parameters}
    else:
        model, parameters = load("cases", str(source)), {}
    parameters = {**parameters, **_preset(model, preset)}
    case: Case = model(**_merged(model, parameters, overrides or {}))
    case = _with_contents(case, Path(source).parent if isinstance(source, str | Path) else Path())
    check_case(case)
    return case


def describe(case: str | Case | type[Case]) -> list[Parameter]:
    """Return the parameters of a case, given by name, as a class or as an object, with their values or defaults.

    Examples
    --------
    >>> describe("dam-break")[0]
    Parameter(name='water_height', value='0.6', unit='m', meaning='height H of the water column')
    """
    return parameters_of(load("cases", case) if isinstance(case, str) else case)


def _beside(value: Any, folder: Path) -> Any:
    """Return the tables of a case file with the files that its shapes name looked for beside it."""
    if isinstance(value, list):
        return [_beside(item, folder) for item in value]
    if not isinstance(value, dict):
        return value
    found = {key: _beside(item, folder) for key, item in value.items()}
    if str(value.get("shape")) in SHAPES and isinstance(value.get("file"), str):
        found["file"] = str(folder / value["file"])
    return found


def _with_contents(case: Case, folder: Path) -> Case:
    """Return the case with the contents of the files that its components read; ``folder`` is that of the case file."""
    force = case.acceleration
    options = load("body_forces", force.name).with_contents(force.options, folder)
    if options != force.options:
        case = case.model_copy(update={"acceleration": Component(name=force.name, options=options)})
    bodies = getattr(case, "bodies", None)
    if not isinstance(bodies, Mapping) or not all(isinstance(body, Component) for body in bodies.values()):
        return case
    complete = {
        name: Component(name=body.name, options=load("rigid_bodies", body.name).with_contents(body.options, folder))
        for name, body in bodies.items()
    }
    return case.model_copy(update={"bodies": complete}) if complete else case


def read_toml(path: str | Path) -> tuple[str, str | None, dict[str, Any]]:
    """Return the name of the case, the preset and the parameters of a case file.

    The key ``case`` names the case (default ``"custom"``), ``preset`` a preset; all others are parameters, components
    and walls as tables::

        case = "dam-break"
        particle_spacing = 0.02

        [interpolator]
        name = "improved-shepard"
        mu = 2.0

    Raises
    ------
    InputError
        when the file does not exist, is not TOML, or its ``case`` or ``preset`` is not a text.
    """
    path = Path(path)
    try:
        parameters = tomllib.loads(text_of(path))
    except (OSError, ValueError) as error:  # ValueError: of TOML and of UTF-8, and a null character in the path
        raise InputError(f"cannot read the case file {path}: {_reason(error)}") from None
    except RecursionError:
        raise InputError(f"cannot read the case file {path}: its values are nested too deeply") from None
    name = parameters.pop("case", "custom")
    preset = parameters.pop("preset", None)
    for key, value in (("case", name), ("preset", preset)):
        if not isinstance(value, str | None):
            raise InputError(f'{path}: {key} = {value!r} must be a text, such as {key} = "paper"')
    return name, preset, parameters


def _reason(error: Exception) -> str:
    if isinstance(error, FileNotFoundError):
        return "there is no such file"
    if isinstance(error, OSError):
        return (error.strerror or str(error)).lower()
    if isinstance(error, UnicodeDecodeError):
        return f"it is not a text in UTF-8 (byte {error.start})"
    return f"it is not valid TOML: {error}"


def _read_output(path: Path) -> tuple[str, None, dict[str, Any]]:
    import netCDF4  # takes a tenth of a second, needed only here

    try:
        with netCDF4.Dataset(path) as dataset:
            name, text = dataset.case_name, dataset.case_parameters
    except FileNotFoundError:
        raise InputError(f"cannot read {path}: there is no such file") from None
    except AttributeError:
        raise InputError(
            f"{path} was not written by sphframe: it has no attributes case_name and case_parameters"
        ) from None
    except (OSError, ValueError, RuntimeError) as error:
        raise InputError(f"cannot read {path}: it is not a NetCDF file, or is damaged ({error})") from None
    try:
        parameters = json.loads(text)
    except (ValueError, TypeError, RecursionError):
        parameters = None
    if not isinstance(name, str) or not isinstance(parameters, dict):
        raise InputError(f"{path}: its attributes case_name and case_parameters are damaged; run the case by name")
    return name, None, parameters


def _refuse_addresses(
    source: str | Path, name: str, parameters: Mapping[str, Any], overrides: Mapping[str, Any]
) -> None:
    """Refuse ``module:attribute`` in a file: a file from an unknown source must not make sphframe import code."""
    named = {"case": name, **{key: value for key, value in parameters.items() if key not in overrides}}
    bodies = named.pop("bodies", None)
    if isinstance(bodies, Mapping):
        named.update({f"bodies.{key}": value for key, value in bodies.items()})
    for key, value in named.items():
        component = value.get("name") if isinstance(value, Mapping) else value
        if isinstance(component, str) and is_address(component):
            how = (
                "give that address to run" if key == "case" else f"give it on the command line: --set {key}={component}"
            )
            raise InputError(f"{source}: {key} = {component!r} is the address of code, not an installed name; {how}")


def _preset(model: type[Case], name: str | None) -> Mapping[str, Any]:
    if name is None:
        return {}
    if name not in model.presets:
        known = f"its presets: {', '.join(model.presets)}" if model.presets else "it has none"
        raise InputError(f"{model.__name__} has no preset {name!r}{did_you_mean(name, model.presets)} {known}")
    return model.presets[name]


def _merged(model: type[Case], parameters: Mapping[str, Any], overrides: Mapping[str, Any]) -> dict[str, Any]:
    merged = dict(parameters)
    merged.update((key, value) for key, value in overrides.items() if "." not in key)
    for key, value in overrides.items():
        first, dot, rest = key.partition(".")
        if dot:
            merged[first] = _with_value(key, _as_table(model, first, merged), rest.split("."), value)
    return merged


def _as_table(model: type[Case], name: str, parameters: Mapping[str, Any]) -> Any:
    if name not in model.model_fields:
        raise InputError(f"{name} is not a parameter{did_you_mean(name, model.model_fields)}")
    value = parameters.get(name, model.model_fields[name].default)
    if isinstance(value, BaseModel):
        return value.model_dump()
    return {"name": value} if isinstance(value, str) and model.model_fields[name].annotation is Component else value


def _with_value(key: str, table: Any, path: list[str], value: Any) -> dict[str, Any]:
    if not isinstance(table, Mapping):
        raise InputError(f"{key}: nothing can be set inside {key.partition('.')[0]}, which is not a table")
    first, *rest = path
    inner = value if not rest else _with_value(key, table.get(first, {}), rest, value)
    return {**table, first: inner}
