"""The study from end to end, with runs that stop after a few steps."""

import csv
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sphframe_huang2019 import Huang2019

from sphframe.registry import available, create
from sphframe.studies import CostTask, Section, Study, Task, Verdict, reproduce

pytest.importorskip("distributed")

FIGURES = {
    "cost_scaling.svg", "cost_speed_up.svg", "dam_break_corner.png", "dam_break_ours.svg", "dam_break_paper.svg",
    "dam_break_profile.svg", "dam_break_snapshots.png", "fixed_wall_ours.svg", "fixed_wall_paper.svg",
    "fixed_wall_snapshots.png", "hydrostatic_ours.svg", "hydrostatic_paper.svg", "movable_wall.svg",
    "movable_wall_snapshots.png", "surge_front.svg",
}  # fmt: skip
TABLES = {
    "claims", "cost_interpolation", "cost_neighbours", "cost_particles", "cost_speed_up", "dam_break_p1",
    "dam_break_p1_shifted", "dam_break_published", "dam_break_runs", "fixed_wall", "hydrostatic_tank",
    "hydrostatic_tank_probes", "movable_wall", "surge_front",
}  # fmt: skip
SECTIONS = {section.name: section for section in Huang2019().sections()}


@pytest.fixture(scope="module")
def cluster() -> Iterator[str]:
    """The address of a scheduler with one worker in this process, which loads each compiled loop once."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address="127.0.0.1:0") as made:
        yield made.scheduler_address


def shortened(task: Task) -> Task:
    if isinstance(task, CostTask):
        return replace(task, after=0.0, repeats=2)
    return replace(task, parameters={**task.parameters, "until": 0.01})


class Shortened(Study):
    """The study with the quick tasks, each stopped after 0.01 s, or timed twice."""

    title, source = Huang2019.title, Huang2019.source

    def sections(self) -> Sequence[Section]:
        return [
            section._replace(tasks=lambda quick, section=section: [shortened(task) for task in section.tasks(True)])
            for section in SECTIONS.values()
        ]


def write_reference_series(folder: Path) -> None:
    """Write series of the right names and columns; their values are arbitrary."""
    t = np.linspace(0.0, 8.0, 81)
    for name in ("buchner2002_P1", "buchner2002_P1_second", "martin_moyce1952_table_front",
                 "martin_moyce1952_table_height", "marrone2011_P1_simulation"):  # fmt: skip
        columns = 4 if name == "marrone2011_P1_simulation" else 1
        np.savetxt(folder / f"{name}.csv", np.column_stack([t, *[np.sin(t)] * columns]), delimiter=",")


def test_it_is_registered() -> None:
    assert "huang2019" in [entry.name for entry in available("studies")]
    assert isinstance(create("studies", "huang2019"), Huang2019)


@pytest.mark.parametrize("quick", [True, False], ids=["quick", "whole"])
@pytest.mark.parametrize("name", SECTIONS)
def test_the_tasks_of_a_section_differ_and_are_valid(name: str, quick: bool) -> None:
    own = SECTIONS[name].tasks(quick)
    assert len({task.label for task in own}) == len({task.name for task in own}) == len(own) > 4
    assert all(task.weight > 0.0 for task in own)


@pytest.mark.filterwarnings("ignore:Attempting to set identical low and high")
def test_a_section_has_every_figure_and_table(cluster: str, tmp_path: Path) -> None:
    reproduce(Shortened(), output=tmp_path, quick=True, only=["movable-wall"], reference=tmp_path, scheduler=cluster)
    for folder, all_names in (("figures", FIGURES), ("tables", {f"{name}.csv" for name in TABLES})):
        made = {path.name for path in (tmp_path / folder).iterdir()} - {"claims.csv"}
        assert made == {name for name in all_names if name.startswith("movable_wall")}


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:Attempting to set identical low and high")
def test_the_report_has_every_figure_table_and_claim(cluster: str, tmp_path: Path) -> None:
    write_reference_series(tmp_path)
    report = reproduce(Shortened(), output=tmp_path, quick=True, reference=tmp_path, scheduler=cluster)
    assert {path.name for path in (tmp_path / "figures").iterdir()} == FIGURES
    assert {path.stem for path in (tmp_path / "tables").iterdir()} == TABLES
    page = report.read_text()
    assert page.count("<img") == len(FIGURES)
    for title in ("Hydrostatic tank", "Dam break", "fixed wall", "movable wall", "Cost"):
        assert title in page
    with (tmp_path / "tables" / "claims.csv").open(newline="") as file:
        claims = list(csv.DictReader(file))
    assert len(claims) == 37
    assert {claim["verdict"] for claim in claims} <= {verdict.value for verdict in Verdict}
