"""Compiled: how many particles a loop takes at once."""

__all__ = ["LANES"]

LANES = 8
"""numbers that the widest vector instructions take at once (AVX-512, double precision)"""
