"""The documentation builds without a warning and names every command and every public name."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
import typer.main

import sphframe
import sphframe.analysis
from sphframe.cli.app import app
from sphframe.registry import available

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
COMMANDS = sorted(typer.main.get_command(app).commands)  # type: ignore[attr-defined]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("sphinx")
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-d", f"{folder}-trees"]
    done = subprocess.run([*command, str(DOCS), str(folder)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.parametrize("module", [sphframe, sphframe.analysis], ids=lambda module: module.__name__)
def test_every_public_name_is_documented(site: Path, module) -> None:  # type: ignore[no-untyped-def]
    page = (site / "api.html").read_text(encoding="utf-8")
    missing = [name for name in module.__all__ if f'id="{module.__name__}.{name}"' not in page]
    assert not missing


def test_internal_links_lead_somewhere(site: Path) -> None:
    pages = {page.name: page.read_text(encoding="utf-8") for page in site.glob("*.html")}
    for name, text in pages.items():
        for page, anchor in re.findall(r'href="([\w.-]*)#([^"]+)"', text):
            target = page or name
            assert target in pages, f"{name} links to {target}"
            assert f'id="{anchor}"' in pages[target] or not anchor, f"{name} links to {target}#{anchor}"


def test_every_command_has_a_how_to() -> None:
    headings = re.findall(r"^## (\S+)$", (DOCS / "commands.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert sorted(headings) == COMMANDS


def test_every_method_of_this_project_is_explained() -> None:
    text = (DOCS / "methods.md").read_text(encoding="utf-8")
    own = [entry for entry in available("interpolators") if (ROOT / "plugins" / entry.distribution).is_dir()]
    assert own
    assert not [entry.name for entry in own if f"`{entry.name}`" not in text]
