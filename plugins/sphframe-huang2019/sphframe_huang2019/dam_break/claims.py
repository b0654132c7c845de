"""Claims of the paper on the dam break."""

import math
from collections.abc import Mapping, Sequence

import xarray as xr

from sphframe.analysis import summary
from sphframe.studies import Claim
from sphframe_huang2019.dam_break.runs import label
from sphframe_huang2019.dam_break.sensor import EXPERIMENTS, events, sensor_pressure
from sphframe_huang2019.variants import PAPER

__all__ = ["claims"]


def claims(
    runs: Mapping[str, xr.Dataset], experiments: Mapping[str, xr.DataArray], roughness: Mapping[str, float]
) -> list[Claim]:
    """Judge the claims on Figs. 6 to 8; ``roughness`` is that of each of the paper's methods."""
    datasets = {v.method: runs[label(v)] for v in PAPER}
    found = {name: events(sensor_pressure(dataset, "P1")) for name, dataset in datasets.items()}
    completed = [name for name, dataset in datasets.items() if dataset.attrs["completed"] == "yes"]
    return [
        *_on_the_flow(datasets["improved-shepard"], found["improved-shepard"]),
        *_on_the_pressures({name: e["plateau"] for name, e in found.items()}, completed),
        _on_the_corner(roughness),
        _on_the_arrival({name: e["arrival"] for name, e in found.items()}, experiments),
    ]


def _on_the_flow(shepard: xr.Dataset, found: Mapping[str, float]) -> list[Claim]:
    front = summary(shepard)["front_arrival"]
    arrival = front["dimensionless"] if front else math.nan
    return [
        Claim.judged(
            "Fig. 6",
            "The front touches the right wall at about t sqrt(g/H) = 2.43.",
            "2.43",
            f"{arrival:.2f}",
            abs(arrival - 2.43) < 0.05,
            "Front of the water connected to the column, improved Shepard, mirror lift; judged by 0.05.",
        ),
        Claim.judged(
            "Fig. 6",
            "The plunging wave closes a hole at about t sqrt(g/H) = 5.98.",
            "5.98",
            f"second peak at {found['second peak at']:.2f}",
            abs(found["second peak at"] - 5.98) < 0.3,
            "The second pressure peak at the sensor is taken as the time of the closing; judged by 0.3.",
        ),
    ]


def _on_the_pressures(plateau: Mapping[str, float], completed: Sequence[str]) -> list[Claim]:
    similar = [plateau[name] for name in ("improved-shepard", "mls-linear", "mls-quadratic", "sfdi")]
    spread = max(similar) - min(similar) if all(map(math.isfinite, similar)) else math.nan
    return [
        Claim.judged(
            "Fig. 7",
            "All methods record the pressure through climb and closing.",
            "5 of 5 methods",
            f"{len(completed)} of 5: {', '.join(completed)}",
            len(completed) == 5,
            "A run counts if it comes to t sqrt(g/H) = 7.",
        ),
        Claim.judged(
            "Fig. 7",
            "MLS, SFDI and improved Shepard give similar pressures.",
            "seen in the figure",
            "plateau " + ", ".join(f"{name} {plateau[name]:.3f}" for name in plateau if name != "normalized"),
            spread < 0.1,
            "Judged by plateaus that differ by less than 0.1 rho g H; a run that failed has none.",
        ),
        Claim.judged(
            "Fig. 7",
            "The normalised method gives significantly larger values than the others.",
            "seen in the figure",
            f"plateau {plateau['normalized']:.3f}, improved Shepard {plateau['improved-shepard']:.3f}",
            plateau["normalized"] > plateau["improved-shepard"] + 0.1,
            "Judged by 0.1 rho g H.",
        ),
    ]


def _on_the_corner(roughness: Mapping[str, float]) -> Claim:
    normalized, shepard, quadratic = (roughness[m] for m in ("normalized", "improved-shepard", "mls-quadratic"))
    return Claim.judged(
        "Fig. 8",
        "The pressure near the corner is smoother with improved Shepard and MLS than with the normalised method.",
        "seen in the figure",
        f"normalized {normalized:.4f}, improved-shepard {shepard:.4f}, mls-quadratic {quadratic:.4f}",
        shepard < 0.8 * normalized and quadratic < 0.8 * normalized,
        "Roughness: RMS difference of particles from a plane through their neighbours, over rho g H, plateau;"
        " judged by 20 %. A run that failed before has none.",
    )


def _on_the_arrival(computed: Mapping[str, float], experiments: Mapping[str, xr.DataArray]) -> Claim:
    statement = "All computed fronts reach the sensor later than the experiment's."
    if not experiments:
        return Claim.open("Fig. 7", statement, "seen in the figure", "No reference series was given.")
    measured = {EXPERIMENTS[name]: events(series)["arrival"] for name, series in experiments.items()}
    return Claim.judged(
        "Fig. 7",
        statement,
        "seen in the figure",
        ", ".join(f"{name} {value:.2f}" for name, value in {**measured, **computed}.items()),
        min(computed.values()) > max(measured.values()),
        "Arrival of 0.1 rho g H at the sensor as it was in the experiment. The paper's reason, a gate that opens"
        " slowly, would delay the experiment and not the simulation.",
    )
