"""Installed studies: how they are found, listed and run from the command line."""

import re
from collections.abc import Callable
from functools import partial
from importlib import metadata
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from sphframe import registry
from sphframe.cli.app import app
from sphframe.errors import BrokenPluginError, UnknownComponentError
from sphframe.studies import installed_study

Install = Callable[..., Path]
DOCS = Path(__file__).parents[2] / "docs"
NAMED = """
    from sphframe.studies import Study

    class Named(Study):
        title, source = "The title of {0}", "Nothing is published."

        def sections(self):
            return []
"""


def call(*arguments: str) -> Result:
    return CliRunner().invoke(app, arguments, env={"COLUMNS": "200", "NO_COLOR": "1"})


@pytest.fixture
def nothing_installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Hide the entry points of all distributions but those that the test installs."""
    found = partial(metadata.distributions, path=[str(tmp_path / "installed")])
    monkeypatch.setattr("sphframe.registry.entries.metadata.distributions", found)
    registry.clear()


@pytest.mark.usefixtures("nothing_installed", "install")
@pytest.mark.parametrize("arguments", [(), ("huang2019",)], ids=["no name", "by name"])
def test_without_a_study_it_says_what_to_install(arguments: tuple[str, ...], tmp_path: Path) -> None:
    result = call("reproduce", *arguments, "--output", str(tmp_path / "report"))
    assert result.exit_code == 2
    assert "pip install sphframe-huang2019" in result.stderr
    assert "Traceback" not in result.stderr
    assert not (tmp_path / "report").exists()


@pytest.mark.usefixtures("nothing_installed")
def test_without_a_name_several_studies_are_listed_with_their_titles(install: Install) -> None:
    install("one", {"study_one": NAMED.format("one")}, {"studies": {"one": "study_one:Named"}})
    assert installed_study().title == "The title of one"
    install("two", {"study_two": NAMED.format("two")}, {"studies": {"two": "study_two:Named"}})
    install("broken", {"study_three": "import nothing_like_it"}, {"studies": {"three": "study_three:Named"}})
    result = call("reproduce")
    assert result.exit_code == 2
    for text in ("one  The title of one", "two  The title of two", "three  cannot be used: "):
        assert text in result.stderr
    listed = call("list", "studies").stdout
    assert re.search(r"studies +one +one 1\.0", listed)


def test_a_name_that_is_not_installed_or_broken(install: Install) -> None:
    with pytest.raises(UnknownComponentError, match="there is no study 'huang2018'; did you mean 'huang2019'"):
        installed_study("huang2018")
    install("wrong", {"study_four": "class Named: pass"}, {"studies": {"four": "study_four:Named"}})
    with pytest.raises(BrokenPluginError, match=r"is not a subclass of sphframe\.studies\.Study"):
        installed_study("four")


@pytest.mark.usefixtures("nothing_installed")
def test_the_output_folder_must_be_named(install: Install) -> None:
    install("one", {"study_five": NAMED.format("one")}, {"studies": {"one": "study_five:Named"}})
    result = call("reproduce", "one")
    assert result.exit_code == 2
    assert "--output DIR" in result.stderr


def test_the_study_in_the_docs_runs(install: Install, cluster: str, tmp_path: Path) -> None:
    (source,) = re.findall(r"```python\n# tank_study\.py\n(.*?)```", (DOCS / "write_a_study.md").read_text(), re.DOTALL)
    install("tank", {"tank_study": source}, {"studies": {"tank": "tank_study:TankStudy"}})
    folder = tmp_path / "report"
    result = call("reproduce", "tank", "--quick", "--scheduler", cluster, "--output", str(folder))
    assert result.exit_code == 0, result.output
    assert {path.stem for path in (folder / "tables").iterdir()} == {"tank", "claims"}
    assert "Still water with two methods" in (folder / "report.html").read_text()
    unknown = call("reproduce", "tank", "--only", "tnak", "--output", str(folder))
    assert unknown.exit_code == 2
    assert "did you mean 'tank'" in unknown.stderr
