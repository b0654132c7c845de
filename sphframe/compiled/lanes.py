"""Compiled: the number of particles that a pair loop computes at once."""

LANES = 8
"""numbers of double precision in the widest vector registers (AVX-512)"""
