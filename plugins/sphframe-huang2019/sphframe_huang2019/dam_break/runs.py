"""The runs of the dam break: the experiment of Buchner, and the column of Martin and Moyce."""

import math
from typing import Any

from sphframe.studies import Task
from sphframe_huang2019.variants import OURS, PAPER, Variant, run_with

__all__ = ["BEST", "COLUMN_BASE", "SQUARE_OF_N", "VARIANTS", "label", "surge_label", "tasks"]

VARIANTS = (*PAPER, *OURS)
BEST = Variant("improved-shepard", "balanced")
COLUMN_BASE = 0.05715
"""m: a, the base of Martin and Moyce's column, whose height is n^2 a with n^2 = 2"""
SQUARE_OF_N = 2.0


def label(variant: Variant) -> str:
    """Return the label of the task of the experiment with ``variant``."""
    return f"dam-break {variant.label}"


def surge_label(variant: Variant) -> str:
    """Return the label of the task of the column with ``variant``."""
    return f"surge {variant.label}"


def tasks(quick: bool) -> list[Task]:
    """Return the runs with each variant, and two of the column."""
    own: dict[str, Any] = {"frame_interval": 0.04}
    if quick:
        own = {"particle_spacing": 0.02, "time_step": None, "frame_interval": 0.04}
    a = COLUMN_BASE
    surge = {
        "water_height": SQUARE_OF_N * a,
        "water_length": a,
        "tank_length": 12.0 * a,
        "tank_height": 3.0 * a,
        "particle_spacing": a / (12.0 if quick else 40.0),
        "time_step": None,
        "until": 4.3 / math.sqrt(9.81 / a),
        "frame_interval": 0.05,
    }
    return [
        *(run_with(v, label(v), "dam-break", **own) for v in VARIANTS),
        *(run_with(v, surge_label(v), "dam-break", **surge) for v in (PAPER[0], BEST)),
    ]
