"""The chapter of the dam break."""

import math
from collections.abc import Mapping

import xarray as xr

from sphframe.analysis import summary
from sphframe.studies import Cell, Chapter, Reference, Section, Table, ended, fallback_share
from sphframe_huang2019.dam_break.claims import claims
from sphframe_huang2019.dam_break.far_wall import roughness
from sphframe_huang2019.dam_break.pictures import corner_pressures, sensor_pressures, snapshots, wall_profiles
from sphframe_huang2019.dam_break.runs import VARIANTS, label, tasks
from sphframe_huang2019.dam_break.sensor import goal, measured_series, sensor_tables
from sphframe_huang2019.dam_break.surge import surge_front
from sphframe_huang2019.variants import OURS, PAPER, Variant

__all__ = ["SECTION"]

ROUGHNESS = "pressure roughness in the corner (rho g H)"


def _chapter(runs: Mapping[str, xr.Dataset], reference: Reference, quick: bool) -> Chapter:
    experiments = measured_series(reference)
    tables = sensor_tables(runs, reference, experiments)
    rows = {v: _run_row(runs[label(v)], v) for v in VARIANTS}
    surge_table, surge_picture = surge_front(runs, reference)
    shepard = runs[label(PAPER[0])]
    roughness_of = {v.method: float(rows[v][ROUGHNESS]) for v in PAPER}  # type: ignore[arg-type]
    return Chapter(
        "dam-break",
        "Dam break",
        [_setting(shepard), _SENSOR, goal(runs, experiments)],
        [*tables, Table("dam_break_runs", "The runs: front, energy, fallback", list(rows.values())), surge_table],
        [
            snapshots(shepard),
            sensor_pressures(runs, PAPER, experiments, "dam_break_paper", "As Fig. 7: the paper's methods"),
            sensor_pressures(runs, OURS, experiments, "dam_break_ours", "The same with the boundaries of this project"),
            wall_profiles(runs, experiments),
            corner_pressures(runs),
            surge_picture,
        ],
        claims(runs, experiments, roughness_of),
    )


def _setting(dataset: xr.Dataset) -> str:
    spacing = 1e3 * float(dataset.attrs["particle_spacing"])
    return (
        f"H = 0.6 m, L = 2 H, tank 5.366 H, particle spacing {spacing:g} mm ({dataset.sizes['particle']} particles)."
        " Pressures are running means over 0.1 sqrt(H/g); those of the experiment are as digitised. All series are read"
        " by the same rules: arrival, the first value above 0.1; first peak, the largest in 2.4 to 3.2; plateau, mean"
        " over 3.2 to 4.8; second peak, the largest in 5 to 7; RMS difference, over the time from 2.4 to 6, with"
        " straight lines between the digitised points. RMS differences at the digitised points alone, which are closer"
        " together where the pressure changes, are given as well; most of them are larger."
    )


_SENSOR = (
    "The experiment's sensor is a disc of 90 mm centred 160 mm above the bed (0.267 H). Published simulations sample at"
    " 0.19 H: the top of their disc is where the centre of the sensor was (Adami et al. 2012,"
    " doi:10.1016/j.jcp.2012.05.005, after M. Greco, who found that this shift agrees better and names uncertainties of"
    " the measurement). The pressure falls steeply with height there, so that the plateau depends on the place: both"
    " places are given, and published RMS differences are to be compared with those at the shifted place."
)


def _run_row(dataset: xr.Dataset, variant: Variant) -> dict[str, Cell]:
    known = summary(dataset)
    arrival = known["front_arrival"]
    return {
        "boundary": variant.label,
        "of": "the paper" if variant.published else "ours",
        "front at the wall": arrival["dimensionless"] if arrival else math.nan,
        "energy above its start (%)": 100.0 * known["energy_excess"],
        "behind walls": known["particles_outside"],
        "fallback (% of wet ghosts)": fallback_share(dataset),
        ROUGHNESS: roughness(dataset),
        "to the end": ended(dataset),
    }


SECTION = Section("dam-break", tasks, _chapter)
