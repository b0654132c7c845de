"""Testing: report on all checks of components that are chosen by name."""

import dataclasses
import itertools
import re
import typing
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from sphframe.errors import InputError, PluginError, SphframeError, UnknownComponentError
from sphframe.interfaces import BoundaryInterpolator, WallTreatment
from sphframe.registry import available, create, find, load
from sphframe.testing.ghost_response import GhostResponse, ghost_responses
from sphframe.testing.proof import BrokenPromiseError
from sphframe.testing.suite import Check, checks_of
from sphframe.testing.wall_treatments import WallResiduals, wall_residuals

KINDS = (
    "interpolators",
    "wall_treatments",
    "kernels",
    "equations_of_state",
    "integrators",
    "rigid_bodies",
    "body_forces",
    "cases",
)
MEASURED_WITH = {"gaussian": 1.3, "wendland-c2": 2.0}
"""the kernels with which errors of wall treatments are measured, with h over the particle spacing"""
FIRST = ("traits", "compiles", "steps", "motion", "force", "starts")
"""checks without which all others would fail for the same reason"""
Verdict = Literal["kept", "held", "broken", "absent", "expected"]


@dataclass(frozen=True)
class Result:
    """The result of one check."""

    check: Check
    failure: str | None
    """why the component lacks the property; None where it has the property"""
    expected: str | None = None
    """why the check is expected to fail; it is then ``broken`` where it succeeds"""

    @property
    def verdict(self) -> Verdict:
        """``kept`` or ``broken`` for a declared property, ``held`` or ``absent`` for one that is not declared.

        ``expected`` for a failure that was expected.
        """
        if self.expected is not None:
            return "broken" if self.failure is None else "expected"
        if self.check.promised:
            return "kept" if self.failure is None else "broken"
        return "held" if self.failure is None else "absent"


@dataclass(frozen=True)
class Report:
    """All results of one component, or the error that prevented its checks."""

    name: str
    kind: str
    distribution: str
    results: tuple[Result, ...]
    error: str | None = None
    measured: Mapping[str, WallResiduals] = field(default_factory=dict)
    """errors of a wall treatment at a straight bed, by kernel"""
    responses: tuple[GhostResponse, ...] = ()
    """what an interpolation method makes of errors of the particles, in each layer of ghosts"""

    @property
    def broken(self) -> bool:
        """Whether the component lacks a declared property or could not be checked."""
        return self.error is not None or any(result.verdict == "broken" for result in self.results)

    def verdicts(self) -> dict[str, Verdict]:
        """Return the worst verdict over all dimensions for each property."""
        worst = ("held", "kept", "absent", "expected", "broken")
        found: dict[str, Verdict] = {}
        for result in self.results:
            name = result.check.name
            found[name] = max(found.get(name, result.verdict), result.verdict, key=worst.index)
        return found

    def as_data(self) -> dict[str, Any]:
        """Return the report as plain data, for JSON."""
        return {
            "name": self.name,
            "kind": self.kind,
            "distribution": self.distribution,
            "broken": self.broken,
            "error": self.error,
            "properties": self.verdicts(),
            "measured": {kernel: residuals._asdict() for kernel, residuals in self.measured.items()},
            "responses": [response._asdict() for response in self.responses],
            "checks": [
                {
                    "check": result.check.name,
                    "dim": result.check.dim,
                    "promised": result.check.promised,
                    "verdict": result.verdict,
                    "failure": result.failure,
                    "expected": result.expected,
                }
                for result in self.results
            ],
        }


def verify(
    names: Sequence[str] = (),
    *,
    progress: Callable[[str], None] | None = None,
    callback: Callable[[str, Result], None] | None = None,
    expected_failed_checks: Mapping[str, str] | None = None,
) -> Iterator[Report]:
    """Run all checks of the components with ``names`` and yield one report per component.

    Parameters
    ----------
    names
        registered names, ``module:attribute``, or either with options as in ``sfdi[form=printed]``; of interpolation
        methods, wall treatments, kernels, equations of state, integrators, rigid bodies, body forces and cases; or
        a kind, such as ``wall_treatments``, for all that are installed, once for each value of an option that has a
        list of values. Without names: all interpolation methods and wall treatments.
    progress
        called with a line of text before each component and check.
    callback
        called with the label of the component and the result after each check.
    expected_failed_checks
        checks that are expected to fail, such as ``"continuity-3d"`` or ``"continuity"``, each with
        the reason; one that succeeds is reported as broken.

    Raises
    ------
    UnknownComponentError
        when nothing has one of the names.
    """
    expected = expected_failed_checks or {}

    def finished(label: str, check: Check, failure: str | None) -> Result:
        result = Result(check, failure, expected.get(str(check), expected.get(check.name)))
        if callback is not None:
            callback(label, result)
        return result

    for kind, label, name, options in choices(names):
        yield _report(kind, label, name, options, progress or (lambda text: None), finished)


