"""Registry: which components are installed, read from the metadata of distributions without loading any."""

import importlib
import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from importlib import metadata

from sphframe.errors import ClashingPluginError, InputError, PluginWarning, UnknownComponentError
from sphframe.registry.kinds import DISTRIBUTIONS, KINDS, LABELS
from sphframe.registry.nearest import did_you_mean, nearest
from sphframe.representation import html_table

_ADDRESS = re.compile(r"[^\W\d]\w*(\.[^\W\d]\w*)*:[^\W\d]\w*(\.[^\W\d]\w*)*")


@dataclass(frozen=True)
class Entry:
    """One component that an installed distribution declares, loaded or not.

    Attributes
    ----------
    name
        the name by which it is chosen.
    kind
        one of :data:`KINDS`.
    value
        its address, ``module:attribute``.
    distribution, version
        the distribution that declares it; empty for a ``module:attribute`` given in place of a name.
    error
        why it cannot be used; known without loading it for clashes of names, else from the last attempt to load it.
    """

    name: str
    kind: str
    value: str
    distribution: str
    version: str
    error: str | None = None

    @property
    def title(self) -> str:
        """Kind and name, for messages."""
        return f"{LABELS[self.kind]} {self.name!r}"

    @property
    def label(self) -> str:
        """Kind, name and distribution, for messages."""
        return f"{self.title} of {_origin(self)}" if self.distribution else self.title


class Listing(list[Entry]):
    """A list of entries that is shown with one entry per line."""

    def __repr__(self) -> str:
        """Name, distribution and error of each."""
        return "\n".join("  ".join(part for part in row if part) for row in self._rows()) or "nothing is installed"

    def _repr_html_(self) -> str:
        kinds = ", ".join(dict.fromkeys(entry.kind for entry in self)) or "nothing is installed"
        return html_table(kinds.replace("_", " "), ["name", "from", "error"], self._rows())

    def _rows(self) -> list[tuple[str, str, str]]:
        return [(entry.name, _origin(entry), entry.error or "") for entry in self]


_errors: dict[Entry, str] = {}


def available(kind: str) -> Listing:
    """List the installed components of ``kind``, sorted by name, without loading any of them; shown as a table.

    Names that several distributions claim are listed once for each, with the clash as their error; components that
    could not be loaded earlier in this process have that as their error (:func:`sphframe.registry.check` tries all).

    Raises
    ------
    InputError
        when ``kind`` is not one of :data:`KINDS`.
    """
    _check_kind(kind)
    entries = _declared()[kind]
    names = [entry.name for entry in entries]
    return Listing(
        replace(entry, error=_clash(entry, entries) if names.count(entry.name) > 1 else _errors.get(entry))
        for entry in entries
    )


def find(kind: str, name: str) -> Entry:
    """Return the entry of the component ``name``, or of ``module:attribute``, without loading it.

    Raises
    ------
    InputError
        when ``kind`` is not one of :data:`KINDS`.
    UnknownComponentError
        when nothing installed has that name.
    ClashingPluginError
        when several distributions claim it.
    """
    _check_kind(kind)
    if is_address(name):
        return Entry(name, kind, name, "", "")
    entries = _declared()[kind]
    claims = [entry for entry in entries if entry.name == name]
    if not claims:
        raise UnknownComponentError(_unknown(kind, name))
    if len(claims) > 1:
        raise ClashingPluginError(
            f"{LABELS[kind]} {name!r} is claimed by {' and by '.join(_origin(claim) for claim in claims)};"
            f" uninstall all but one, or give the address of the one you mean instead of its name:"
            f" {' or '.join(repr(claim.value) for claim in claims)}"
        )
    return replace(claims[0], error=_errors.get(claims[0]))


def is_address(name: str) -> bool:
    """Return whether ``name`` is a ``module:attribute`` rather than a registered name."""
    return _ADDRESS.fullmatch(name) is not None


