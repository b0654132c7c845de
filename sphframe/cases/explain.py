"""Cases: what is wrong with the parameters of a case, in one line each."""

import re
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel, ValidationError

from sphframe.cases.parameters import unit_of
from sphframe.geometry import SHAPES
from sphframe.registry.nearest import did_you_mean

_LONGEST = 60


def explain(error: ValidationError, model: type[BaseModel]) -> str:
    """Return a message that says what was given, what was expected and how to fix it, one line per problem.

    Parameters
    ----------
    error
        what pydantic found.
    model
        the class of the case that was to be made.
    """
    problems = list(dict.fromkeys(_problems(error, model)))
    title = model.__name__
    if len(problems) == 1:
        return f"{title}: {problems[0]}"
    return f"{title}: {len(problems)} parameters are wrong:\n" + "\n".join(f"  {problem}" for problem in problems)


def plain(value: Any) -> str:
    """Return ``value`` as it would be written in a case file, shortened."""
    text = repr(value)
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."


def _problems(error: ValidationError, model: type[BaseModel]) -> Iterator[str]:
    details = error.errors(include_url=False, include_context=True)
    for detail in details:  # without the tags of alternatives
        detail["loc"] = tuple(part for part in detail["loc"] if not str(part).startswith("<"))
    places = [detail["loc"] for detail in details]
    for detail in details:
        if any(len(place) > len(detail["loc"]) and place[: len(detail["loc"])] == detail["loc"] for place in places):
            continue  # wrong items also make their list too short; only the items are reported
        place = _place(detail["loc"])
        given = detail["input"]
        kind = detail["type"]
        context = detail.get("ctx", {})
        field = model.model_fields.get(str(detail["loc"][0])) if detail["loc"] else None
        if kind == "extra_forbidden" and len(detail["loc"]) == 1:
            yield f"{place} is not a parameter{did_you_mean(place, model.model_fields)}"
        elif kind == "extra_forbidden":
            yield f"{place} = {plain(given)} is not known here; leave it out"
        elif kind == "missing":
            what = f": {field.description}" if field is not None and field.description else ""
            yield f"{place} is missing; give it a value{what if len(detail['loc']) == 1 else ''}"
        elif kind in ("union_tag_not_found", "union_tag_invalid"):
            tags = str(context.get("expected_tags", "'polygon', 'box'")).replace(", ", " or ")
            yield f"{place} has no known shape; give it shape = {tags}"
        elif kind == "value_error":
            yield f"{place} = {plain(given)}: {context.get('error')}" if place else str(context.get("error"))
        elif kind in ("too_short", "too_long"):
            fewest, most = context.get("min_length"), context.get("max_length")
            yield f"{place} = {plain(given)} must have {f'{fewest} or more' if fewest else f'{most} or fewer'} entries"
        else:
            expected = re.sub("^(Input|String|List|Dictionary|Tuple) should", "must", detail["msg"])
            expected = expected[0].lower() + expected[1:]
            unit = unit_of(field) if field is not None and len(detail["loc"]) == 1 else ""
            hint = f"; give the number in {unit}, without the unit" if kind == "float_parsing" and unit else ""
            yield f"{place} = {plain(given)} {_joined(expected)}{f' {unit}' if unit and not hint else ''}{hint}"


def _place(location: tuple[int | str, ...]) -> str:
    """Write a location as in Python, ``walls[0].points``, without the tags of unions of shapes."""
    text = ""
    for previous, part in zip((None, *location), location, strict=False):
        if isinstance(part, int):
            text += f"[{part}]"
        elif part in SHAPES and (isinstance(previous, int) or previous in ("of", "minus")):
            continue
        else:
            text += f".{part}" if text else str(part)
    return text


def _joined(expected: str) -> str:
    return expected if expected.startswith("must") else f"is wrong: {expected}"
