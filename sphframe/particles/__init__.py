"""Particles: the arrays, and the box that may repeat itself."""

from sphframe.particles.periods import Periods
from sphframe.particles.rows import Columns

__all__ = ["Columns", "Periods"]
