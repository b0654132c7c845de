"""The solitary wave on the fixed, leaning wall, section 4.3 of the paper, Figs. 10 and 11."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from sphframe.analysis import plot_run, running_mean
from sphframe.studies import (
    Chapter,
    Claim,
    Picture,
    Reference,
    Section,
    Table,
    Task,
    fallback_share,
    new_figure,
    picture,
    tidy,
)
from sphframe_huang2019.histories import draw_history
from sphframe_huang2019.variants import OURS, PAPER, Variant, row_of_run, run_with

__all__ = ["SECTION"]

SHOWN = tuple(v for v in PAPER if v.method != "normalized")
"""the four methods that the paper shows for this case"""
VARIANTS = (*SHOWN, next(v for v in PAPER if v.method == "normalized"), *OURS)
WINDOW = 0.05
"""width of the running mean from which the noise of a pressure is measured, s"""


def _label(variant: Variant) -> str:
    return f"fixed-wall {variant.label}"


def _tasks(quick: bool) -> list[Task]:
    own: dict[str, Any] = {"time_step": None}
    if quick:
        own |= {"tank_length": 3.0, "particle_spacing": 0.025}
    return [run_with(v, _label(v), "solitary-wave-fixed-wall", **own) for v in VARIANTS]


def _key_figures(dataset: xr.Dataset) -> dict[str, Any]:
    """Return pressures at P0 and P1 in still water and at their peaks, their noise, Pa; times, s; the run-up, m."""
    t = dataset["probe_time"].values
    p = dataset["probe_pressure"].values
    smooth = [running_mean(t, p[:, k], WINDOW, 0.005) for k in range(2)]
    noise = [float(np.std(p[:, k] - np.interp(t, smooth[k]["t"], smooth[k]))) for k in range(2)]
    arrival = _arrival(dataset)
    quiet = (t > 0.05) & (t < arrival - 8.0 * _time_per_depth(dataset)) if math.isfinite(arrival) else t < 0.0
    return {
        "still": [float(p[quiet, k].mean()) if quiet.any() else math.nan for k in range(2)],
        "peak": [float(s.max()) if s.size else math.nan for s in smooth],
        "noise": noise,
        "smooth": smooth,
        "arrival": arrival,
        "run-up": float(dataset["run_up"].max()),
        "fallback": fallback_share(dataset),
    }


def _time_per_depth(dataset: xr.Dataset) -> float:
    """Return d / sqrt(g (d + A)), the time in which the wave travels one depth, s."""
    depth = float(dataset.attrs["depth"])
    return depth / math.sqrt(float(dataset.attrs["gravity"]) * 1.6 * depth)


def _arrival(dataset: xr.Dataset) -> float:
    """Return when the crest would be at the toe, s, extrapolated from when it passes the gauges in the far half."""
    t, x = dataset["probe_time"].values, dataset["gauge_x"].values
    toe = float(x.max()) / 0.9
    heights = dataset["gauge_elevation"].values
    places, times = [], []
    for k in np.flatnonzero((x > 0.35 * toe) & (x < 0.85 * toe)):
        wet = np.isfinite(heights[:, k])
        if wet.sum() > 3:
            places.append(x[k])
            times.append(t[wet][int(np.argmax(heights[wet, k]))])
    if len(places) < 2:
        return math.nan
    pace, start = np.polyfit(places, times, 1)
    return float(start + pace * toe)


def _chapter(runs: Mapping[str, xr.Dataset], reference: Reference, quick: bool) -> Chapter:
    found = {v: _key_figures(runs[_label(v)]) for v in VARIANTS}
    first = runs[_label(VARIANTS[0])]
    other = found[VARIANTS[2]]["smooth"]
    rows = [
        row_of_run(
            v,
            runs[_label(v)],
            {
                "still, P0 (Pa)": f["still"][0],
                "still, P1 (Pa)": f["still"][1],
                "peak, P0 (Pa)": f["peak"][0],
                "peak, P1 (Pa)": f["peak"][1],
                "noise, P0 (Pa)": f["noise"][0],
                "noise, P1 (Pa)": f["noise"][1],
                "RMS to mls-quadratic, P0 (Pa)": _rms_difference(f["smooth"][0], other[0]),
                "crest at the toe (s)": f["arrival"],
                "run-up (m)": f["run-up"],
            },
            published=v in SHOWN,
        )
        for v, f in found.items()
    ]
    toe = float(first["gauge_x"].max()) / 0.9
    spacing = 1e3 * float(first.attrs["particle_spacing"])
    return Chapter(
        "fixed-wall",
        "Solitary wave on the fixed wall",
        [
            f"Flume of {toe:g} m, depth 0.25 m, wave 0.15 m high, wall leaning outward at 120 degrees, particle spacing"
            f" {spacing:g} mm ({first.sizes['particle']} particles). P0 is 0.05 m and P1 0.15 m above the bed; still"
            " water has 1962 and 981 Pa there. Noise is the standard deviation from a running mean over 0.05 s; peaks"
            " and differences are those of the running means. The paper names no paddle: here a piston by Rayleigh's"
            " theory makes the wave, at whose speed the crest would be at 10 m after 5.95 s. Time steps are adaptive,"
            " with a Courant number of 0.7: about 0.27 ms at the paper's resolution, where the paper has 0.1 ms.",
            "The measured pressures that the paper shows (Zheng 2015) could not be obtained: the methods are compared"
            " with each other and with still water.",
        ],
        [Table("fixed_wall", "Pressure on the leaning wall", rows)],
        [
            _histories(runs, SHOWN, "fixed_wall_paper", "As Fig. 11: pressure at P0 and P1, the paper's methods"),
            _histories(runs, VARIANTS[len(SHOWN) :], "fixed_wall_ours", "The same with the other boundaries"),
            picture(
                "fixed_wall_snapshots",
                "The wave in the flume, improved Shepard with the mirror lift.",
                plot_run(first),
                raster=True,
            ),
        ],
        _claims({v.method: f for v, f in found.items() if v in SHOWN}),
    )


def _rms_difference(one: xr.DataArray, other: xr.DataArray) -> float:
    """Return the RMS difference of two series with the same steps; NaN if one ended early."""
    count = min(one.size, other.size)
    if not count or abs(one.size - other.size) > 3:
        return math.nan
    return float(np.sqrt(np.mean((one.values[:count] - other.values[:count]) ** 2)))


def _histories(runs: Mapping[str, xr.Dataset], variants: Sequence[Variant], name: str, caption: str) -> Picture:
    figure = new_figure(10.0, 6.4)
    start = max(0.0, float(runs[_label(VARIANTS[0])]["probe_time"][-1]) - 2.2)
    for k, axes in enumerate(figure.subplots(2, 1, sharex=True)):
        for variant in variants:
            dataset = runs[_label(variant)]
            mirror = variant.lift == "mirror" and variant not in SHOWN
            pressure = dataset["probe_pressure"][:, k] / 1000.0
            line = ":" if mirror else "-"
            draw_history(axes, variant, dataset["probe_time"], pressure, linewidth=0.8, linestyle=line)
        tidy(axes, ylabel=f"P{k} (kPa)", ylim=(0.0, 5.0), xlim=(start, start + 2.2))
    figure.axes[1].set_xlabel("t (s)")
    figure.axes[0].legend(fontsize=8, frameon=False, ncols=2, loc="upper left")
    return picture(name, f"{caption}.", figure)


def _claims(paper: Mapping[str, Mapping[str, Any]]) -> list[Claim]:
    shepard, sfdi = paper["improved-shepard"], paper["sfdi"]
    apart = [
        _rms_difference(shepard["smooth"][0], paper[name]["smooth"][0]) for name in ("mls-linear", "mls-quadratic")
    ]
    singular = {name: f["fallback"] for name, f in paper.items()}
    return [
        Claim.open(
            "Fig. 11",
            "Improved Shepard agrees well with the measured pressures at P0 and P1.",
            "seen in the figure",
            "The measurement could not be obtained, and the paper does not say which paddle made the wave.",
            f"peaks {shepard['peak'][0]:.0f} and {shepard['peak'][1]:.0f} Pa",
        ),
        Claim.judged(
            "Fig. 11",
            "Improved Shepard and MLS differ little.",
            "seen in the figure",
            f"RMS difference at P0: {apart[0]:.0f} Pa to linear, {apart[1]:.0f} Pa to quadratic",
            max(apart) < 150.0,
            "Judged by 150 Pa, 5 % of the wave's pressure; a run that failed has no difference.",
        ),
        Claim.judged(
            "Fig. 11",
            "The pressure with SFDI is unstable.",
            "seen in the figure (Chen 2017)",
            f"noise at P0 {sfdi['noise'][0]:.0f} Pa, improved Shepard {shepard['noise'][0]:.0f} Pa",
            sfdi["noise"][0] > 2.0 * shepard["noise"][0],
            "Judged by twice the noise of improved Shepard.",
        ),
        Claim.judged(
            "Section 4.3",
            "MLS meets singular matrices where particles are few or irregular; improved Shepard never does.",
            "said in the text",
            "ghosts on the fallback: " + ", ".join(f"{name} {share:.2f} %" for name, share in singular.items()),
            singular["improved-shepard"] == 0.0 and singular["mls-quadratic"] > 0.0,
            "Counted in every sample of the runs.",
        ),
    ]


SECTION = Section("fixed-wall", _tasks, _chapter)
