"""The league table: runs, ranks and pages."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from scipy import stats
from typer.testing import CliRunner

from sphframe.cases import load_case
from sphframe.cli.app import app
from sphframe.errors import InputError
from sphframe.studies import compare
from sphframe.studies.ensemble import band_table, difference_table
from sphframe.studies.league import installed_benchmarks, installed_methods, rank
from sphframe.studies.league.drawing import curves
from sphframe.studies.league.result import ScoreTask
from sphframe.studies.league.table import league_dataset
from sphframe.studies.league.ties import ranks, relative_spread

METHODS = ["improved-shepard", "lennard-jones"]


def test_the_table_and_its_pages(cluster: str, tmp_path: Path) -> None:
    """A block is released: one method lets it fall, and one pushes it."""
    folder = tmp_path / "league"
    command = ["rank", "--quick", "--repeats", "2", "--methods", ",".join(METHODS), "--cases", "ceiling-release"]
    result = CliRunner().invoke(app, [*command, "--output", str(folder), "--scheduler", cluster], env={"NO_COLOR": "1"})
    assert result.exit_code == 0, result.output
    assert result.stdout.index("improved-shepard") < result.stdout.index("lennard-jones")
    made = {path.name: path.stat().st_mtime_ns for path in (folder / "runs").glob("*.nc")}
    assert len(made) == 4
    league = rank(output=folder, methods=METHODS, benchmarks=["ceiling-release"], quick=True, repeats=2)
    again = {path.name: path.stat().st_mtime_ns for path in (folder / "runs").glob("*.nc")}
    assert again == made, "finished runs are not repeated"
    column = league.dataset.sel(benchmark="ceiling-release")
    assert column["rank"].values.tolist() == [1, 2]
    assert float(column["score"][0]) < 1e-3 < float(column["score"][1])
    assert set(league.dataset["outcome"].values.flat) == {"completed"}
    page = league.page.read_text()
    assert re.search(r"improved-shepard.*?lennard-jones", page, re.S)
    for link in set(re.findall(r'(?:href|src)="([^"#]+)"', page)):
        assert (folder / link).exists(), link
    case_page = (folder / "benchmark-ceiling-release.html").read_text()
    for link in set(re.findall(r'src="([^"]+)"', case_page)):
        assert (folder / link).stat().st_size > 1000
    with xr.open_dataset(folder / "table.nc") as kept:
        xr.testing.assert_allclose(kept, league.dataset)
    lines = (folder / "table.csv").read_text().splitlines()
    assert len(lines) == 5


def test_what_was_measured_is_shown_beside_the_computation(tmp_path: Path) -> None:
    case = load_case("dam-break-impact", None, {"particle_spacing": 0.06, "until": 0.02})
    ScoreTask("impact", "dam-break-impact", case.model_dump(mode="json")).perform(
        tmp_path / "r.nc", 1, lambda part: None
    )
    with xr.open_dataset(tmp_path / "r.nc") as result:
        assert result.attrs["label"] == "computed by De Courcy (2024)"
        assert result["P1 reference"].attrs["label"] == "measured by Lobovsky (2014)"
        assert "P2 reference" not in result
        hit = np.flatnonzero(result["P1 reference"].values > 0.25 * 1000.0 * 9.81 * 0.6)[0]
        assert float(result["P1 reference at"][hit]) / np.sqrt(0.6 / 9.81) == pytest.approx(2.43, abs=0.05)
        with_it, without = curves("one", {"a": result}), curves("one", {"a": result.drop_vars("P1 reference")})
    assert with_it is not None
    assert without is not None
    assert with_it.content != without.content


def test_a_method_that_lacks_what_a_case_needs_is_not_applicable(cluster: str, tmp_path: Path) -> None:
    league = rank(
        output=tmp_path, methods=["lennard-jones"], benchmarks=["two-basins"], quick=True, repeats=1, scheduler=cluster
    )
    assert league.dataset["outcome"].values.ravel().tolist() == ["not applicable"]
    assert league.dataset["rank"].values.ravel().tolist() == [0]
    assert "thinner" in str(league.dataset["message"].values.ravel()[0])
    assert "n/a" in league.page.read_text()


def test_ranks_are_ties_within_the_spread() -> None:
    """Against scipy's t-test on samples with exactly these means and spreads."""
    rng = np.random.default_rng(3)
    for _ in range(50):
        n = int(rng.integers(2, 8))
        samples = rng.uniform(0.5, 1.5, (5, 1)) + rng.uniform(0.01, 0.3) * rng.standard_normal((5, n))
        found = ranks(samples.mean(axis=1), relative_spread(samples), n)
        chance = stats.ttest_ind(samples[:, None], samples[None, :], axis=2, equal_var=False).pvalue
        better = samples.mean(axis=1)[None, :] < samples.mean(axis=1)[:, None]
        assert found.tolist() == (1 + np.sum(better & (chance < 0.05), axis=1)).tolist()


