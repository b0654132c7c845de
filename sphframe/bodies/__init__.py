"""Bodies: fixed and prescribed rigid bodies."""

from sphframe.bodies.fixed import Fixed

__all__ = ["Fixed"]
