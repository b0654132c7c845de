"""Still water in a tank, section 4.1 of the paper, Figs. 3 and 4."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from sphframe.analysis import pressure_scale, rest_pressure
from sphframe.studies import Cell, Chapter, Claim, Picture, Reference, Section, Table, Task, new_figure, picture, tidy
from sphframe_huang2019.histories import draw_history
from sphframe_huang2019.variants import OURS, PAPER, Variant, row_of_run, run_with

__all__ = ["SECTION"]

VARIANTS = (*PAPER, *OURS)


def _label(variant: Variant) -> str:
    return f"hydrostatic-tank {variant.label}"


def _tasks(quick: bool) -> list[Task]:
    own: dict[str, Any] = {"time_step": None}
    if quick:
        own |= {"particle_spacing": 0.03, "until": 2.0, "probe_interval": 0.005}
    return [run_with(v, _label(v), "hydrostatic-tank", **own) for v in VARIANTS]


def _key_figures(dataset: xr.Dataset) -> dict[str, Any]:
    """Return mean errors and standard deviations of the probes' pressures from the state of rest, % of rho g H."""
    t = dataset["probe_time"].values
    rest = rest_pressure(dataset, dataset["probe_y"].values)
    deviation = 100.0 * (dataset["probe_pressure"].values - rest) / pressure_scale(dataset)
    start, late = t <= min(1.0, 0.25 * t[-1]), t >= 0.5 * t[-1]
    end = t >= t[-1] - min(5.0, 0.25 * t[-1])
    mean, noise = deviation[late].mean(axis=0), deviation[late].std(axis=0)
    return {
        "mean": mean,
        "corner": float(abs(mean[0])),
        "wall": float(np.abs(mean[1:]).max()),
        "noise": float(noise.max()),
        "at the end": float(deviation[end].std(axis=0).max()),
        "at the start": float(deviation[start].std(axis=0).max()),
    }


def _chapter(runs: Mapping[str, xr.Dataset], reference: Reference, quick: bool) -> Chapter:
    found = {v: _key_figures(runs[_label(v)]) for v in VARIANTS}
    rows = [
        row_of_run(
            v,
            runs[_label(v)],
            {
                "mean error, corner P0 (%)": f["corner"],
                "mean error, P1-P3 (%)": f["wall"],
                "deviation (%)": f["noise"],
                "deviation, last seconds (%)": f["at the end"],
                "deviation, first second (%)": f["at the start"],
            },
            published=v.published,
        )
        for v, f in found.items()
    ]
    first = runs[_label(VARIANTS[0])]
    scale = pressure_scale(first)
    rest = {f"P{k} (Pa)": float(p) for k, p in enumerate(rest_pressure(first, first["probe_y"].values))}
    probes: list[dict[str, Cell]] = [{"boundary": "at rest (exact)", **rest}]
    for v, f in found.items():
        means = zip(rest.items(), f["mean"], strict=True)
        probes.append({"boundary": v.label} | {name: p + scale * float(mean) / 100.0 for (name, p), mean in means})
    spacing, until = 1e3 * float(first.attrs["particle_spacing"]), float(first["probe_time"][-1])
    return Chapter(
        "hydrostatic-tank",
        "Hydrostatic tank",
        [
            f"Water 1 m long and 0.3 m deep at rest, particle spacing {spacing:g} mm, {until:.3g} s; pressures at four"
            " probes on the left wall, P0 in the corner. Errors and standard deviations are in per cent of rho g H,"
            " over the second half of the run unless another time is given, and the largest of the probes. Time steps"
            " are adaptive, with a Courant number of 0.7: about 0.26 ms at the paper's spacing, where the paper has"
            " 0.1 ms.",
            "Goal of this project for improved Shepard with the balanced lift: mean error below 0.4 %, 0.8 % in the"
            " corner, deviation below 0.25 % to the end." + _goal(found[Variant("improved-shepard", "balanced")]),
        ],
        [
            Table("hydrostatic_tank", "Still water: errors of the wall pressure", rows),
            Table("hydrostatic_tank_probes", "Mean pressure at the probes, second half of the run", probes),
        ],
        [
            _histories(runs, PAPER, "hydrostatic_paper", "As Fig. 3: pressure at P0 to P3, the paper's methods"),
            _histories(runs, OURS, "hydrostatic_ours", "The same with the boundaries of this project"),
        ],
        _claims({v.method: f for v, f in found.items() if v.published}),
    )


