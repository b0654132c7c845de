"""The whole paper, quick: every section within ten minutes on two cores, every figure shown."""

import importlib.util
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

from sphframe.studies import SECTIONS, reproduce
from sphframe.studies.tasks import Task

pytestmark = pytest.mark.slow


def test_quick_makes_the_whole_report(tmp_path: Path) -> None:
    browser = importlib.util.module_from_spec(
        spec := importlib.util.spec_from_file_location("sphframe_browser", Path(__file__).with_name("browser.py"))  # type: ignore[arg-type]
    )
    spec.loader.exec_module(browser)  # type: ignore[union-attr]
    began = time.monotonic()
    command = [sys.executable, "-m", "sphframe", "reproduce", "--quick", "--workers", "2", "--output", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=1500, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    print(f"{time.monotonic() - began:.0f} s")
    page = browser.Page((tmp_path / "report.html").read_text())
    figures = list((tmp_path / "figures").iterdir())
    assert len(page.images) == len(figures) == 15
    assert all(browser.decoded_width(source) > 200.0 for source in page.images)
    for text in ("Hydrostatic tank", "Dam break", "fixed wall", "movable wall", "Cost", "no --reference folder"):
        assert text in page.text
    claims = (tmp_path / "tables" / "claims.csv").read_text()
    assert all(verdict in claims for verdict in (",reproduced,", ",not reproduced,", ",not checkable,"))
    if browser.browser() is not None:
        seen = browser.seen_in_browser(tmp_path / "report.html", browser.browser())
        assert len(seen["images"]) == 15
        assert all(complete and width > 200 for _, complete, width, _ in seen["images"])
        assert (seen["outside"], seen["scripts"], seen["errors"]) == ([], 0, [])


@pytest.mark.parametrize("name", ["hydrostatic-tank", "dam-break", "fixed-wall", "movable-wall"])
@pytest.mark.filterwarnings("ignore:Attempting to set identical low and high ylims")  # of probes that stay dry
def test_a_chapter_is_written_of_runs_that_stop_at_once(name: str, cluster: str, tmp_path: Path) -> None:
    section = SECTIONS[name]

    def short(quick: bool) -> list[Task]:
        return [replace(task, parameters={**task.parameters, "until": 0.01}) for task in section.tasks(quick)]

    report = reproduce(tmp_path, quick=True, scheduler=cluster, sections={name: section._replace(tasks=short)})
    assert "<img" in report.read_text()
