"""Costs according to the paper."""

from collections.abc import Mapping

__all__ = ["GROWTH", "SPEED_UPS"]

SPEED_UPS: Mapping[str, Mapping[str, float]] = {
    "Fig. 4": {"normalized": 1.5, "sfdi": 2.0},
    "Fig. 9": {"normalized": 1.4, "sfdi": 1.9, "mls-linear": 4.2, "mls-quadratic": 11.6},
    "Fig. 12": {"sfdi": 2.0, "mls-linear": 3.7, "mls-quadratic": 9.6},
}
"""how much faster a step is with improved Shepard than with each method"""
GROWTH: Mapping[str, int] = {"mls-linear": 2, "mls-quadratic": 2, "sfdi": 2, "normalized": 1, "improved-shepard": 1}
"""power of the number of neighbours by which the work grows, Table 1"""
