"""Integrators: how the state is advanced in time."""

from sphframe.integrators.rk4 import RungeKutta4
from sphframe.integrators.symplectic import Symplectic

__all__ = ["RungeKutta4", "Symplectic"]
