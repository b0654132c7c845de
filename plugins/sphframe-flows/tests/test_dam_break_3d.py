"""The dam break on a box: where its instruments are, and what its impulses are."""

import numpy as np
import pytest
import xarray as xr
from sphframe_flows import DamBreak3D


def test_instruments_are_where_the_experiment_has_them() -> None:
    scene = DamBreak3D().scene()
    places = {probe.name: np.array(probe.position) for probe in scene.probes}
    front = [(0.8245, 0.4745, z) for z in (0.021, 0.061, 0.101, 0.141)]
    top = [(x, 0.5255, 0.161) for x in (0.8035, 0.7635, 0.7235, 0.6835)]
    for number, place in enumerate([*front, *top], 1):
        assert places[f"P{number}"] == pytest.approx(place, abs=1e-12)
    gauges = {gauge.name: gauge.position for gauge in scene.gauges}
    for name, x in {"H1": 0.496, "H2": 0.992, "H3": 1.488, "H4": 2.638}.items():
        assert gauges[name] == pytest.approx((x, 0.5), abs=1e-12)
    tall = {probe.name: np.array(probe.position) for probe in DamBreak3D(box_height=0.322).scene().probes}
    assert tall["P4"] == pytest.approx((0.8245, 0.4745, 0.282), abs=1e-12)
    assert tall["P5"] == pytest.approx((0.8035, 0.5255, 0.322), abs=1e-12)


def test_column_stands_at_the_right_end_and_has_no_pressure_on_its_free_sides() -> None:
    case = DamBreak3D()
    scene = case.scene()
    (water,) = scene.fluid
    assert (water.lower, water.upper) == ((3.22 - 1.228, 0.0, 0.0), (3.22, 1.0, 0.55))
    pressure = scene.initial_pressure(np.array([[1.992, 0.5, 0.2], [2.6, 0.5, 0.55], [3.22, 0.5, 0.02]]))
    assert pressure[:2] == pytest.approx(0.0, abs=1e-6)
    assert 0.8 < pressure[2] / (1000.0 * 9.81 * 0.55) < 1.0


def test_impulses_are_integrals_between_the_samples() -> None:
    times = np.arange(0.0, 0.7, 0.03)  # neither 0.4 nor 0.6 is a sample
    pressure = np.column_stack([np.full_like(times, 500.0), 1000.0 * times])
    dataset = xr.Dataset(
        {"probe_pressure": (("probe_time", "probe"), pressure)}, {"probe_time": times, "probe": ["P1", "P2"]}
    )
    assert DamBreak3D().impulses(dataset).values == pytest.approx([100.0, 100.0])
