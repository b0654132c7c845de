"""The report is self-contained and complete, and its text is escaped."""

import csv
import importlib.util
import re
from pathlib import Path
from types import ModuleType

import pytest

from sphframe.studies import Section, reproduce
from sphframe.studies.chapter import Chapter, Table
from sphframe.studies.report import write_report
from sphframe.studies.series import Reference
from sphframe.studies.tasks import RunTask

browser = importlib.util.module_from_spec(
    spec := importlib.util.spec_from_file_location("sphframe_browser", Path(__file__).with_name("browser.py"))  # type: ignore[arg-type]
)
spec.loader.exec_module(browser)  # type: ignore[union-attr]


@pytest.fixture(scope="module")
def report(tiny: ModuleType, cluster: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return reproduce(tiny.Tiny(), output=tmp_path_factory.mktemp("report"), quick=True, scheduler=cluster)


def test_every_picture_decodes_and_is_a_file(report: Path) -> None:
    page = browser.Page(report.read_text())
    assert len(page.images) == 2
    assert all(browser.decoded_width(source) > 200.0 for source in page.images)
    assert {path.name for path in (report.parent / "figures").iterdir()} == {"pressures.svg", "pressures_raster.png"}


def test_names_are_escaped_and_nothing_comes_from_elsewhere(report: Path, tiny: ModuleType) -> None:
    html = report.read_text()
    page = browser.Page(html)
    assert "script" not in page.elements
    assert page.text.count(tiny.HOSTILE) >= 8
    assert "http://" not in html
    assert "https://" not in html
    assert "quick version" in page.text
    assert "no --reference folder was given" in page.text


def test_tables_are_files(report: Path, tiny: ModuleType) -> None:
    with (report.parent / "tables" / "pressures.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["run"] for row in rows] == [task.label for task in tiny.tasks(True)]
    assert all(2500.0 < float(row["mean (Pa)"]) < 3500.0 for row in rows)
    with (report.parent / "tables" / "claims.csv").open(newline="") as file:
        assert [row["verdict"] for row in csv.DictReader(file)] == ["reproduced", "not checkable"]


def test_a_column_that_the_first_row_lacks_is_shown(tmp_path: Path) -> None:
    table = Table("two", "Two", [{"a": 1}, {"a": 2, "b": 0.25}])
    path = write_report(tmp_path, "t", [Chapter("c", "c", [], [table], [], [])], facts={})
    for text in (path.read_text(), (tmp_path / "report.md").read_text(), (tmp_path / "tables" / "two.csv").read_text()):
        assert "0.25" in text


def test_the_markdown_names_every_figure_and_table(report: Path, tiny: ModuleType) -> None:
    text = report.with_name("report.md").read_text()
    linked = set(re.findall(r"\]\(([^)]+)\)", text))
    assert linked == {f"figures/{n}" for n in ("pressures.svg", "pressures_raster.png")} | {"tables/pressures.csv"}
    assert all((report.parent / path).exists() for path in linked)
    assert not re.search(r"(?<!\\)<", text), "an HTML element could begin here"
    assert not re.search(r"&(#\d+|[a-z]+);", text), "Markdown shows an HTML escape as it stands"
    assert "alert('x')" in text
    rows = [line for line in text.splitlines() if line.startswith("| tank")]
    assert [row.count("|") for row in rows] == [4] * 4


def test_written_again_it_is_the_same(report: Path, tiny: ModuleType) -> None:
    files = sorted(path for path in report.parent.rglob("*") if path.suffix in (".html", ".md", ".svg", ".png", ".csv"))
    before = [path.read_bytes() for path in files]
    reproduce(tiny.Tiny(), output=report.parent, quick=True)
    assert [path.read_bytes() for path in files] == before


@pytest.mark.skipif(browser.browser() is None, reason="no Chromium and playwright here")
@pytest.mark.filterwarnings("ignore::ResourceWarning")
def test_a_browser_shows_every_picture_and_runs_nothing(report: Path) -> None:
    seen = browser.seen_in_browser(report, browser.browser())
    assert [image[1] for image in seen["images"]] == [True, True]
    assert all(image[2] > 200 and image[3] > 200 for image in seen["images"])
    assert (seen["outside"], seen["scripts"], seen["errors"]) == ([], 0, [])


def test_reference_series_are_noted_when_absent(tmp_path: Path) -> None:
    (tmp_path / "there.csv").write_text("# columns: t,p\n0,1\n1,2\n")
    reference = Reference(tmp_path)
    assert reference.get("there") is not None
    assert reference.get("missing") is None
    assert reference.get("missing") is None
    assert len(reference.absent) == 1
    assert "missing" in reference.absent[0]


def test_a_run_that_was_stopped_says_why(tiny: ModuleType, cluster: str, tmp_path: Path) -> None:
    broken = tiny.tank(courant_number=3.0)
    section = Section("broken-tank", lambda quick: [RunTask.of("broken", broken)], tiny.chapter)
    report = reproduce(tiny.Tiny(section), output=tmp_path, scheduler=cluster)
    with (tmp_path / "tables" / "broken_tank_stopped.csv").open(newline="") as file:
        (row,) = csv.DictReader(file)
    assert row["run"] == "broken"
    assert "courant_number" in row["message"]
    assert row["message"] in browser.Page(report.read_text()).text
