"""Tables of costs."""

from collections.abc import Mapping

import xarray as xr

from sphframe.studies import Cell, Table
from sphframe_huang2019.cost.medians import Medians
from sphframe_huang2019.cost.published import GROWTH, SPEED_UPS
from sphframe_huang2019.cost.states import FIRST, VARIANTS, spacing_label

__all__ = ["interpolation", "neighbours", "particles", "whole_steps"]


def interpolation(usual: Mapping[str, Medians], growth: Mapping[str, float]) -> Table:
    """Return the cost of the interpolation alone, and its growth with the neighbours beside the paper's Table 1."""
    rows: list[dict[str, Cell]] = [
        {
            "boundary": v.label,
            "us per point": usual[v.label].per_point,
            "ns per neighbour": 1e3 * usual[v.label].per_point / usual[v.label].neighbours,
            "over improved Shepard": usual[v.label].fill_ratio,
            "part of a step (%)": usual[v.label].share,
            "grows with neighbours to the power": growth[v.label],
            "paper's Table 1": {1: "linear", 2: "quadratic"}[GROWTH[v.method]] if v.published else None,
        }
        for v in VARIANTS
    ]
    return Table("cost_interpolation", "Interpolation alone, still water, smoothing length 1.3 spacings", rows)


def whole_steps(figures: Mapping[str, Mapping[str, Medians]]) -> Table:
    """Return the cost of a whole step in the cases of the paper's figures."""
    cases = {"Fig. 4": "still water", "Fig. 9": "dam break", "Fig. 12": "solitary wave"}
    rows: list[dict[str, Cell]] = [
        {
            "case": cases[figure],
            "boundary": v.label,
            "ms per step": 1e3 * found[v.label].step,
            "quartiles apart (%)": 100.0 * found[v.label].step_spread,
            "step, over improved Shepard": found[v.label].step_ratio,
            "interpolation, over improved Shepard": found[v.label].fill_ratio,
            "paper (step)": SPEED_UPS[figure].get(v.method) if v.published else None,
        }
        for figure, found in figures.items()
        for v in VARIANTS
    ]
    return Table("cost_speed_up", "Whole step: how many times longer than with improved Shepard", rows)


def particles(by_spacing: Mapping[float, Mapping[str, Medians]], runs: Mapping[str, xr.Dataset]) -> Table:
    """Return the time of a step by the number of particles."""
    heads = {spacing: f"{runs[spacing_label(spacing)].attrs['particles']} particles" for spacing in by_spacing}
    rows: list[dict[str, Cell]] = [
        {"boundary": v.label, **{heads[s]: 1e3 * found[v.label].step for s, found in by_spacing.items()}}
        for v in VARIANTS
    ]
    return Table("cost_particles", "As Fig. 4a: ms per step against the number of particles, still water", rows)


def neighbours(by_ratio: Mapping[float, Mapping[str, Medians]]) -> Table:
    """Return the time of the interpolation of a point by the number of its neighbours."""
    rows: list[dict[str, Cell]] = [
        {
            "boundary": v.label,
            **{f"{found[FIRST].neighbours:.0f} neighbours": found[v.label].per_point for found in by_ratio.values()},
        }
        for v in VARIANTS
    ]
    return Table("cost_neighbours", "Interpolation alone: us per point against the number of neighbours", rows)
