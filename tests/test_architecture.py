"""Architecture: the layers of the rooms, public names, and the tools that check the source."""

import ast
import importlib
import inspect
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import sphframe

ROOT = Path(__file__).parent.parent
CORE = sorted((ROOT / "sphframe").rglob("*.py"))
ROOMS = ("analysis", "cases", "devices", "geometry", "studies")
PUBLIC = ("sphframe", *(f"sphframe.{room}" for room in ROOMS))
PLUGINS = [path for path in sorted(ROOT.glob("plugins/*/sphframe_*/**/*.py")) if "tests" not in path.parts]


def imports(path: Path) -> Iterator[tuple[str, str | None]]:
    """Yield (module, name) for each ``from module import name`` and (module, None) for each ``import module``."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from ((alias.name, None) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from (("." * node.level + (node.module or ""), alias.name) for alias in node.names)


def run(*command: str) -> None:
    result = subprocess.run([sys.executable, *command], cwd=ROOT, capture_output=True, text=True, check=False)
    assert result.returncode == 0, f"{' '.join(command)}:\n{result.stdout}{result.stderr}"


def test_rooms_know_only_the_rooms_below_them():
    run("-c", "from importlinter.cli import lint_imports; raise SystemExit(lint_imports(no_cache=True, no_logo=True))")


@pytest.mark.parametrize("path", CORE, ids=lambda path: str(path.relative_to(ROOT)))
def test_the_core_never_imports_a_plugin(path: Path):
    plugins = [module for module, _ in imports(path) if module.startswith("sphframe_")]
    assert not plugins, f"{path.relative_to(ROOT)} imports {plugins}: components are chosen by name, in the registry"


@pytest.mark.parametrize("path", CORE, ids=lambda path: str(path.relative_to(ROOT)))
def test_the_first_line_says_what_room_it_is(path: Path):
    parts = path.relative_to(ROOT / "sphframe").with_suffix("").parts
    room = parts[0] if parts[0] != "__init__" else "sphframe"
    title = (ast.get_docstring(ast.parse(path.read_text())) or "").partition(":")[0]
    assert title.lower().replace(" ", "_") == room, f"begin the module's docstring with the room's name, {room}:"


@pytest.mark.parametrize("path", PLUGINS, ids=lambda path: str(path.relative_to(ROOT / "plugins")))
def test_plugins_import_public_names_of_sphframe_only(path: Path):
    own = path.relative_to(ROOT / "plugins").parts[1]
    for module, name in imports(path):
        if module.partition(".")[0].startswith("sphframe_") and module.partition(".")[0] != own:
            assert name in importlib.import_module(module).__all__, (
                f"{path.name} imports {name}, not public in {module}"
            )
        elif module.partition(".")[0] == "sphframe":
            assert module in PUBLIC, f"{path.name} imports from {module}; plugins may import from {', '.join(PUBLIC)}"
            assert name in importlib.import_module(module).__all__, (
                f"{path.name} imports {name} from {module}; plugins may import the names in {module}.__all__ only"
            )


@pytest.mark.parametrize("name", sphframe.__all__)
def test_every_public_name_is_there_and_documented(name: str):
    value = getattr(sphframe, name)
    assert value.__doc__ or not (inspect.isclass(value) or inspect.isroutine(value))
    assert name in dir(sphframe)


def test_ruff_finds_nothing():
    run("-m", "ruff", "check", ".")
    run("-m", "ruff", "format", "--check", ".")


def test_mypy_finds_nothing():
    run("-m", "mypy")
