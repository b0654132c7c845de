"""Time series in figures: one style for each variant."""

from typing import Any

from numpy.typing import ArrayLike

from sphframe.studies import colour, thinned
from sphframe_huang2019.variants import Variant

__all__ = ["draw_history"]


def draw_history(
    axes: Any, variant: Variant, t: ArrayLike, values: ArrayLike, *, points: int = 800, **style: Any
) -> None:
    """Draw ``values`` over ``t`` in the colour of the method, with at most about ``points`` points."""
    usual = {"color": colour(variant.method), "linewidth": 0.9, "label": variant.label}
    axes.plot(*thinned(t, values, most=points), **{**usual, **style})
