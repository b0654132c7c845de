"""Facts about the whole project: sizes, words, metadata and the files for contributors."""

import ast
import re
import runpy
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parent.parent
COUNT = runpy.run_path(str(ROOT / "tests" / "count_lines.py"))
SOURCES = [*sorted((ROOT / "sphframe").rglob("*.py")), *sorted(ROOT.glob("plugins/*/sphframe_*/**/*.py"))]
PROSE = [
    *SOURCES,
    *(
        path
        for pattern in ("docs/**/*.md", "docs/**/*.ipynb", "docs/**/*.svg", "plugins/**/*.md", "*.md")
        for path in ROOT.glob(pattern)
    ),
]
DISTRIBUTIONS = [ROOT / "pyproject.toml", *sorted(ROOT.glob("plugins/*/pyproject.toml"))]

LONGEST_CLASS, LONGEST_FUNCTION = 250, 60
LARGEST_CORE = 12_737
"""the aim is 6,000 lines; lower this limit whenever the core has become smaller"""


def named(path: Path) -> str:
    return str(path.relative_to(ROOT))


def too_long(path: Path) -> Iterator[tuple[str, int]]:
    """Yield the name and the number of lines of each class and function that is too long.

    The docstring of a function does not count. Compiled loops are excepted, also within a function. They have no
    annotations, and a comment in the line of their ``def`` tells mypy so.
    """
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines()

    def length(node: ast.ClassDef | ast.FunctionDef) -> int:
        if "type: ignore[no-untyped-def]" in lines[node.lineno - 1]:
            return 0
        whole = (node.end_lineno or node.lineno) - node.lineno + 1
        inner = [child for child in node.body if isinstance(child, ast.FunctionDef)]
        compiled = sum((child.end_lineno or 0) - child.lineno + 1 for child in inner if length(child) == 0)
        first = node.body[0]
        docstring = (first.end_lineno or 0) - first.lineno + 1 if ast.get_docstring(node) else 0
        return whole - compiled - docstring if isinstance(node, ast.FunctionDef) else whole

    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ClassDef | ast.FunctionDef):
            limit = LONGEST_CLASS if isinstance(node, ast.ClassDef) else LONGEST_FUNCTION
            if length(node) > limit:
                yield node.name, length(node)


@pytest.mark.parametrize("path", SOURCES, ids=named)
def test_classes_and_functions_are_short(path: Path):
    found = list(too_long(path))
    assert not found, f"{found}: a class has at most {LONGEST_CLASS} lines, a function {LONGEST_FUNCTION}"


def test_the_core_stays_small():
    assert COUNT["core_lines"]() <= LARGEST_CORE, COUNT["lines_of_rooms"]()


@pytest.mark.parametrize("path", PROSE, ids=named)
def test_words_that_readers_stumble_over_are_not_used(path: Path):
    text = path.read_text(encoding="utf-8")
    found = re.findall(r"\b(?:anew|mend|mends|mended|mending)\b", text, flags=re.IGNORECASE)
    assert not found, f"{named(path)} says {set(found)}: write 'again' and 'fix'"


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
