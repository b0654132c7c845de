"""Simulation: the stage order, the run loop and its stop rules."""

from sphframe.simulation.run import Run, run
from sphframe.simulation.simulation import Simulation

__all__ = ["Run", "Simulation", "run"]
