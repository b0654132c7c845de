"""Registry: components loaded by name, checked against their interface, and made with their options."""

import inspect
import sys
from importlib import import_module
from operator import attrgetter
from typing import Any

from sphframe.errors import ApiVersionError, BrokenPluginError, PluginError
from sphframe.registry.entries import Entry, available, find, is_address, remember
from sphframe.registry.kinds import API_VERSION, INTERFACES, OLDEST_API_VERSION


def load(kind: str, name: str) -> Any:
    """Load the component ``name``, or ``module:attribute``, and check it against the interface of its kind.

    Returns
    -------
    Any
        A concrete subclass of the interface of the kind; for hooks the object that the entry point names.

    Raises
    ------
    InputError
        when ``kind`` is not a kind.
    UnknownComponentError
        when nothing installed has that name.
    ClashingPluginError
        when several distributions claim it.
    ApiVersionError
        when the plugin was written for another version of the interface.
    BrokenPluginError
        when it cannot be imported, or is not a concrete subclass of the interface.
    """
    entry = find(kind, name)
    try:
        component = _loaded(entry)
    except PluginError as error:
        cause = error.__cause__ if isinstance(error, BrokenPluginError) else None
        remember(entry, _short(cause) if cause else str(error))
        raise
    remember(entry, None)
    return component


def check(kind: str) -> list[Entry]:
    """Try to load each component of ``kind``, and list them as :func:`available` does, with their errors."""
    for entry in available(kind):
        try:
            load(kind, entry.name)
        except PluginError:
            continue
    return available(kind)


def create(kind: str, name: str, /, **options: Any) -> Any:
    """Make the component ``name``, or ``module:attribute``, with ``options``.

    Raises
    ------
    InputError
        when an option is unknown, missing, of the wrong type, NaN or infinite, or refused by the component.
    PluginError
        as :func:`load` does.

    Examples
    --------
    >>> from sphframe.registry import create
    >>> create("equations_of_state", "tait", gamma=7)
    Tait(gamma=7.0)
    """
    from sphframe.registry.options import construct  # a list of names does not need pydantic

    component = load(kind, name)
    return construct(component, find(kind, name).title, options)


def _loaded(entry: Entry) -> Any:
    if not is_address(entry.value):
        raise BrokenPluginError(
            f"{entry.label} is broken: its entry point {entry.value!r} is not of the form module:attribute;"
            f" {_remedy(entry)}"
        )
    module_name, _, attribute = entry.value.partition(":")
    try:
        component = attrgetter(attribute)(import_module(module_name))
    except (Exception, SystemExit) as error:
        _check_api_version(entry, module_name, error)
        raise BrokenPluginError(f"{entry.label} is broken: {_short(error)}; {_remedy(entry, error)}") from error
    _check_api_version(entry, module_name, None)
    if entry.kind in INTERFACES:
        _check_interface(entry, component, INTERFACES[entry.kind])
    return component


def _check_api_version(entry: Entry, module_name: str, cause: BaseException | None) -> None:
    """Refuse a plugin whose SPHFRAME_API, in its module or the packages above, is not supported."""
    parts = module_name.split(".")
    modules = [sys.modules.get(".".join(parts[:n])) for n in range(len(parts), 0, -1)]
    versions = [getattr(module, "SPHFRAME_API", None) for module in modules]
    version = next((version for version in versions if version is not None), API_VERSION)
    if not (isinstance(version, tuple) and len(version) == 2 and all(type(number) is int for number in version)):
        raise BrokenPluginError(
            f"{entry.label} is broken: SPHFRAME_API = {version!r} must be a pair of whole numbers such as"
            f" {API_VERSION}; {_remedy(entry)}"
        ) from cause
    if OLDEST_API_VERSION <= version <= API_VERSION:
        return
    if version > API_VERSION:
        offer, older, distribution = f"offers {_dotted(API_VERSION)}", "sphframe", "sphframe"
    else:
        offer, older = f"supports {_dotted(OLDEST_API_VERSION)} and later", "the plugin"
        distribution = entry.distribution
    install = f" (python -m pip install --upgrade {distribution})" if distribution else ""
    raise ApiVersionError(
        f"{entry.label} was written for version {_dotted(version)} of sphframe's plugin interface, and this sphframe"
        f" {offer}: upgrade {older}{install}"
    ) from cause


def _dotted(version: tuple[int, int]) -> str:
    return f"{version[0]}.{version[1]}"


def _check_interface(entry: Entry, component: Any, interface: str) -> None:
    """Check that a component is a concrete subclass of the class with the public name ``interface``.

    It is looked up by name: a list of names needs no interface, and ``Case`` and ``Study`` are above the registry.
    """
    home, _, name = interface.rpartition(".")
    if not (inspect.isclass(component) and issubclass(component, getattr(import_module(home), name))):
        raise BrokenPluginError(
            f"{entry.label} is broken: {entry.value} is not a subclass of {interface} but {component!r:.80};"
            f" {_remedy(entry)}"
        )
    missing = sorted(getattr(component, "__abstractmethods__", ()))
    if missing:
        raise BrokenPluginError(
            f"{entry.label} is broken: {entry.value} does not define {', '.join(missing)} of {interface};"
            f" {_remedy(entry)}"
        )


def _short(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}".rstrip(": ")


def _remedy(entry: Entry, error: BaseException | None = None) -> str:
    module_name = entry.value.partition(":")[0]
    missing = error.name if isinstance(error, ImportError) and error.name else None
    if missing and missing.partition(".")[0] == "sphframe":
        return "it imports something that this version of sphframe does not have: upgrade the older of the two"
    if isinstance(error, ModuleNotFoundError) and missing and missing != module_name.partition(".")[0]:
        return f"install what provides the module {missing!r}"
    if not entry.distribution:
        return "check its spelling, and that its folder is on PYTHONPATH" if error else "fix it there"
    return (
        f"reinstall or upgrade it (python -m pip install --upgrade --force-reinstall {entry.distribution}),"
        f" or tell its authors"
    )