def test_a_single_run_has_no_spread_and_failures_come_last() -> None:
    assert np.isnan(relative_spread(np.array([[0.1], [0.2]]))).all()
    assert ranks(np.array([0.2, np.nan, 0.1]), np.full(3, np.nan), 1).tolist() == [2, 3, 1]
    assert ranks(np.array([1e-15, 1e-12]), np.full(2, np.nan), 1).tolist() == [1, 1]


def test_the_score_is_that_of_the_finest_spacing_and_the_order_that_of_all() -> None:
    method, one = installed_methods(["shepard"])[0], installed_benchmarks(["couette"])[0]
    error = {0: 0.04, 1: 0.01}
    found = {
        ("shepard", "couette", k, 0): {"outcome": "completed", "message": "", "error: velocity": value}
        for k, value in error.items()
    }
    dataset = league_dataset([method], [one], 2, 1, found)
    assert dataset["score"].item() == 0.01
    assert dataset["order"].item() == pytest.approx(2.0)
    found["shepard", "couette", 1, 0] = {"outcome": "stopped", "message": "it blew up"}
    assert np.isnan(league_dataset([method], [one], 2, 1, found)["score"].item())


def test_every_benchmark_can_be_made() -> None:
    benchmarks = installed_benchmarks()
    assert len(benchmarks) >= 20
    method = installed_methods(["improved-shepard"])[0]
    for one in benchmarks:
        case = one.case(one.benchmark.spacings[0], 0, method)
        assert case.scene().fluid
        assert list(one.benchmark.spacings) == sorted(one.benchmark.spacings, reverse=True)


def test_an_installed_plugin_is_a_method(install: Callable[..., Path]) -> None:
    source = "from sphframe_shepard import ImprovedShepard\n\nclass Mine(ImprovedShepard):\n    '''Mine.'''\n"
    install("sphframe-mine", {"mine": source}, {"interpolators": {"mine": "mine:Mine"}})
    (method,) = [method for method in installed_methods() if method.name == "mine"]
    assert method.distribution == "sphframe-mine 1.0"
    assert method.description == "Mine."
    assert "fixed-ghosts" not in [method.name for method in installed_methods()]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"methods": ["improved-sheperd"]}, "improved-shepard"),
        ({"benchmarks": ["drum-rotatoin"]}, "drum-rotation"),
        ({"methods": ["shepard", "shepard"]}, "once"),
        ({"repeats": 0}, "repeats = 0"),
    ],
)
def test_wrong_input_is_refused(arguments: dict[str, object], message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=message):
        rank(output=tmp_path, **arguments)  # type: ignore[arg-type]


def test_repeats_of_a_comparison_give_bands(cluster: str, tmp_path: Path) -> None:
    tank = {"particle_spacing": 0.06, "tank_length": 0.3, "until": 0.05, "probe_interval": 0.005}
    found = compare(
        "hydrostatic-tank", ["improved-shepard", "shepard"], output=tmp_path, parameters=tank, repeats=3,
        scheduler=cluster,
    ).dataset  # fmt: skip
    assert dict(found["peak"].sizes)["repeat"] == 3
    impulse = found["impulse"].isel(particle_spacing=0, probe=0).values
    assert len(np.unique(impulse)) == impulse.size, "each repeat starts from another state"
    bands, differences = band_table(found).rows, difference_table(found).rows
    values = found["peak"].isel(interpolator=0, particle_spacing=0, probe=0).values
    low, high = stats.t.interval(0.95, 2, values.mean(), stats.sem(values))
    assert bands[0]["peak +- (Pa)"] == pytest.approx(0.5 * (high - low))
    assert {row["significant"] for row in differences} <= {"yes", "no"}
    assert (tmp_path / "tables" / "bands.csv").exists()
