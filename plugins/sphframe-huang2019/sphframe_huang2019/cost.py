"""What the methods cost: Table 1 and the speed-ups of Figs. 4, 9 and 12 of the paper."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from sphframe.studies import (
    Cell,
    Chapter,
    Claim,
    CostTask,
    Picture,
    Reference,
    Section,
    Table,
    Task,
    colour,
    new_figure,
    picture,
    run_task,
    tidy,
)
from sphframe_huang2019.variants import PAPER, Variant

__all__ = ["SECTION"]

VARIANTS = (
    *PAPER,
    Variant("sfdi", "mirror"),
    Variant("shepard", "mirror"),
    Variant("improved-shepard", "balanced"),
    Variant("mdbc", "balanced"),
    Variant("adami", "balanced"),
)
FIRST = PAPER[0].label
RATIOS = (1.0, 1.3, 1.6, 2.0, 2.5, 3.0)
"""smoothing length over spacing: sets the number of neighbours"""
SPACINGS = (0.02, 0.01, 0.005, 0.0025)
"""m, of the tank: sets the number of particles"""
SPEED_UPS: Mapping[str, Mapping[str, float]] = {
    "Fig. 4": {"normalized": 1.5, "sfdi": 2.0},
    "Fig. 9": {"normalized": 1.4, "sfdi": 1.9, "mls-linear": 4.2, "mls-quadratic": 11.6},
    "Fig. 12": {"sfdi": 2.0, "mls-linear": 3.7, "mls-quadratic": 9.6},
}
"""how much faster a step is with improved Shepard, as the paper says"""
GROWTH = {"mls-linear": 2, "mls-quadratic": 2, "sfdi": 2, "normalized": 1, "improved-shepard": 1}
"""power of the number of neighbours by which the work grows, Table 1 of the paper"""
SPREAD = 0.2
"""quartiles apart over the median, from which on a measurement decides nothing"""
QUICK_RATIOS, QUICK_SPACINGS = (1.3, 2.0), (0.03, 0.015)


def _ratio_label(ratio: float) -> str:
    return f"cost neighbours {ratio:g}"


def _spacing_label(spacing: float) -> str:
    return f"cost particles {1e3 * spacing:g} mm"


_CASES = {"Fig. 9": "cost dam-break", "Fig. 12": "cost fixed-wall"}


def _tasks(quick: bool) -> list[Task]:
    ratios, spacings = (QUICK_RATIOS, QUICK_SPACINGS) if quick else (RATIOS, SPACINGS)
    tank = 0.03 if quick else 0.01
    dam: dict[str, Any] = {"particle_spacing": 0.03, "time_step": None} if quick else {"particle_spacing": 0.006}
    flume: dict[str, Any] = {"particle_spacing": 0.025, "tank_length": 3.0, "time_step": None} if quick else {}
    repeats = 9 if quick else 25
    return [
        *(
            _task(
                _ratio_label(r), "hydrostatic-tank", repeats, 0.01,
                particle_spacing=tank, smoothing_length_ratio=r, time_step=None,
            )
            for r in ratios
        ),
        *(
            _task(_spacing_label(dx), "hydrostatic-tank", repeats, 0.0, particle_spacing=dx, time_step=None)
            for dx in spacings
        ),
        _task(_CASES["Fig. 9"], "dam-break", repeats, 0.8, **dam),
        _task(_CASES["Fig. 12"], "solitary-wave-fixed-wall", repeats, 0.0, **flume),
    ]  # fmt: skip


def _task(label: str, case: str, repeats: int, after: float, **parameters: Any) -> CostTask:
    run = run_task(label, case, "paper", **parameters)
    return CostTask(
        label,
        run.case_name,
        run.parameters,
        methods={v.label: (v.interpolator, v.lift) for v in VARIANTS},
        after=after,
        repeats=repeats,
    )


def _medians(measured: xr.Dataset) -> dict[str, dict[str, float]]:
    """Medians by method: fill and step in s, and both over those of improved Shepard in the same repeat."""
    found = {}
    for method in measured["interpolator"].values:
        own, first = measured.sel(interpolator=method), measured.sel(interpolator=FIRST)
        found[str(method)] = {
            "fill": float(own["fill"].median()),
            "step": float(own["step"].median()),
            "fill ratio": float((own["fill"] / first["fill"]).median()),
            "step ratio": float((own["step"] / first["step"]).median()),
            "fill spread": float((own["fill"].quantile(0.75) - own["fill"].quantile(0.25)) / own["fill"].median()),
            "spread": float((own["step"].quantile(0.75) - own["step"].quantile(0.25)) / own["step"].median()),
            "points": float(own["points"]),
            "neighbours": float(own["neighbours"]),
        }
    return found


def _growth(by_ratio: Mapping[float, Mapping[str, Mapping[str, float]]], method: str) -> float:
    """Exponent b of time a point ~ neighbours^b, least squares over the ratios."""
    n = [found[method]["neighbours"] for found in by_ratio.values()]
    t = [found[method]["fill"] / found[method]["points"] for found in by_ratio.values()]
    return float(np.polyfit(np.log(n), np.log(t), 1)[0]) if len(n) > 1 else math.nan


def _chapter(runs: Mapping[str, xr.Dataset], reference: Reference, quick: bool) -> Chapter:
    ratios, spacings = (QUICK_RATIOS, QUICK_SPACINGS) if quick else (RATIOS, SPACINGS)
    by_ratio = {r: _medians(runs[_ratio_label(r)]) for r in ratios}
    by_spacing = {dx: _medians(runs[_spacing_label(dx)]) for dx in spacings}
    figures = {"Fig. 4": by_spacing[spacings[-1]]} | {f: _medians(runs[label]) for f, label in _CASES.items()}
    usual = by_ratio[1.3]
    growth = {v.label: _growth(by_ratio, v.label) for v in VARIANTS}
    alone: list[dict[str, Cell]] = [
        {
            "boundary": v.label,
            "us a point": 1e6 * usual[v.label]["fill"] / usual[v.label]["points"],
            "ns a neighbour": 1e9 * usual[v.label]["fill"] / (usual[v.label]["points"] * usual[v.label]["neighbours"]),
            "over improved Shepard": usual[v.label]["fill ratio"],
            "part of a step (%)": 100.0 * 2.0 * usual[v.label]["fill"] / usual[v.label]["step"],
            "grows with neighbours to the power": growth[v.label],
            "paper's Table 1": {1: "linear", 2: "quadratic"}[GROWTH[v.method]] if v.published else None,
        }
        for v in VARIANTS
    ]
    shares = [200.0 * found["fill"] / found["step"] for case in figures.values() for found in case.values()]
    least, most = min(shares), max(shares)
    sample = runs[_ratio_label(1.3)]
    on = {str(k).removeprefix("machine: "): v for k, v in sample.attrs.items() if str(k).startswith("machine: ")}
    return Chapter(
        "cost",
        "Cost",
        [
            "Measured on " + ", ".join(f"{name} {value}" for name, value in on.items()) + ", one thread. All methods"
            " start from the same state of a case and take turns; compilation and the first steps are not timed;"
            f" medians of {sample.sizes['repeat']} repeats are given. A point is a ghost that has fluid within its"
            f" reach; a point has {usual[FIRST]['neighbours']:.0f} neighbours at a smoothing length of 1.3 spacings."
            " Filling the ghosts is the interpolation of pressure, density and velocity together, with the distances to"
            " the neighbours; a step of the symplectic integrator fills them twice.",
            "The paper's speed-ups are ratios of whole steps of its own program, in which MLS takes most of a step."
            " Here the methods' loops are compiled and the kernel is a polynomial: filling the ghosts"
            f" takes {least:.0f} to {most:.0f} % of a step in the cases below, the more the smaller the case, and the"
            " interpolation alone shows what the formulas cost. A weighted sum is linear in the neighbours for every"
            " method, MLS and SFDI included: their matrices have a fixed size, and are added up in one pass.",
        ],
        [
            Table("cost_interpolation", "Interpolation alone, still water, smoothing length 1.3 spacings", alone),
            _speed_ups(figures),
            _sizes(by_spacing, runs),
            _neighbour_table(by_ratio),
        ],
        [_scaling(by_ratio, by_spacing), _bars(figures)],
        _claims(figures, growth, _disturbance(runs, [*by_ratio.values(), *figures.values()])),
    )


def _disturbance(runs: Mapping[str, xr.Dataset], measured: Sequence[Mapping[str, Mapping[str, float]]]) -> str | None:
    """Why the measured times decide nothing, if the machine had other work."""
    busy = max(float(run.attrs["busy"]) for run in runs.values())
    spread = max(float(np.median([one["fill spread"] for one in found.values()])) for found in measured)
    if spread < SPREAD:
        return None
    return (
        f"The machine had other work: the wall's time was up to {busy:.2f} times the processor's, and quartiles lay up"
        f" to {100.0 * spread:.0f} % apart. Measure again on a quiet one: remove the runs whose names begin with cost."
    )


def _speed_ups(figures: Mapping[str, Mapping[str, Mapping[str, float]]]) -> Table:
    cases = {"Fig. 4": "still water", "Fig. 9": "dam break", "Fig. 12": "solitary wave"}
    rows: list[dict[str, Cell]] = [
        {
            "case": cases[figure],
            "boundary": v.label,
            "ms a step": 1e3 * found[v.label]["step"],
            "quartiles apart (%)": 100.0 * found[v.label]["spread"],
            "step, over improved Shepard": found[v.label]["step ratio"],
            "interpolation, over improved Shepard": found[v.label]["fill ratio"],
            "paper (step)": SPEED_UPS[figure].get(v.method) if v.published else None,
        }
        for figure, found in figures.items()
        for v in VARIANTS
    ]
    return Table("cost_speed_up", "Whole step: how many times longer than with improved Shepard", rows)


def _sizes(by_spacing: Mapping[float, Mapping[str, Mapping[str, float]]], runs: Mapping[str, xr.Dataset]) -> Table:
    rows: list[dict[str, Cell]] = []
    for v in VARIANTS:
        row: dict[str, Cell] = {"boundary": v.label}
        for dx, found in by_spacing.items():
            row[f"{runs[_spacing_label(dx)].attrs['particles']} particles"] = 1e3 * found[v.label]["step"]
        rows.append(row)
    return Table("cost_particles", "Fig. 4a anew: ms a step against the number of particles, still water", rows)


def _neighbour_table(by_ratio: Mapping[float, Mapping[str, Mapping[str, float]]]) -> Table:
    rows: list[dict[str, Cell]] = []
    for v in VARIANTS:
        row: dict[str, Cell] = {"boundary": v.label}
        for found in by_ratio.values():
            row[f"{found[FIRST]['neighbours']:.0f} neighbours"] = (
                1e6 * found[v.label]["fill"] / found[v.label]["points"]
            )
        rows.append(row)
    return Table("cost_neighbours", "Interpolation alone: us a point against the number of neighbours", rows)


def _scaling(
    by_ratio: Mapping[float, Mapping[str, Mapping[str, float]]],
    by_spacing: Mapping[float, Mapping[str, Mapping[str, float]]],
) -> Picture:
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
        points = [found[v.label] for found in by_ratio.values()]
        left.plot(
            [f["neighbours"] for f in points], [1e6 * f["fill"] / f["points"] for f in points], label=v.label, **style
        )
        right.plot([0.3 / dx**2 for dx in by_spacing], [1e3 * f[v.label]["step"] for f in by_spacing.values()],
                   **style)  # fmt: skip
    low = by_ratio[min(by_ratio)][FIRST]
    n = np.array([low["neighbours"], by_ratio[max(by_ratio)][FIRST]["neighbours"]])
    scale = 1e6 * low["fill"] / low["points"]
    left.plot(n, scale * n / n[0], color="black", linewidth=0.7, linestyle="--", label="linear")
    left.plot(n, scale * (n / n[0]) ** 2, color="black", linewidth=0.7, linestyle="-.", label="quadratic")
    tidy(left, xscale="log", yscale="log", xlabel="neighbours of a point", ylabel="interpolation, us a point")
    tidy(right, xscale="log", yscale="log", xlabel="particles", ylabel="whole step, ms")
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize=8)
    return picture("cost_scaling", "Cost against neighbours, and Fig. 4a anew: against particles.", figure)


def _bars(figures: Mapping[str, Mapping[str, Mapping[str, float]]]) -> Picture:
    figure = new_figure(10.0, 3.8)
    panels = figure.subplots(1, len(figures), sharey=True)
    shown = [v for v in PAPER if v.label != FIRST]
    place = np.arange(len(shown))
    for axes, (name, found) in zip(panels, figures.items(), strict=True):
        paper = [SPEED_UPS[name].get(v.method, math.nan) for v in shown]
        axes.bar(place - 0.27, paper, 0.25, color="#bbbbbb", label="paper, whole step")
        axes.bar(place, [found[v.label]["step ratio"] for v in shown], 0.25, color="#1f77b4", label="here, whole step")
        axes.bar(
            place + 0.27,
            [found[v.label]["fill ratio"] for v in shown],
            0.25,
            color="#ff7f0e",
            label="here, interpolation alone",
        )
        axes.axhline(1.0, color="black", linewidth=0.6)
        axes.set_xticks(place, [v.method for v in shown], rotation=20, fontsize=8)
        tidy(axes, title=f"{name} anew")
    panels[0].set_ylabel("times improved Shepard")
    panels[0].legend(fontsize=8, frameon=False, loc="upper left")
    return picture("cost_speed_up", "Speed-ups of improved Shepard beside the paper's (Figs. 4b, 9b and 12b).", figure)


def _claims(
    figures: Mapping[str, Mapping[str, Mapping[str, float]]], growth: Mapping[str, float], disturbed: str | None
) -> list[Claim]:
    claims = _judged(figures, growth)
    if disturbed is None:
        return claims
    return [Claim.open(c.where, c.statement, c.published, disturbed, c.measured) for c in claims]


def _judged(figures: Mapping[str, Mapping[str, Mapping[str, float]]], growth: Mapping[str, float]) -> list[Claim]:
    labels = {v.method: v.label for v in PAPER}
    claims = []
    for method, power in GROWTH.items():
        measured = growth[labels[method]]
        claims.append(
            Claim.judged(
                "Table 1",
                f"The work of {method} grows {'linearly' if power == 1 else 'with the square of'}"
                f" {'with ' if power == 1 else ''}the number of neighbours.",
                f"power {power}",
                f"power {measured:.2f}",
                abs(measured - power) < 0.35,
                "Exponent of the time of the interpolation alone; judged by 0.35."
                + (" One pass over the neighbours adds up a matrix of fixed size." if power == 2 else ""),
            )
        )
    for figure, ups in SPEED_UPS.items():
        for method, factor in ups.items():
            found = figures[figure][labels[method]]
            claims.append(
                Claim.judged(
                    figure,
                    f"A step is {factor:g} times faster with improved Shepard than with {method}.",
                    f"{factor:g}",
                    f"{found['step ratio']:.2f}, interpolation alone {found['fill ratio']:.2f}",
                    abs(found["step ratio"] / factor - 1.0) < 0.2,
                    "Judged by 20 % of the whole step's ratio."
                    + (
                        " A normalised average takes fewer operations a neighbour than improved Shepard's exponential"
                        " and powers, so that it cannot be the slower."
                        if method == "normalized"
                        else " Compiled, the interpolation is cheap with each method, and only a part of a step."
                    ),
                )
            )
    shepard, quadratic = (figures["Fig. 9"][labels[m]] for m in ("improved-shepard", "mls-quadratic"))
    claims.append(
        Claim.judged(
            "Conclusions",
            "Improved Shepard is much cheaper than MLS and SFDI.",
            "seen in the figures",
            "interpolation alone over improved Shepard: "
            + ", ".join(f"{m} {figures['Fig. 9'][labels[m]]['fill ratio']:.2f}" for m in labels),
            min(figures["Fig. 9"][labels[m]]["fill ratio"] for m in ("sfdi", "mls-linear", "mls-quadratic")) > 1.2,
            f"Judged by 20 % of the interpolation alone; of a whole step, {1e3 * shepard['step']:.2f} ms, MLS quadratic"
            f" adds {100.0 * (quadratic['step ratio'] - 1.0):.0f} %.",
        )
    )
    return claims


SECTION = Section("cost", _tasks, _chapter)
