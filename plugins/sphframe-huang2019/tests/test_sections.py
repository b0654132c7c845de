"""What the sections read from series of known shape."""

import math

import numpy as np
import pytest
import xarray as xr
from sphframe_huang2019 import cost, dam_break

from sphframe.studies import Verdict


def pressure() -> xr.DataArray:
    """Nothing, a first peak of 0.7, a plateau of 0.5, a second peak of 0.9 at 5.8."""
    t = np.arange(0.0, 7.0, 0.01)
    p = np.where(t < 2.5, 0.0, 0.5) + 0.2 * np.exp(-(((t - 2.8) / 0.1) ** 2)) + 0.4 * np.exp(-(((t - 5.8) / 0.1) ** 2))
    return xr.DataArray(p, coords={"t": t})


def test_events_of_a_sensor() -> None:
    events = dam_break._events(pressure())
    assert events["arrival"] == pytest.approx(2.5, abs=0.011)
    assert events["first peak"] == pytest.approx(0.7, abs=1e-3)
    assert events["at"] == pytest.approx(2.8, abs=0.011)
    assert events["plateau"] == pytest.approx(0.5, abs=1e-3)
    assert events["second peak"] == pytest.approx(0.9, abs=1e-3)
    assert events["second peak at"] == pytest.approx(5.8, abs=0.011)


def test_a_run_that_ended_early_has_no_plateau_and_no_difference() -> None:
    early = pressure().sel(t=slice(0.0, 4.0))
    assert math.isnan(dam_break._events(early)["plateau"])
    assert math.isnan(dam_break._rms(early, pressure()))
    assert dam_break._rms(pressure() + 0.1, pressure()) == pytest.approx(0.1)


def medians(fill: dict[str, float], neighbours: float, power: dict[str, float]) -> dict[str, dict[str, float]]:
    return {
        v.label: {
            "fill": fill.get(v.method, 1.0) * neighbours ** power.get(v.method, 1.0),
            "fill ratio": fill.get(v.method, 1.0),
            "step": 10.0,
            "step ratio": fill.get(v.method, 1.0),
            "points": 100.0,
            "neighbours": neighbours,
            "spread": 0.0,
            "fill spread": 0.0,
        }
        for v in cost.VARIANTS
    }


def test_differences_over_the_time_do_not_depend_on_where_points_crowd() -> None:
    t = np.linspace(0.0, 7.0, 701)
    computed = xr.DataArray(np.where(t < 3.0, 0.4, 0.0), coords={"t": t})
    sparse = xr.DataArray(np.zeros(8), coords={"t": np.arange(8.0)})
    crowded = np.unique(np.concatenate([np.arange(8.0), np.linspace(2.5, 2.9, 50)]))
    dense = xr.DataArray(np.zeros(len(crowded)), coords={"t": crowded})
    expected = 0.4 * math.sqrt(0.6 / 3.6)
    for experiment in (sparse, dense):
        assert dam_break._rms(computed, experiment) == pytest.approx(expected, rel=0.02)
    assert dam_break._rms(computed, sparse, at_points=True) == 0.0
    assert dam_break._rms(computed, dense, at_points=True) > 0.35


def test_growth_and_verdicts_of_costs() -> None:
    power = {"mls-quadratic": 2.0}
    by_ratio = {r: medians({}, 30.0 * r**2, power) for r in (1.0, 2.0, 3.0)}
    growth = {v.label: cost._growth(by_ratio, v.label) for v in cost.VARIANTS}
    assert growth["mls-quadratic, mirror"] == pytest.approx(2.0)
    assert growth["normalized, mirror"] == pytest.approx(1.0)
    as_printed = {figure: medians(dict(ups), 30.0, {}) for figure, ups in cost.SPEED_UPS.items()}
    verdicts = {(c.where, c.statement): c.verdict for c in cost._claims(as_printed, growth, None)}
    speed_ups = [verdict for (where, _), verdict in verdicts.items() if where.startswith("Fig")]
    assert set(speed_ups) == {Verdict.REPRODUCED}
    table = {statement: verdict for (where, statement), verdict in verdicts.items() if where == "Table 1"}
    assert table["The work of mls-quadratic grows with the square of the number of neighbours."] is Verdict.REPRODUCED
    assert table["The work of mls-linear grows with the square of the number of neighbours."] is Verdict.NOT_REPRODUCED


def test_on_a_busy_machine_times_decide_nothing() -> None:
    figures = {figure: medians(dict(ups), 30.0, {}) for figure, ups in cost.SPEED_UPS.items()}
    growth = {v.label: 1.0 for v in cost.VARIANTS}
    runs = {"a": xr.Dataset(attrs={"busy": 1.01}), "b": xr.Dataset(attrs={"busy": 1.8})}
    assert cost._disturbance(runs, list(figures.values())) is None
    measured = [{v: {**one, "fill spread": 0.4} for v, one in found.items()} for found in figures.values()]
    reason = cost._disturbance(runs, measured)
    assert reason is not None
    claims = cost._claims(figures, growth, reason)
    assert "1.80 times" in reason
    assert {claim.verdict for claim in claims} == {Verdict.NOT_CHECKABLE}
    assert all(claim.reason == reason and claim.measured != "-" for claim in claims)
