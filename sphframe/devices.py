"""Devices: what a back end is made of that computes the steps of a run elsewhere than on the processor.

A device is a subclass of :class:`FluidSystem`, declared as entry point of the group ``sphframe.devices`` and chosen by
the argument ``device`` of a run. It compiles the same loop templates in its own way (``specialise``), and holds the
packed rows and the neighbour lists where it computes. Initial state, bodies and output remain on the processor.
"""

from sphframe.boundary.filling import ImageFilling
from sphframe.boundary.ghosts import Scratch
from sphframe.compiled import borrowed, fma, local_array, whole
from sphframe.neighbours import NeighbourLists
from sphframe.neighbours.lists import list_particles, list_points, mark_near, room_for
from sphframe.neighbours.motion import LargestMotion, largest_motion
from sphframe.simulation.row_checks import check_fluid, first_bad_ghost
from sphframe.simulation.system import FluidSystem
from sphframe.simulation.updates import add_columns, advance_state, hold_state

__all__ = [
    "FluidSystem", "ImageFilling", "LargestMotion", "NeighbourLists", "Scratch", "add_columns", "advance_state",
    "borrowed", "check_fluid", "first_bad_ghost", "fma", "hold_state", "largest_motion", "list_particles",
    "list_points", "local_array", "mark_near", "room_for", "whole",
]  # fmt: skip
