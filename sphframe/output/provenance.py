"""Output: names and versions of the software that computed a run."""

import hashlib
import importlib.metadata
import importlib.util
import platform
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
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


def code(case: "Case") -> dict[str, str]:
    """Return a hash of the source of each plugin of ``case``, which its author may change without its version."""
    found = {}
    for kind, name in _chosen(case):
        address = next((entry.value for entry in registry.available(kind) if entry.name == name), name)
        package = address.partition(":")[0].partition(".")[0]
        if package != "sphframe":
            found[f"code of {package}"] = _hash_of(package)
    return found


@cache
def _hash_of(package: str) -> str:
    """Hash all sources of a package or module, once in a process, which does not see later changes of them."""
    spec = importlib.util.find_spec(package) if package not in sys.modules else sys.modules[package].__spec__
    digest = hashlib.sha256()
    if spec is not None:
        folders = map(Path, spec.submodule_search_locations or ())
        files = [path for folder in folders for path in sorted(folder.rglob("*.py"))]
        for path in files or [Path(spec.origin or "")]:
            digest.update(path.read_bytes() if path.is_file() else b"")
    return digest.hexdigest()[:12]


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
