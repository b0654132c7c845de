"""``compare`` makes one dataset over method and resolution."""

import json
import subprocess
import sys
from pathlib import Path

import matplotlib
import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner, Result

from sphframe.analysis import summary
from sphframe.cli.app import app
from sphframe.errors import InputError
from sphframe.output import open_dataset
from sphframe.studies import compare
from sphframe.studies.comparison_chapter import comparison_chapter

TANK = {"tank_length": 0.3, "until": 0.2, "probe_interval": 0.01}
DAM = {"tank_length": 1.6, "until": 0.3, "frame_interval": 0.1}


def call(*arguments: str) -> Result:
    return CliRunner().invoke(app, arguments, env={"COLUMNS": "200", "NO_COLOR": "1"})


def test_the_command_gives_a_dataset_a_table_and_figures(cluster: str, tmp_path: Path) -> None:
    result = call(
        *("compare", "hydrostatic-tank", "--interpolators", "improved-shepard,normalized"),
        *("--set", "particle_spacing=0.06,0.05,0.03", "--set", "tank_length=0.3", "--set", "until=0.2"),
        *("--set", "hydrostatic_lift=mirror", "--scheduler", cluster, "--output", str(tmp_path / "out")),
    )
    assert result.exit_code == 0, result.output
    assert "normalized" in result.stdout
    with xr.open_dataset(tmp_path / "out" / "comparison.nc") as dataset:
        assert dict(dataset["error"].sizes) == {"interpolator": 2, "particle_spacing": 3}
        assert dataset["particle_spacing"].values.tolist() == [0.06, 0.05, 0.03]
        assert (dataset["error"] > 0.0).all()
        slopes = np.polyfit(np.log(dataset["particle_spacing"]), np.log(dataset["error"].T), 1)[0]
        assert np.allclose(dataset["order"], slopes)
        rest = dataset["probe_pressure"].sel(interpolator="improved-shepard", particle_spacing=0.03, probe="P1")
        assert abs(float(rest.mean()) - 1962.0) < 300.0
    made = {path.relative_to(tmp_path / "out").as_posix() for path in (tmp_path / "out").rglob("*") if path.is_file()}
    assert {"report.html", "tables/comparison.csv", "figures/comparison.svg", "figures/comparison_probes.svg"} <= made


def test_without_exact_values_the_error_is_from_the_finest_spacing(cluster: str, tmp_path: Path) -> None:
    found = compare("dam-break", ["shepard"], [0.06, 0.055, 0.05], output=tmp_path, parameters=DAM, scheduler=cluster)
    error = found.dataset["error"].sel(interpolator="shepard").values
    assert np.isfinite(error[:2]).all()
    assert np.isnan(error[2])
    assert "finest spacing" in found.dataset["error"].attrs["long_name"]
    chapter = comparison_chapter(found.dataset)
    with matplotlib.rc_context({"svg.fonttype": "none"}):
        drawn = comparison_chapter(found.dataset, {"P1": [xr.DataArray([1.0], {"t": [2.0]}, name="Buchner")]})
    assert [b"Buchner" in one.pictures[-1].content for one in (chapter, drawn)] == [False, True]


def test_a_case_with_an_exact_solution_gives_the_error_of_methods_of_both_kinds(cluster: str, tmp_path: Path) -> None:
    methods, few = ["improved-shepard", "dynamic-2007"], {"kinematic_viscosity": 1e-6, "slip": "no", "until": 0.01}
    found = compare("accelerated-tank", methods, [0.03], output=tmp_path, parameters=few, scheduler=cluster).dataset
    assert "exact solution: pressure" in found["error"].attrs["long_name"]
    for path in (tmp_path / "runs").glob("*.nc"):
        with open_dataset(path) as run:
            treatment = json.loads(run.attrs["case_parameters"])["wall_treatment"]["name"]
            name = "improved-shepard" if treatment == "fixed-ghosts" else treatment
            assert float(found["error"].sel(interpolator=name)[0]) == summary(run)["errors"]["pressure"]


def test_with_a_reference_the_error_is_from_the_reference(cluster: str, tmp_path: Path) -> None:
    series = tmp_path / "level.csv"
    series.write_text("# columns: t sqrt(g/H),p/(rho g H)\n0.1,1.0\n0.5,1.0\n1.0,1.0\n")
    found = compare(
        "hydrostatic-tank", ["shepard"], [0.03], output=tmp_path / "out", parameters=TANK, reference=series,
        probe="P1", scheduler=cluster,
    )  # fmt: skip
    assert abs(float(found.dataset["error"][0, 0]) - 1.0 / 3.0) < 0.05
    with pytest.raises(InputError, match="no probe 'P9'"):
        compare("hydrostatic-tank", ["shepard"], [0.03], output=tmp_path / "out", parameters=TANK, probe="P9")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["compare", "hydrostatic-tank", "--interpolators", "improved-sheperd"], "improved-shepard"),
        (["compare", "hydrostatic-tank", "--interpolators", "shepard,shepard"], "give each method once"),
        (["compare", "hydrostatic-tank", "--set", "particle_spacing=0.1,fine"], "give numbers separated by commas"),
        (["compare", "hydrostatic-tank", "--set", "particle_spacing=-1,0.1"], "particle_spacing"),
        (["compare", "no-such-case"], "no-such-case"),
        (["compare", "hydrostatic-tank", "--reference", "nowhere/x.csv"], "does not exist"),
        (["reproduce", "--output", "x", "--only", "dam-brake"], "dam-break"),
        (["reproduce", "--output", "x", "--reference", "nowhere"], "there is no such folder"),
        (["reproduce", "--output", "x", "--only", "movable-wall", "--workers", "0"], "--workers 0"),
    ],
)
def test_wrong_input_is_refused_before_anything_runs(
    arguments: list[str], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = call(*arguments)
    assert result.exit_code == 2
    assert message in result.stderr
    assert not list(tmp_path.rglob("*.nc"))


def test_the_command_works_in_a_new_process(tmp_path: Path) -> None:
    """Where nothing has imported dask's parts before; their order of import once mattered."""
    sizes = ["--set", "particle_spacing=0.06", "--set", "until=0.01"]
    options = ["--interpolators", "shepard", "--workers", "1", "--output", str(tmp_path)]
    command = ["compare", "hydrostatic-tank", *options, *sizes]
    done = subprocess.run([sys.executable, "-m", "sphframe", *command], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "comparison.nc").exists()
