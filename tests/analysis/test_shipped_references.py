"""Measured series that are shipped with a case are drawn by default, beside a run of the same shape only."""

import numpy as np
import pytest
import xarray as xr

from sphframe.analysis import plot_run
from sphframe.analysis.exact import references_by_name
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


def test_measurements_are_drawn_with_the_variable_of_their_place() -> None:
    case = pytest.importorskip("sphframe_flows").DamBreakImpact(particle_spacing=0.06, until=0.02)
    figure = plot_run(run(case, threads=1).dataset)
    panels = [axes for axes in figure.axes if axes.get_ylabel().startswith("pressure at")]
    arrivals = []
    for panel, place in zip(panels, ("P1", None, "P3", "P4"), strict=True):
        measured = [line for line in panel.get_lines() if "Lobovsky" in str(line.get_label())]
        assert [line.get_label() for line in measured] == ["measured by Lobovsky (2014)"] * bool(place)
        for line in measured:
            hit = np.flatnonzero(np.asarray(line.get_ydata()) > 0.25 * 1000.0 * 9.81 * 0.6)[0]
            arrivals.append(float(line.get_xdata()[hit]) / case.time_scale)
    assert arrivals[0] == pytest.approx(2.43, abs=0.05)
    assert arrivals == sorted(arrivals)


def test_a_series_belongs_to_the_probe_that_its_name_begins_with() -> None:
    dataset = xr.Dataset(attrs={"reference_density": 1000.0, "gravity": 10.0, "depth": 2.5})
    series = [xr.DataArray([1.0, 0.5], {"t": [0.0, 2.0]}, name=name) for name in ("P2 measured", "P9 measured", "P1")]
    found = references_by_name(series, dataset, ["P1", "P2", "P3"])
    assert {name: [str(one.name) for one in own] for name, own in found.items()} == {
        "P1": [""], "P2": ["measured"], "P3": [],
    }  # fmt: skip
    (one,) = found["P2"]
    assert one.values.tolist() == [25000.0, 12500.0]
    assert one["t"].values.tolist() == [0.0, 1.0]


def test_a_dam_break_of_another_shape_has_no_measurement() -> None:
    assert not DamBreak(water_length=0.6).references()
    assert DamBreak(water_height=0.3).references()


def test_units_are_printed_as_people_write_them() -> None:
    assert [printed_unit(unit) for unit in ("Pa", "m s-2", "kg m-3", "m2 s-1", "N m-1", "N m m-1")] == [
        "Pa", "m/s²", "kg/m³", "m²/s", "N/m", "N m/m",
    ]  # fmt: skip
