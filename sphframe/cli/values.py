"""CLI: parameters given as text."""

import os
import sys
import tomllib
from collections.abc import Iterable, Mapping
from typing import Any

from sphframe.errors import InputError
from sphframe.registry import is_address


def read_assignments(assignments: Iterable[str], options: Mapping[str, str | None]) -> dict[str, Any]:
    """Return the parameters that ``KEY=VALUE`` texts and options give; an option of None was not given.

    A value is read as TOML (0.01, true, "text", [1, 2], {name = "sfdi"}); if it is not valid TOML, it is a text.

    Raises
    ------
    InputError
        when a text is not an assignment, or a parameter is given twice.

    Examples
    --------
    >>> read_assignments(["particle_spacing=0.01", "interpolator.form=printed"], {"interpolator": "sfdi"})
    {'interpolator': 'sfdi', 'particle_spacing': 0.01, 'interpolator.form': 'printed'}
    """
    parameters = {name: _value(text) for name, text in options.items() if text is not None}
    for text in assignments:
        key, equals, value = text.partition("=")
        key = key.strip()
        if not equals or not all(key.split(".")):
            raise InputError(f"--set {text}: give it as KEY=VALUE, such as --set particle_spacing=0.01")
        if key in parameters:
            raise InputError(f"{key} is given twice; give it once")
        parameters[key] = _value(value.strip())
    return parameters


def listed(given: Iterable[str]) -> list[str]:
    """Return the names of an option that is repeatable and takes several names with commas.

    >>> listed(["sfdi,adami", "mdbc"])
    ['sfdi', 'adami', 'mdbc']
    """
    return [name for text in given for name in text.split(",") if name]


def allow_imports_from_here(names: Iterable[Any]) -> None:
    """Add the working directory to the end of the import path if a name has the form ``module:attribute``."""
    if any(isinstance(name, str) and is_address(name) for name in names) and os.getcwd() not in sys.path:
        sys.path.append(os.getcwd())


def _value(text: str) -> Any:
    try:
        table = tomllib.loads(f"value = {text}")
    except (tomllib.TOMLDecodeError, RecursionError):
        return text
    return table["value"] if set(table) == {"value"} else text
