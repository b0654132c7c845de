"""The validation cases are carried out from end to end, at coarse resolutions and for short times."""

import csv
import importlib
from pathlib import Path

import pytest

from sphframe import open_dataset
from sphframe.studies import fallback_share, reproduce

ROOT = Path(__file__).parents[2]
CASES = {
    "hydrostatic_tank": ("StillWater", {"key_figures": 4}),
    "dam_break": ("DamBreak", {"key_figures": 2}),
    "solitary_wave": ("SolitaryWaves", {"key_figures_vertical": 2, "key_figures_leaning": 1, "key_figures_movable": 1}),
}


@pytest.mark.parametrize(
    "case", [pytest.param(name, marks=[pytest.mark.long] if name == "solitary_wave" else []) for name in CASES]
)
def test_a_validation_case_makes_its_tables_and_pictures(
    case: str, cluster: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(ROOT)
    name, tables = CASES[case]
    study = getattr(importlib.import_module(f"validation.{case}.run"), name)()
    report = reproduce(study, output=tmp_path, quick=True, scheduler=cluster)
    assert report.read_text().count("<img") >= len(tables)
    shares = []
    for table, count in tables.items():
        with (tmp_path / "tables" / f"{table}.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        assert len(rows) == count
        assert {row["to the end"] for row in rows} == {"yes"}
        shares += [float(row["fallback (% of wet ghosts)"]) for row in rows]
    computed = []
    for path in (tmp_path / "runs").glob("*.nc"):
        with open_dataset(path) as run:
            computed.append(float(f"{fallback_share(run):.6g}"))
    assert set(shares) <= set(computed)
    assert max(shares) > 0.0 or case == "solitary_wave"


def test_wall_treatments_are_compared(cluster: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT)
    study = importlib.import_module("validation.wall_treatments.run").WallTreatments()
    report = reproduce(study, output=tmp_path, only=["tank"], quick=True, scheduler=cluster)
    assert report.read_text().count("<img") == 1
    with (tmp_path / "tables" / "key_figures_tank.csv").open(newline="") as file:
        still, moving = csv.DictReader(file)
    assert (still["treatment"], moving["treatment"]) == ("fixed-ghosts", "lennard-jones")
    fastest = "fastest particle (% of sqrt(g H))"
    assert float(still[fastest]) < 1.0 < 100.0 < float(moving[fastest])


@pytest.mark.long
def test_findings_have_their_numbers(cluster: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT)
    study = importlib.import_module("validation.findings.run").Findings()
    reproduce(study, output=tmp_path, only=["impact", "cavity"], quick=True, scheduler=cluster)
    for name, column, factor in (
        ("impact", "plateau (%), 0.04 m", 3.0),
        ("cavity", "density (% per second), 0.05 m", 2.0),
    ):
        with (tmp_path / "tables" / f"key_figures_{name}.csv").open(newline="") as file:
            corrected, of_the_wall = csv.DictReader(file)
        assert factor * float(corrected[column]) < float(of_the_wall[column])
