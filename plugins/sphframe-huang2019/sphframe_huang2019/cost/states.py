"""The states of the cases on which the methods are timed."""

from typing import Any

from sphframe.studies import CostTask, Task, run_task
from sphframe_huang2019.variants import PAPER, Variant

__all__ = ["CASES", "FIRST", "VARIANTS", "ratio_label", "ratios", "spacing_label", "spacings", "tasks"]

VARIANTS = (
    *PAPER,
    Variant("sfdi", "mirror"),
    Variant("shepard", "mirror"),
    Variant("improved-shepard", "balanced"),
    Variant("mdbc", "balanced"),
    Variant("adami", "balanced"),
)
FIRST = PAPER[0].label
"""improved Shepard, with which the others are compared"""
CASES = {"Fig. 9": "cost dam-break", "Fig. 12": "cost fixed-wall"}
"""labels of the tasks by the figure that shows the case; Fig. 4 is the tank at the finest spacing"""


def ratios(quick: bool) -> tuple[float, ...]:
    """Return smoothing lengths over the spacing, which determine the number of neighbours."""
    return (1.3, 2.0) if quick else (1.0, 1.3, 1.6, 2.0, 2.5, 3.0)


def spacings(quick: bool) -> tuple[float, ...]:
    """Return particle spacings of the tank, m, which determine the number of particles."""
    return (0.03, 0.015) if quick else (0.02, 0.01, 0.005, 0.0025)


def ratio_label(ratio: float) -> str:
    """Return the label of the task with that smoothing length over the spacing."""
    return f"cost neighbours {ratio:g}"


def spacing_label(spacing: float) -> str:
    """Return the label of the task with that spacing, m."""
    return f"cost particles {1e3 * spacing:g} mm"


def tasks(quick: bool) -> list[Task]:
    """Return one task for each state; each times all variants."""
    tank, repeats = (0.03, 9) if quick else (0.01, 25)
    dam: dict[str, Any] = {"particle_spacing": 0.03, "time_step": None} if quick else {"particle_spacing": 0.006}
    flume: dict[str, Any] = {"particle_spacing": 0.025, "tank_length": 3.0, "time_step": None} if quick else {}
    still = "hydrostatic-tank"
    own: dict[str, Any] = {"particle_spacing": tank, "time_step": None}
    return [
        *(_task(ratio_label(r), still, repeats, 0.01, **own, smoothing_length_ratio=r) for r in ratios(quick)),
        *(_task(spacing_label(s), still, repeats, 0.0, **{**own, "particle_spacing": s}) for s in spacings(quick)),
        _task(CASES["Fig. 9"], "dam-break", repeats, 0.8, **dam),
        _task(CASES["Fig. 12"], "solitary-wave-fixed-wall", repeats, 0.0, **flume),
    ]


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
