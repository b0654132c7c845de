"""Boundary: the sides of walls that hide what is behind them, carried by rigid bodies."""

from collections.abc import Sequence

import numpy as np

from sphframe.arrays import Array, IntArray
from sphframe.geometry import Sides, to_world
from sphframe.geometry.charts import BEYOND, THICK
from sphframe.interfaces import Motion
from sphframe.neighbours import Sight


class WallSides:
    """The ``sides`` of walls as drawn, carried by the bodies with the indices ``body`` (k,), -1 at rest.

    Attributes
    ----------
    sight: the sides at present, and the charts of the ghosts.
    passable: (g,) whether each ghost lies behind the continuation of a wall beyond its end.
    """

    def __init__(self, sides: Sides, body: IntArray, centres: Array, spacing: float) -> None:
        self._drawn, self._body, self._centres = sides.ends, body, centres
        thin_ghosts = sides.kind != THICK
        smooth: Array = spacing * sides.tips.astype(np.float64)
        self.sight = Sight(sides.ends.copy(), smooth, sides.chart, sides.thin, sides.ghost_chart, thin_ghosts)
        self.passable = sides.kind == BEYOND

    def move(self, motions: Sequence[Motion]) -> None:
        """Carry the sides to where ``motions`` of the bodies have brought them."""
        for k, motion in enumerate(motions):
            own = self._body == k
            if np.any(own):
                points = to_world(self._drawn[own].reshape(-1, 2), motion.position, self._centres[k])
                self.sight.ends[own] = points.reshape(-1, 4)