def remember(entry: Entry, error: str | None) -> None:
    """Store why ``entry`` could not be loaded, for listings; None means that it could."""
    key = replace(entry, error=None)
    if error is None:
        _errors.pop(key, None)
    else:
        _errors[key] = error


def clear() -> None:
    """Forget what is installed and which components are broken, after something was installed or fixed."""
    importlib.invalidate_caches()
    _declared.cache_clear()
    _errors.clear()


@cache
def _declared() -> dict[str, list[Entry]]:
    """All entries by kind, sorted by name and distribution."""
    found: dict[str, set[Entry]] = {kind: set() for kind in KINDS}
    seen: set[str] = set()
    for distribution in metadata.distributions():
        entries = list(_entries_of(distribution))
        if entries:
            # Of a distribution that is on the path twice, the first counts, as for imports.
            identity = re.sub(r"[-_.]+", "-", entries[0].distribution).lower()
            if identity not in seen:
                seen.add(identity)
                for entry in entries:
                    found[entry.kind].add(entry)
    return {kind: sorted(entries, key=lambda e: (e.name, e.distribution, e.value)) for kind, entries in found.items()}


def _entries_of(distribution: metadata.Distribution) -> Iterator[Entry]:
    text = ""
    try:
        text = distribution.read_text("entry_points.txt") or ""
        # Each is read by itself, and only if it mentions sphframe: metadata.entry_points() fails at the first bad file.
        points = [point for point in distribution.entry_points if point.group in _GROUPS] if "sphframe." in text else []
    except (ValueError, TypeError, AttributeError):
        warnings.warn(
            f"the components of {_name(distribution)} are not listed: its entry_points.txt is malformed;"
            f" reinstall it: python -m pip install --force-reinstall {_name(distribution)}",
            PluginWarning,
            stacklevel=2,
        )
        return
    for point in points:
        version = distribution.metadata["Version"] or ""
        yield Entry(point.name, _GROUPS[point.group], point.value, _name(distribution), version)


_GROUPS = {f"sphframe.{kind}": kind for kind in KINDS}


def _name(distribution: metadata.Distribution) -> str:
    return distribution.metadata["Name"] or "a distribution without a name"


def _check_kind(kind: str) -> None:
    if kind not in KINDS:
        raise InputError(
            f"{kind!r} is not a kind of component{did_you_mean(kind, KINDS)} The kinds: {', '.join(KINDS)}"
        )


def _origin(entry: Entry) -> str:
    return f"{entry.distribution} {entry.version}".strip()


def _clash(entry: Entry, entries: list[Entry]) -> str:
    others = [other for other in entries if other.name == entry.name and other != entry]
    return f"the name is also claimed by {' and '.join(_origin(other) for other in others)}"


def _unknown(kind: str, name: str) -> str:
    entries = available(kind)
    names = {entry.name for entry in entries}
    offered = {known for of_kind, known in DISTRIBUTIONS if of_kind == kind}
    sound = sorted(entry.name for entry in entries if entry.error is None)
    broken = [f"{entry.name} ({_origin(entry)}: {entry.error})" for entry in entries if entry.error is not None]

    lines = [f"there is no {LABELS[kind]} {name!r}"]
    match = name if name in offered else nearest(name, names | offered)
    if match and match != name:
        lines[0] += f"; did you mean {match!r}?"
    if match and match not in names:
        install = f"python -m pip install {DISTRIBUTIONS[kind, match]}"
        lines.append(f"{match!r} is not installed; to get it: {install}")
    lines += [f"{name!r} is a name among {other}" for other in KINDS if any(e.name == name for e in _declared()[other])]
    lines.append(f"installed: {', '.join(sound) or 'none'}")
    if broken:
        lines.append(f"broken: {'; '.join(broken)}")
    lines.append("a class of your own that is not installed is given as module:attribute")
    return "\n  ".join(lines)
