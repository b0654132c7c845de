"""Figures and verdicts that the sections derive from series and times of known values."""

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from sphframe_huang2019.cost.claims import claims
from sphframe_huang2019.cost.medians import Medians, disturbance, growth
from sphframe_huang2019.cost.published import SPEED_UPS
from sphframe_huang2019.cost.states import VARIANTS
from sphframe_huang2019.dam_break.sensor import events, rms_difference

from sphframe.studies import Verdict


def pressure() -> xr.DataArray:
    """Zero, then a first peak of 0.7, a plateau of 0.5, and a second peak of 0.9 at 5.8."""
    t = np.arange(0.0, 7.0, 0.01)
    p = np.where(t < 2.5, 0.0, 0.5) + 0.2 * np.exp(-(((t - 2.8) / 0.1) ** 2)) + 0.4 * np.exp(-(((t - 5.8) / 0.1) ** 2))
    return xr.DataArray(p, coords={"t": t})


def test_events_of_a_sensor() -> None:
    found = events(pressure())
    assert found["arrival"] == pytest.approx(2.5, abs=0.011)
    assert found["first peak"] == pytest.approx(0.7, abs=1e-3)
    assert found["at"] == pytest.approx(2.8, abs=0.011)
    assert found["plateau"] == pytest.approx(0.5, abs=1e-3)
    assert found["second peak"] == pytest.approx(0.9, abs=1e-3)
    assert found["second peak at"] == pytest.approx(5.8, abs=0.011)


def test_a_run_that_ended_early_has_no_plateau_and_no_difference() -> None:
    early = pressure().sel(t=slice(0.0, 4.0))
    assert math.isnan(events(early)["plateau"])
    assert math.isnan(rms_difference(early, pressure()))
    assert rms_difference(pressure() + 0.1, pressure()) == pytest.approx(0.1)


def costs(fill: dict[str, float], neighbours: float, power: dict[str, float]) -> dict[str, Medians]:
    """Costs whose interpolation takes ``fill`` times neighbours^power, by the method."""
    return {
        v.label: Medians(
            fill=fill.get(v.method, 1.0) * neighbours ** power.get(v.method, 1.0),
            step=10.0,
            fill_ratio=fill.get(v.method, 1.0),
            step_ratio=fill.get(v.method, 1.0),
            fill_spread=0.0,
            step_spread=0.0,
            points=100.0,
            neighbours=neighbours,
        )
        for v in VARIANTS
    }


def test_differences_over_the_time_do_not_depend_on_where_points_crowd() -> None:
    t = np.linspace(0.0, 7.0, 701)
    computed = xr.DataArray(np.where(t < 3.0, 0.4, 0.0), coords={"t": t})
    sparse = xr.DataArray(np.zeros(8), coords={"t": np.arange(8.0)})
    crowded = np.unique(np.concatenate([np.arange(8.0), np.linspace(2.5, 2.9, 50)]))
    dense = xr.DataArray(np.zeros(len(crowded)), coords={"t": crowded})
    expected = 0.4 * math.sqrt(0.6 / 3.6)
    for experiment in (sparse, dense):
        assert rms_difference(computed, experiment) == pytest.approx(expected, rel=0.02)
    assert rms_difference(computed, sparse, at_points=True) == 0.0
    assert rms_difference(computed, dense, at_points=True) > 0.35


def test_growth_and_verdicts_of_costs() -> None:
    power = {"mls-quadratic": 2.0}
    by_ratio = {r: costs({}, 30.0 * r**2, power) for r in (1.0, 2.0, 3.0)}
    exponents = {v.label: growth(by_ratio, v.label) for v in VARIANTS}
    assert exponents["mls-quadratic, mirror"] == pytest.approx(2.0)
    assert exponents["normalized, mirror"] == pytest.approx(1.0)
    as_printed = {figure: costs(dict(ups), 30.0, {}) for figure, ups in SPEED_UPS.items()}
    verdicts = {(c.where, c.statement): c.verdict for c in claims(as_printed, exponents, None)}
    speed_ups = [verdict for (where, _), verdict in verdicts.items() if where.startswith("Fig")]
    assert set(speed_ups) == {Verdict.REPRODUCED}
    table = {statement: verdict for (where, statement), verdict in verdicts.items() if where == "Table 1"}
    assert table["The work of mls-quadratic grows with the square of the number of neighbours."] is Verdict.REPRODUCED
    assert table["The work of mls-linear grows with the square of the number of neighbours."] is Verdict.NOT_REPRODUCED


def test_on_a_busy_machine_times_decide_nothing() -> None:
    figures = {figure: costs(dict(ups), 30.0, {}) for figure, ups in SPEED_UPS.items()}
    exponents = {v.label: 1.0 for v in VARIANTS}
    runs = [xr.Dataset(attrs={"busy": 1.01}), xr.Dataset(attrs={"busy": 1.8})]
    assert disturbance(runs, figures.values()) is None
    measured = [{v: replace(one, fill_spread=0.4) for v, one in found.items()} for found in figures.values()]
    reason = disturbance(runs, measured)
    assert reason is not None
    assert "1.80 times" in reason
    judged = claims(figures, exponents, reason)
    assert {claim.verdict for claim in judged} == {Verdict.NOT_CHECKABLE}
    assert all(claim.reason == reason and claim.measured != "-" for claim in judged)
