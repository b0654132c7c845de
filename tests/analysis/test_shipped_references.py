"""Measured series that are shipped with a case are drawn by default, beside a run of the same shape only."""

import numpy as np
import pytest

from sphframe.analysis import plot_run
from sphframe.analysis.figures import printed_unit
from sphframe.analysis.reference import shipped_references
from sphframe.cases.dam_break import DamBreak
from sphframe.simulation.run import run


def test_the_dam_break_ships_what_buchner_measured() -> None:
    dataset = run(DamBreak(particle_spacing=0.06, until=0.02), threads=1).dataset
    (series,) = shipped_references(dataset)
    assert "Buchner" in str(series.name)
    late = series.sel(t=slice(2.0, None))
    hit = float(late["t"][np.flatnonzero(late.values > 0.1)[0]])
    assert hit == pytest.approx(2.49, abs=0.02)  # when the front arrives at the wall, in units of sqrt(H/g)
    assert 0.5 < float(series.max()) < 1.5
    labels = [line.get_label() for axes in plot_run(dataset).axes for line in axes.get_lines()]
    assert series.name in labels
    without = plot_run(dataset, reference=())
    assert series.name not in [line.get_label() for axes in without.axes for line in axes.get_lines()]


def test_a_dam_break_of_another_shape_has_no_measurement() -> None:
    assert not DamBreak(water_length=0.6).references()
    assert DamBreak(water_height=0.3).references()


def test_units_are_printed_as_people_write_them() -> None:
    assert [printed_unit(unit) for unit in ("Pa", "m s-2", "kg m-3", "m2 s-1", "N m-1", "N m m-1")] == [
        "Pa", "m/s²", "kg/m³", "m²/s", "N/m", "N m/m",
    ]  # fmt: skip
