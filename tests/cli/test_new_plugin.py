"""``sphframe new-plugin`` writes a distribution that installs, verifies and runs at once."""

import os
import subprocess
import sys
import tomllib

import pytest

from sphframe import InputError, OutputError, create
from sphframe.cli.new_plugin import new_plugin
from sphframe.cli.plugin_template import LICENCES
from sphframe.testing import checks_of


@pytest.fixture
def made(tmp_path, install):
    """The method of a new plugin, installed as pip does in editable mode."""

    def make(name, **options):
        root = new_plugin(name, folder=tmp_path, **options)
        project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
        components = {group.removeprefix("sphframe."): names for group, names in project["entry-points"].items()}
        install(project["name"], {}, components, folder=root)
        return root, create("interpolators", name)

    return make


def test_it_declares_exactly_the_traits_that_it_has(made):
    _, method = made("gauss-width")
    for check in checks_of(method, promised_only=False):
        if check.dim == 2 and check.name != "solver_agrees":
            held = True
            try:
                check(method)
            except AssertionError:
                held = False
            assert held == check.promised, check.name


def test_it_is_complete(made):
    root, method = made("two-words", author='Ada "A." Lovelace', licence="MIT")
    assert sorted(path.name for path in root.iterdir() if not path.name.endswith(".dist-info")) == [
        ".gitignore", "LICENSE", "README.md", "pyproject.toml", "sphframe_two_words", "tests",
    ]  # fmt: skip
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    assert project["authors"] == [{"name": 'Ada "A." Lovelace'}]
    assert project["license"] == "MIT"
    assert "@" not in "".join(p.read_text() for p in root.rglob("*.py")).replace("@dataclass", "").replace("@param", "")
    assert type(method).__name__ == "TwoWords"
    with pytest.raises(InputError, match="width must be positive"):
        create("interpolators", "two-words", width=-1.0)
    collected = subprocess.run(
        [sys.executable, "-m", "pytest", "--collect-only", "-q", "tests"],
        cwd=root, env={**os.environ, "PYTHONPATH": str(root)}, capture_output=True, text=True,
    )  # fmt: skip
    assert "TwoWords(width=0.3)-partition_of_unity-2d" in collected.stdout


@pytest.mark.parametrize("licence", LICENCES)
def test_licences(tmp_path, licence):
    root = new_plugin("licensed", folder=tmp_path, licence=licence)
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    assert project.get("license") == (None if licence == "none" else licence)
    assert (root / "LICENSE").exists() == (licence != "none")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("Mine", "lower-case words joined by hyphens"),
        ("my_method", "lower-case words joined by hyphens"),
        ("2nd", "lower-case words joined by hyphens"),
        ("sphframe-mine", "leave out the prefix: sphframe new-plugin mine"),
        ("shepard", "sphframe-shepard already offers a method called 'shepard'"),
    ],
)
def test_invalid_names(tmp_path, name, message):
    with pytest.raises(InputError, match=message):
        new_plugin(name, folder=tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_an_existing_folder_is_left_alone(tmp_path):
    new_plugin("mine", folder=tmp_path)
    (tmp_path / "sphframe-mine" / "README.md").write_text("changed")
    with pytest.raises(OutputError, match="exists already"):
        new_plugin("mine", folder=tmp_path)
    assert (tmp_path / "sphframe-mine" / "README.md").read_text() == "changed"


def test_an_unknown_licence(tmp_path):
    with pytest.raises(InputError, match="choose BSD-3-Clause, MIT, none"):
        new_plugin("mine", folder=tmp_path, licence="WTFPL")
