"""Figures of costs."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from sphframe.studies import Picture, colour, new_figure, picture, tidy
from sphframe_huang2019.cost.medians import Medians
from sphframe_huang2019.cost.published import SPEED_UPS
from sphframe_huang2019.cost.states import FIRST, VARIANTS
from sphframe_huang2019.variants import PAPER

__all__ = ["scaling", "speed_ups"]


def scaling(
    by_ratio: Mapping[float, Mapping[str, Medians]], by_spacing: Mapping[float, Mapping[str, Medians]]
) -> Picture:
    """Draw the cost of the interpolation over the neighbours, and of a step over the particles."""
    figure = new_figure(10.0, 4.2)
    left, right = figure.subplots(1, 2)
    for v in VARIANTS:
        style: dict[str, Any] = {
            "color": colour(v.method),
            "linewidth": 1.0,
            "linestyle": "-" if v.published else ":",
            "marker": "o",
            "markersize": 3,
        }
        own = [found[v.label] for found in by_ratio.values()]
        left.plot([m.neighbours for m in own], [m.per_point for m in own], label=v.label, **style)
        steps = [1e3 * found[v.label].step for found in by_spacing.values()]
        right.plot([0.3 / spacing**2 for spacing in by_spacing], steps, **style)
    low = by_ratio[min(by_ratio)][FIRST]
    n = np.array([low.neighbours, by_ratio[max(by_ratio)][FIRST].neighbours])
    left.plot(n, low.per_point * n / n[0], color="black", linewidth=0.7, linestyle="--", label="linear")
    left.plot(n, low.per_point * (n / n[0]) ** 2, color="black", linewidth=0.7, linestyle="-.", label="quadratic")
    tidy(left, xscale="log", yscale="log", xlabel="neighbours of a point", ylabel="interpolation, us per point")
    tidy(right, xscale="log", yscale="log", xlabel="particles", ylabel="whole step, ms")
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize=8)
    return picture("cost_scaling", "Cost against neighbours, and against particles as in Fig. 4a.", figure)


def speed_ups(figures: Mapping[str, Mapping[str, Medians]]) -> Picture:
    """Draw the times over those of improved Shepard beside the paper's."""
    figure = new_figure(10.0, 3.8)
    panels = figure.subplots(1, len(figures), sharey=True)
    shown = [v for v in PAPER if v.label != FIRST]
    place = np.arange(len(shown))
    for axes, (name, found) in zip(panels, figures.items(), strict=True):
        for shift, heights, shade, label in (
            (-0.27, [SPEED_UPS[name].get(v.method, math.nan) for v in shown], "#bbbbbb", "paper, whole step"),
            (0.0, [found[v.label].step_ratio for v in shown], "#1f77b4", "here, whole step"),
            (0.27, [found[v.label].fill_ratio for v in shown], "#ff7f0e", "here, interpolation alone"),
        ):
            axes.bar(place + shift, heights, 0.25, color=shade, label=label)
        axes.axhline(1.0, color="black", linewidth=0.6)
        axes.set_xticks(place, [v.method for v in shown], rotation=20, fontsize=8)
        tidy(axes, title=f"as {name}")
    panels[0].set_ylabel("times improved Shepard")
    panels[0].legend(fontsize=8, frameon=False, loc="upper left")
    return picture("cost_speed_up", "Speed-ups of improved Shepard beside the paper's (Figs. 4b, 9b and 12b).", figure)
