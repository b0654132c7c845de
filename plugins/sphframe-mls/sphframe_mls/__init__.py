"""Moving least squares weights for sphframe."""

from sphframe_mls.weights import LinearMLS, QuadraticMLS

__all__ = ["LinearMLS", "QuadraticMLS"]
