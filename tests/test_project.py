"""Facts about the whole project: metadata and the files for contributors."""

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parent.parent
DISTRIBUTIONS = [ROOT / "pyproject.toml", *sorted(ROOT.glob("plugins/*/pyproject.toml"))]


def named(path: Path) -> str:
    return str(path.relative_to(ROOT))


@pytest.mark.parametrize("path", DISTRIBUTIONS, ids=named)
def test_distributions_say_where_they_come_from(path: Path):
    urls = tomllib.loads(path.read_text(encoding="utf-8"))["project"]["urls"]
    assert urls["Homepage"] == "https://github.com/sphframe/sphframe"


def test_the_release_of_the_citation_is_the_package():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert (citation["title"], citation["version"]) == (project["name"], project["version"])


@pytest.mark.parametrize(
    "path", [*ROOT.glob(".github/**/*.yml"), *ROOT.glob(".*.yaml")], ids=lambda path: path.relative_to(ROOT).as_posix()
)
def test_configuration_of_services_is_yaml(path: Path):
    assert yaml.safe_load(path.read_text(encoding="utf-8"))


def test_the_tools_of_pre_commit_are_those_of_the_workflow():
    hooks = yaml.safe_load((ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8"))["repos"][0]["hooks"]
    workflow = (ROOT / ".github" / "workflows" / "tests.yml").read_text(encoding="utf-8")
    for hook in hooks:
        assert hook["entry"].removesuffix(" --force-exclude") in workflow


def test_codespell_finds_nothing():
    pytest.importorskip("codespell_lib")
    command = [sys.executable, "-m", "codespell_lib"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