def _goal(figures: Mapping[str, Any]) -> str:
    """Say whether the goal of this project is met."""
    met = figures["wall"] < 0.4 and figures["corner"] < 0.8 and max(figures["noise"], figures["at the end"]) < 0.25
    return (
        f" Measured: {figures['wall']:.2f} %, {figures['corner']:.2f} %, {figures['noise']:.2f} %, in the last seconds"
        f" {figures['at the end']:.2f} %: {'met' if met else 'missed'}."
    )


def _claims(paper: Mapping[str, Mapping[str, Any]]) -> list[Claim]:
    shepard, others = paper["improved-shepard"], ("mls-linear", "mls-quadratic")
    apart = float(np.abs(shepard["mean"] - paper["mls-quadratic"]["mean"]).max())
    return [
        Claim.judged(
            "Fig. 3",
            "With the normalised method the pressure always fluctuates slightly.",
            "more than the others, seen in the figure",
            f"deviation {paper['normalized']['noise']:.2f} %, improved Shepard {shepard['noise']:.2f} %",
            paper["normalized"]["noise"] > 2.0 * shepard["noise"],
            "Judged by twice the deviation of improved Shepard.",
        ),
        Claim.judged(
            "Fig. 3",
            "With the normalised method the pressure oscillates obviously at the start.",
            "seen in the figure",
            f"deviation in the first second {paper['normalized']['at the start']:.2f} %, improved Shepard"
            f" {shepard['at the start']:.2f} %",
            paper["normalized"]["at the start"] > 2.0 * shepard["at the start"],
            "Judged by twice that of improved Shepard. The runs start from the state of rest of the compressible fluid;"
            " the paper does not say how its runs start.",
        ),
        Claim.judged(
            "Fig. 3",
            "With SFDI the pressure oscillates significantly at the start.",
            "seen in the figure",
            f"deviation in the first second {paper['sfdi']['at the start']:.2f} %, improved Shepard"
            f" {shepard['at the start']:.2f} %",
            paper["sfdi"]["at the start"] > 2.0 * shepard["at the start"],
            "Judged by twice that of improved Shepard, with SFDI as printed.",
        ),
        Claim.judged(
            "Fig. 3",
            "The MLS methods and improved Shepard are relatively stable.",
            "seen in the figure",
            ", ".join(f"{name} {paper[name]['noise']:.2f} %" for name in ("improved-shepard", *others)),
            all(paper[name]["noise"] < 1.0 for name in ("improved-shepard", *others)),
            "Judged by deviations below 1 % of rho g H.",
        ),
        Claim.judged(
            "Fig. 3",
            "The values of improved Shepard are basically those of MLS quadratic.",
            "seen in the figure",
            f"means differ by at most {apart:.2f} % of rho g H",
            apart < 1.0,
            "Judged by 1 % of rho g H at every probe.",
        ),
    ]


def _histories(runs: Mapping[str, xr.Dataset], variants: Sequence[Variant], name: str, caption: str) -> Picture:
    figure = new_figure(10.0, 6.4)
    for k, axes in enumerate(figure.subplots(2, 2, sharex=True).flat):
        for variant in variants:
            dataset = runs[_label(variant)]
            pressure = dataset["probe_pressure"][:, k]
            draw_history(axes, variant, dataset["probe_time"], pressure, points=400, linewidth=0.7)
        rest = rest_pressure(dataset, dataset["probe_y"].values[k])
        scale = pressure_scale(dataset)
        axes.axhline(float(rest), color="black", linewidth=0.8, linestyle="--", label="at rest")
        axes.set_ylim(float(rest) - 0.1 * scale, float(rest) + 0.1 * scale)
        tidy(axes, title=f"P{k}", ylabel="p (Pa)")
    for axes in figure.axes[2:]:
        axes.set_xlabel("t (s)")
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize=8)
    return picture(name, f"{caption}. The axes reach 10 % of rho g H above and below the pressure at rest.", figure)


SECTION = Section("hydrostatic-tank", _tasks, _chapter)
