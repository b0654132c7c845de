import atexit
import gc
import importlib.util
import os
import shutil
import signal
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from textwrap import dedent
from types import ModuleType

import numba
import pytest
from hypothesis import HealthCheck, settings

from sphframe import registry

Install = Callable[..., Path]

# threads that wait give up their core: test processes run side by side, and would else keep each other waiting
os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")

if os.environ.pop("PYTHONDONTWRITEBYTECODE", ""):
    # tests start hundreds of Python processes: where byte code may not lie beside its modules, they share a folder
    os.environ["PYTHONPYCACHEPREFIX"] = tempfile.mkdtemp(prefix="sphframe-byte-code-")
    atexit.register(shutil.rmtree, os.environ["PYTHONPYCACHEPREFIX"], ignore_errors=True)

# compiling makes many objects, and each search for garbage walks through those of all packages as well
gc.freeze()
gc.set_threshold(50_000, 20, 20)

# no test depends on speed: other processes may keep all cores busy
settings.register_profile("any-speed", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("any-speed")


IN_SPACE = {"ImprovedShepard", "LinearMLS", "Dynamic", "PairMirror"}
"""components whose checks in three dimensions are no long tests"""


def checks_another_in_space(item: pytest.Item) -> bool:
    """Whether a test is a check of a component in three dimensions that is not named in ``IN_SPACE``."""
    given = item.callspec.params if hasattr(item, "callspec") else {}
    in_space = getattr(given.get("check"), "dim", None) == 3
    return in_space and IN_SPACE.isdisjoint(type(value).__name__ for value in given.values())


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Make checks of most components in three dimensions long tests: each compiles loops of its own.

    The files that contain slow tests come first, so that no worker is left with one at the end.
    """
    for item in filter(checks_another_in_space, items):
        item.add_marker(pytest.mark.long)
    slow = {item.path for item in items if item.get_closest_marker("slow")}
    items.sort(key=lambda item: item.path not in slow)


@pytest.fixture(autouse=True)
def one_thread() -> None:
    """Compile loops without threads, which takes half the time, unless a test asks for threads."""
    numba.set_num_threads(1)


@pytest.fixture(scope="session")
def module_at() -> Callable[[Path], ModuleType]:
    """Import a module of helpers from its path, as ``sphframe_NAME``; helpers run as programs are imported so too."""

    def load(path: Path) -> ModuleType:
        spec = importlib.util.spec_from_file_location(f"sphframe_{path.stem}", path)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules[spec.name] = module
        spec.loader.exec_module(module)
        return module

    return load


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Install little distributions, ``install(name, {module: source}, {kind: {name: address}})``, for one test."""
    folder = tmp_path / "installed"

    def add(
        name: str,
        modules: Mapping[str, str] | None = None,
        components: Mapping[str, Mapping[str, str]] | None = None,
        *,
        version: str = "1.0",
        entry_points: str | None = None,
        folder: Path = folder,
    ) -> Path:
        folder.mkdir(exist_ok=True)
        for module, source in (modules or {}).items():
            path = folder / f"{module.replace('.', '/')}.py"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(dedent(source))
        info = folder / f"{name.replace('-', '_')}-{version}.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
        groups = "".join(
            f"[sphframe.{kind}]\n" + "".join(f"{key} = {value}\n" for key, value in names.items())
            for kind, names in (components or {}).items()
        )
        (info / "entry_points.txt").write_text(groups if entry_points is None else entry_points)
        monkeypatch.syspath_prepend(folder)
        registry.clear()
        return folder

    yield add
    for module in [m for m, loaded in sys.modules.items() if str(tmp_path) in str(getattr(loaded, "__file__", ""))]:
        del sys.modules[module]
    monkeypatch.undo()
    registry.clear()


if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # a shell that runs the tests in the background ignores Ctrl-C for them; tests of interruption need it
    signal.signal(signal.SIGINT, signal.default_int_handler)