_Choice = tuple[str, str, str, dict[str, Any]]


def choices(names: Sequence[str]) -> list[_Choice]:
    """Return kind, label, name and options of the components with ``names`` as for :func:`verify`."""
    chosen: list[_Choice] = []
    for name in names or ("interpolators", "wall_treatments"):
        chosen += _installed(name) if name in KINDS else [_find(name)]
    return chosen


def parse_label(label: str) -> tuple[str, dict[str, Any]]:
    """Return name and options of ``NAME`` or ``NAME[option=value,...]``.

    Raises
    ------
    InputError
        when it is of another form.
    """
    match = re.fullmatch(r"([^\[\]]+)(?:\[(.*)\])?", label)
    if not match:
        raise InputError(f"{label!r} is not of the form NAME or NAME[option=value,...]")
    name, listed = match.group(1), match.group(2)
    options: dict[str, Any] = {}
    for item in filter(None, (listed or "").split(",")):
        key, equals, value = item.partition("=")
        if not equals:
            raise InputError(f"{item!r} in {label!r} is not of the form option=value")
        options[key.strip()] = value.strip()
    return name, options


def _find(label: str) -> _Choice:
    name, options = parse_label(label)
    if ":" in name:
        return _kind_of_address(name), label, name, options
    for kind in KINDS:
        if any(entry.name == name for entry in available(kind)):
            return kind, label, name, options
    find("interpolators", name)  # raises, with the nearest names
    raise UnknownComponentError(f"nothing is called {name!r}")


def _kind_of_address(name: str) -> str:
    """The first kind whose interface the class implements; the error of the first kind when there is none."""
    first: PluginError | None = None
    for kind in KINDS:
        try:
            load(kind, name)
        except PluginError as error:
            first = first or error
        else:
            return kind
    assert first is not None
    raise first


def _installed(kind: str) -> Iterator[_Choice]:
    for entry in available(kind):
        try:
            variants = list(_variants(load(kind, entry.name)))
        except PluginError:
            variants = [{}]  # the report contains the error
        for options in variants:
            listed = ",".join(f"{key}={value}" for key, value in options.items())
            yield kind, f"{entry.name}[{listed}]" if listed else entry.name, entry.name, options


def _variants(component: Any) -> Iterator[dict[str, Any]]:
    """All combinations of values of the options with a list of values; default values are left out."""
    if not dataclasses.is_dataclass(component):
        yield {}
        return
    hints = typing.get_type_hints(component)
    choices = {
        field.name: (field.default, typing.get_args(hints[field.name]))
        for field in dataclasses.fields(component)
        if typing.get_origin(hints.get(field.name)) is Literal and field.default is not dataclasses.MISSING
    }
    # the default is the first value
    orders = [[default, *(v for v in values if v != default)] for default, values in choices.values()]
    for combination in itertools.product(*orders):
        chosen = zip(choices, combination, strict=True)
        yield {name: value for name, value in chosen if value != choices[name][0]}


def _report(
    kind: str,
    label: str,
    name: str,
    options: dict[str, Any],
    progress: Callable[[str], None],
    finished: Callable[[str, Check, str | None], Result],
) -> Report:
    entry = find(kind, name)
    distribution = " ".join(filter(None, (entry.distribution, entry.version)))
    progress(label)
    try:
        component = create(kind, name, **options)
        checks = checks_of(component, promised_only=False)
    except Exception as error:
        return Report(label, kind, distribution, (), f"{type(error).__name__}: {error}")
    results: list[Result] = []
    unusable: set[int | None] = set()
    for check in checks:
        if check.dim in unusable:
            continue
        progress(f"{label}: {check.name.replace('_', ' ')}{f' in {check.dim}-D' if check.dim else ''}")
        result = finished(label, check, _failure(check, component))
        results.append(result)
        if result.failure is not None and check.name in FIRST:
            unusable.add(check.dim)  # all further checks would fail for the same reason
    return Report(label, kind, distribution, tuple(results), None, _measured(component), _responses(component))


def _measured(component: Any) -> dict[str, WallResiduals]:
    if not isinstance(component, WallTreatment) or 2 not in component.traits.dimensions:
        return {}
    try:
        return {kernel: wall_residuals(component, kernel, ratio) for kernel, ratio in MEASURED_WITH.items()}
    except SphframeError:  # the checks have its message
        return {}


def _responses(component: Any) -> tuple[GhostResponse, ...]:
    if not isinstance(component, BoundaryInterpolator):
        return ()
    try:
        return ghost_responses(component)
    except Exception:  # the checks have its message
        return ()


def _failure(check: Check, component: Any) -> str | None:
    try:
        check(component)
    except (BrokenPromiseError, SphframeError) as error:
        return str(error)
    except Exception as error:
        return f"{check}: {type(error).__name__}: {error}"
    return None
