"""The chapter on costs."""

from collections.abc import Mapping

import xarray as xr

from sphframe.studies import Chapter, Reference, Section
from sphframe_huang2019.cost import pictures, tables
from sphframe_huang2019.cost.claims import claims
from sphframe_huang2019.cost.medians import Medians, disturbance, growth, medians
from sphframe_huang2019.cost.states import CASES, FIRST, VARIANTS, ratio_label, ratios, spacing_label, spacings, tasks

__all__ = ["SECTION"]


def _chapter(runs: Mapping[str, xr.Dataset], reference: Reference, quick: bool) -> Chapter:
    by_ratio = {ratio: medians(runs[ratio_label(ratio)]) for ratio in ratios(quick)}
    by_spacing = {spacing: medians(runs[spacing_label(spacing)]) for spacing in spacings(quick)}
    finest = by_spacing[spacings(quick)[-1]]
    figures = {"Fig. 4": finest} | {figure: medians(runs[label]) for figure, label in CASES.items()}
    exponents = {v.label: growth(by_ratio, v.label) for v in VARIANTS}
    return Chapter(
        "cost",
        "Cost",
        _paragraphs(runs[ratio_label(1.3)], by_ratio[1.3][FIRST].neighbours, figures),
        [
            tables.interpolation(by_ratio[1.3], exponents),
            tables.whole_steps(figures),
            tables.particles(by_spacing, runs),
            tables.neighbours(by_ratio),
        ],
        [pictures.scaling(by_ratio, by_spacing), pictures.speed_ups(figures)],
        claims(figures, exponents, disturbance(runs.values(), [*by_ratio.values(), *figures.values()])),
    )


def _paragraphs(sample: xr.Dataset, neighbours: float, figures: Mapping[str, Mapping[str, Medians]]) -> list[str]:
    shares = [one.share for found in figures.values() for one in found.values()]
    machine = {str(k).removeprefix("machine: "): v for k, v in sample.attrs.items() if str(k).startswith("machine: ")}
    return [
        f"Measured on {', '.join(f'{name} {value}' for name, value in machine.items())}, one thread. All methods start"
        " from the same state of a case and take turns; compilation and the first steps are not timed; medians of"
        f" {sample.sizes['repeat']} repeats are given. A point is a ghost that has fluid within its cut-off radius; a"
        f" point has {neighbours:.0f} neighbours at a smoothing length of 1.3 spacings. Filling the ghosts is the"
        " interpolation of pressure, density and velocity together, with the distances to the neighbours; a step of the"
        " symplectic integrator fills them twice.",
        "The paper's speed-ups are ratios of whole steps of its own program, in which MLS takes most of a step. Here"
        " the loops of the methods are compiled and the kernel is a polynomial: filling the ghosts takes"
        f" {min(shares):.0f} to {max(shares):.0f} % of a step in the cases below, more in smaller cases. The time of"
        " the interpolation alone shows the cost of the formulas. A weighted sum is linear in the neighbours for every"
        " method, MLS and SFDI included: their matrices have a fixed size, and are added up in one pass.",
    ]


SECTION = Section("cost", tasks, _chapter)
