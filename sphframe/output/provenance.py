"""Output: names and versions of the software that computed a run."""

import importlib.metadata
import platform
import sys
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from sphframe import registry

if TYPE_CHECKING:
    from sphframe.cases import Case


def distributions(case: "Case") -> dict[str, str]:
    """Return the versions of sphframe and of all distributions that the case and its components come from."""
    versions = {"sphframe": importlib.metadata.version("sphframe")}
    for kind, name in _chosen(case):
        for entry in registry.available(kind):
            if entry.name == name and entry.distribution:
                versions[entry.distribution] = entry.version
    return versions


def software() -> dict[str, str]:
    """Return the versions of Python and of the packages that compute or store the results."""
    packages = {package: importlib.metadata.version(package) for package in ("numpy", "numba", "netCDF4")}
    return {"python": platform.python_version(), **packages}


def registered_name(case: type) -> str:
    """Return the name under which a class of cases is installed, or its address."""
    for entry in registry.available("cases"):
        module, _, attribute = entry.value.partition(":")
        if getattr(sys.modules.get(module), attribute, None) is case:
            return entry.name
    return f"{case.__module__}:{case.__qualname__}"


def _chosen(case: "Case") -> Iterator[tuple[str, str]]:
    yield "cases", registered_name(type(case))
    for field, kind in registry.COMPONENT_KINDS.items():
        yield kind, getattr(case, field).name
    yield "body_forces", case.acceleration.name
    bodies = getattr(case, "bodies", None)
    for body in bodies.values() if isinstance(bodies, Mapping) else ():
        if hasattr(body, "name"):
            yield "rigid_bodies", body.name
