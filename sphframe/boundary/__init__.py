"""Boundary: fixed ghost particles in three steps: mirror, interpolate, assign."""
