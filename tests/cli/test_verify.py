"""``sphframe verify``: what is verified by default, and its tables, with results that are given."""

import json
from xml.etree import ElementTree

import pytest

from sphframe import InputError
from sphframe.cli.verify import TREATMENT_HEADINGS, markdown, treatment_rows
from sphframe.cli.verify import verify as print_verification
from sphframe.testing import Check, Report, WallResiduals, verification
from sphframe.testing.junit import write_junit

FOUND = Report(
    "ghosts",
    "wall_treatments",
    "sphframe-ghosts 1.0",
    tuple(
        verification.Result(Check(name, print, promised=promised, optional=True), failure)
        for name, promised, failure in [
            ("momentum", True, None),
            ("exact_constant", True, None),
            ("exact_hydrostatic", False, None),
            ("exact_shear", False, "0.44 in the first layer"),
            ("exact_normal", True, "0.69 in the first layer"),
            ("conjugate", False, "1 W"),
        ]
    ),
    measured={
        "gaussian": WallResiduals((-1e-9, 0.0), (-0.49977, -0.2153), (0.6944, 0.9406), (0.4363, 0.0291)),
        "wendland-c2": WallResiduals((0.0, 0.0), (-0.4996, -0.2991), (0.6707, 0.9112), (0.4305, 0.0474)),
    },
)
TRAITS = ["yes", "(yes)", "-", "BROKEN", "-", "yes"]


@pytest.fixture
def given(monkeypatch):
    """The labels of all components that were asked for; each has the results above."""
    asked = []

    def report(kind, label, *rest):
        asked.append((kind, label))
        return FOUND

    monkeypatch.setattr(verification, "_report", report)
    return asked


def test_the_rows_of_a_treatment_are_its_traits_and_its_errors():
    first, second = ([cell.plain for cell in row] for row in treatment_rows(FOUND))
    assert first == [
        "ghosts", *TRAITS, "gaussian", "0.000 / 0.000", "-0.500 / -0.215", "0.694 / 0.941", "0.436 / 0.029",
    ]  # fmt: skip
    assert second[:8] == ["", *[""] * 6, "wendland-c2"]
    failed = Report("ghosts", "wall_treatments", "", (), "does not compile")
    assert [[cell.plain for cell in row] for row in treatment_rows(failed)] == [
        ["ghosts", *["BROKEN"] * 6, "", "", "", "", ""]
    ]


def test_markdown():
    lines = markdown(TREATMENT_HEADINGS, treatment_rows(FOUND)).splitlines()
    assert lines[0] == "| treatment | C | H | S | D | J | M | kernel | uniform | hydrostatic | normal | shear |"
    assert lines[1].replace(" ", "") == "|" + "---|" * 12
    assert lines[2].startswith("| ghosts | yes | (yes) | - | BROKEN | - | yes | gaussian | 0.000 / 0.000 |")


def test_interpolators_and_wall_treatments_are_verified_by_default(given, capsys):
    assert print_verification() == 1
    assert {kind for kind, _ in given} == {"interpolators", "wall_treatments"}
    assert {"fixed-ghosts", "mdbc-2025", "mdbc-2025[velocity=corrected]"} <= {label for _, label in given}
    assert "-0.500 / -0.215" in capsys.readouterr().out


def test_a_kind_stands_for_all_that_is_installed_of_it(given, capsys):
    assert print_verification(["wall_treatments"], as_markdown=True) == 1
    assert {kind for kind, _ in given} == {"wall_treatments"}
    shown = capsys.readouterr().out
    assert shown.count("| ghosts | yes | (yes) | - | BROKEN | - | yes | gaussian |") == len(given)
    assert "0.69 in the first layer" in shown


def test_json_contains_what_was_measured(given, capsys):
    assert print_verification(["fixed-ghosts"], as_json=True) == 1
    (report,) = json.loads(capsys.readouterr().out)
    assert report["measured"]["wendland-c2"]["normal"] == [0.6707, 0.9112]
    assert report["properties"]["exact_hydrostatic"] == "held"


def test_expected_failures_callback_and_junit(tmp_path):
    seen = []
    (report,) = verification.verify(
        ["tait"],
        callback=lambda label, result: seen.append((label, str(result.check), result.verdict)),
        expected_failed_checks={"inverse": "we say so"},
    )
    assert [result.verdict for result in report.results] == ["kept", "broken", "kept", "kept"]
    assert seen[1] == ("tait", "inverse", "broken")
    assert report.as_data()["checks"][1]["expected"] == "we say so"
    failing = verification.Result(Check("inverse", print), "2 instead of 1", "known")
    absent = verification.Result(Check("linear", print, promised=False), "no")
    others = Report("doubtful", "kernels", "", (failing, absent), None)
    write_junit([report, others, Report("lost", "kernels", "", (), "cannot be made: no width")], tmp_path / "found.xml")
    root = ElementTree.parse(tmp_path / "found.xml").getroot()
    suites = {suite.get("name"): suite.attrib for suite in root}
    assert suites["tait"] == {"name": "tait", "tests": "4", "failures": "1", "errors": "0", "skipped": "0"}
    assert suites["doubtful"]["skipped"] == "2"
    assert suites["lost"]["errors"] == "1"
    assert root.find(".//failure").get("message") == "it was expected to fail (we say so), but holds"


def test_json_and_markdown_exclude_each_other():
    with pytest.raises(InputError, match="--json and --markdown exclude each other"):
        print_verification(["fixed-ghosts"], as_json=True, as_markdown=True)
