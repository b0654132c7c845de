"""Shepard and improved Shepard weights for sphframe."""

from sphframe_shepard.weights import ImprovedShepard, Shepard

__all__ = ["ImprovedShepard", "Shepard"]
