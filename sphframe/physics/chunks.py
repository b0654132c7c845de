"""Physics: how the loops over particles are cut up."""

__all__ = ["CHUNKS", "LANES"]

CHUNKS = 64
"""parts of a loop that each have scratch memory of their own; threads take several"""

LANES = 8
"""numbers that the widest vector instructions take at once (AVX-512, double precision)"""
