"""Studies: the methods and the benchmarks of the league table: all that are installed."""

import inspect
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from sphframe.cases import Case, ExactCase
from sphframe.cases.exact import Benchmark
from sphframe.errors import InputError, PluginError
from sphframe.registry import available, create, load
from sphframe.registry.nearest import did_you_mean
from sphframe.studies.ensemble import displaced

_INTERPOLATED = "fixed-ghosts"
"""the wall treatment whose ghosts are filled by an interpolator: each interpolator is a method of its own"""


@dataclass(frozen=True)
class Method:
    """A row of the table: an interpolator, for the ghosts of ``fixed-ghosts``, or another wall treatment.

    Attributes
    ----------
    name
        of the component.
    kind
        ``interpolators`` or ``wall_treatments``.
    distribution
        what installs it, with the version.
    description
        its documentation: equation, source, departures and known failures.
    traits
        what it promises, by name.
    """

    name: str
    kind: str
    distribution: str
    description: str
    traits: Mapping[str, Any]

    @property
    def parameters(self) -> dict[str, Any]:
        """The parameters of a case that choose this method."""
        if self.kind == "interpolators":
            return {"interpolator": {"name": self.name}}
        return {"wall_treatment": {"name": self.name}}


class Benchmarked(NamedTuple):
    """A column of the table: a benchmark with its name and case."""

    name: str
    case_name: str
    model: type[ExactCase]
    benchmark: Benchmark

    def case(self, spacing: float, seed: int, method: Method) -> Case:
        """Return a run at a particle spacing, m; any seed but 0 displaces the particles at the start at random.

        Raises
        ------
        InputError
            the case does not accept the method.
        """
        parameters = {**self.benchmark.parameters, **method.parameters, **displaced(seed)}
        return self.model(**parameters, particle_spacing=spacing)


def installed_methods(names: Sequence[str] = ()) -> list[Method]:
    """Return the interpolators and wall treatments that are installed, or those with ``names``, in this order.

    A component that cannot be used is left out unless it is named.

    Raises
    ------
    InputError
        a name is not that of a method.
    PluginError
        a named one cannot be used.
    """
    entries = {
        entry.name: entry
        for kind in ("interpolators", "wall_treatments")
        for entry in available(kind)
        if entry.name != _INTERPOLATED
    }
    methods = []
    for name in _chosen(names, entries, "method"):
        entry = entries[name]
        try:
            component = create(entry.kind, name)
        except PluginError:
            if names:
                raise
            continue
        methods.append(
            Method(
                name,
                entry.kind,
                f"{entry.distribution} {entry.version}".strip(),
                inspect.getdoc(type(component)) or "",
                {key: value for key, value in vars(component.traits).items() if isinstance(value, bool | int | str)},
            )
        )
    return methods


def installed_benchmarks(names: Sequence[str] = ()) -> list[Benchmarked]:
    """Return the benchmarks of the cases that are installed, or those with ``names``, in this order.

    Raises
    ------
    InputError
        a name is not that of a benchmark, or two cases have benchmarks of one name.
    """
    found: dict[str, Benchmarked] = {}
    for entry in available("cases"):
        try:
            model = load("cases", entry.name)
        except PluginError:
            continue
        for name, benchmark in getattr(model, "benchmarks", {}).items():
            if name in found:
                raise InputError(f"the cases {found[name].case_name} and {entry.name} both have a benchmark {name!r}")
            found[name] = Benchmarked(name, entry.name, model, benchmark)
    return [found[name] for name in _chosen(names, found, "benchmark")]


def _chosen(names: Sequence[str], known: Mapping[str, Any], what: str) -> Sequence[str]:
    """Return ``names``, or all known ones; each must be known and given once."""
    for name in names:
        if name not in known:
            raise InputError(
                f"there is no {what} {name!r}{did_you_mean(name, list(known))}; installed: {', '.join(sorted(known))}"
            )
    if len(set(names)) != len(names):
        raise InputError(f"give each {what} once, not {','.join(names)}")
    return names or sorted(known)
