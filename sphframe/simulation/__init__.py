"""Simulation: the stage order, the run loop, its guards, and what continues a run."""

from sphframe.simulation.run import Run, resume, run
from sphframe.simulation.simulation import Simulation

__all__ = ["Run", "Simulation", "resume", "run"]
