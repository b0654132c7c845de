"""Registry: the options of a component are checked before it is made.

Options are the parameters of the component's constructor, most simply the fields of a dataclass.
"""

import dataclasses
import inspect
import typing
from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import BaseModel, ConfigDict, PydanticUserError, TypeAdapter, ValidationError

from sphframe.errors import BrokenPluginError, InputError, SphframeError
from sphframe.registry.nearest import did_you_mean

_CONFIG = ConfigDict(allow_inf_nan=False, arbitrary_types_allowed=True)


def construct(component: type, label: str, given: Mapping[str, Any]) -> Any:
    """Make ``component`` with the options ``given``; ``label`` names it in messages.

    Raises
    ------
    InputError
        when an option is unknown, missing, of the wrong type, not finite, or refused by the constructor.
    BrokenPluginError
        when the constructor fails otherwise.
    """
    known = _parameters(component)
    open_ended = any(parameter.kind is parameter.VAR_KEYWORD for parameter in known.values())
    options = {name: p for name, p in known.items() if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)}
    for name in given:
        if name not in options and not open_ended:
            ending = _not_a_field(component, name) or did_you_mean(name, options)
            raise InputError(f"{label} has no option {name!r}{ending} {_described(options)}")
    missing = [name for name, p in options.items() if p.default is p.empty and name not in given]
    if missing:
        raise InputError(f"{label} needs {', '.join(map(repr, missing))}. {_described(options)}")
    hints = {} if issubclass(component, BaseModel) else _hints(component)
    values = {
        name: _checked(f"{label}: {name}", value, hints[name]) if name in hints else value
        for name, value in given.items()
    }
    try:
        return component(**values)
    except ValidationError as error:
        problems = [f"{'.'.join(map(str, e['loc'])) or 'options'}: {_lower(e['msg'])}" for e in error.errors()]
        raise InputError(f"{label}: {'; '.join(problems)}") from error
    except (ValueError, TypeError) as error:
        unnamed = [f"{name} = {value!r}" for name, value in values.items() if name not in str(error)]
        raise InputError(f"{label}{' with ' if unnamed else ''}{', '.join(unnamed)}: {error}") from error
    except SphframeError:
        raise
    except Exception as error:
        raise BrokenPluginError(f"{label} cannot be made: {type(error).__name__}: {error}") from error


def _checked(what: str, value: Any, hint: Any) -> Any:
    """Return ``value`` as an object of the type ``hint``; "4" and 4 are accepted as floats, true is not."""
    choices = [hint, *typing.get_args(hint)]
    expected = hint.__name__ if isinstance(hint, type) else str(hint).replace("typing.", "")
    if isinstance(value, bool) and (int in choices or float in choices) and bool not in choices:
        raise InputError(f"{what} = {value!r}: input should be a number; expected {expected}")
    try:
        adapter = TypeAdapter[Any](hint, config=_CONFIG)
    except PydanticUserError:  # pydantic cannot check this type
        return value
    try:
        checked = adapter.validate_python(value)
        for place in boolean_numbers(value, checked):
            raise InputError(f"{what}{place} is true or false, and should be a number; expected {expected}")
        return checked
    except ValidationError as error:
        problems = {_lower(e["msg"]) for e in error.errors()}
        raise InputError(f"{what} = {value!r}: {'; '.join(sorted(problems))}; expected {expected}") from error


def boolean_numbers(given: Any, made: Any, place: str = "") -> Iterator[str]:
    """Yield the places where ``given`` has true or false and ``made``, which pydantic made of it, has a number.

    >>> list(boolean_numbers({"radius": 1.0, "centre": [0.0, True]}, {"radius": 1.0, "centre": (0.0, 1.0)}))
    ['.centre[1]']
    """
    if isinstance(given, bool):
        if isinstance(made, int | float) and not isinstance(made, bool):
            yield place
    elif isinstance(given, Mapping):
        for key, inner in given.items():
            found = made.get(key) if isinstance(made, Mapping) else getattr(made, str(key), None)
            yield from boolean_numbers(inner, found, f"{place}.{key}")
    elif isinstance(given, list | tuple) and isinstance(made, list | tuple):
        for number, (inner, found) in enumerate(zip(given, made, strict=False)):
            yield from boolean_numbers(inner, found, f"{place}[{number}]")


def _parameters(component: type) -> Mapping[str, inspect.Parameter]:
    if component.__init__ is object.__init__:  # type: ignore[misc]
        return {}
    return inspect.signature(component).parameters


def _hints(component: type) -> dict[str, Any]:
    """Types of the options; empty where an annotation cannot be evaluated; then only the constructor checks."""
    source = component if dataclasses.is_dataclass(component) else component.__init__  # type: ignore[misc]
    try:
        return typing.get_type_hints(source, include_extras=True)
    except (NameError, TypeError, AttributeError):
        return {}


def _described(options: Mapping[str, inspect.Parameter]) -> str:
    if not options:
        return "It takes no options"
    values = {name: getattr(p.default, "text", p.default) for name, p in options.items()}
    listed = [f"{name} = {value!r}" if value is not inspect.Parameter.empty else name for name, value in values.items()]
    return f"Its options: {', '.join(listed)}"


def _not_a_field(component: type, name: str) -> str:
    if name in vars(component).get("__annotations__", {}) and not dataclasses.is_dataclass(component):
        return f": write @dataclass(frozen=True) above {component.__name__} to make its fields options."
    return ""


def _lower(message: str) -> str:
    return message[:1].lower() + message[1:]
