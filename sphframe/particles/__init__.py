"""Particles: the arrays."""

from sphframe.particles.rows import Columns

__all__ = ["Columns"]
