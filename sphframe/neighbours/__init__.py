"""Neighbours: neighbour search by a cell grid, and Verlet lists that know how long they remain valid."""

from sphframe.neighbours.cells import put_in_order
from sphframe.neighbours.lists import NeighbourLists
from sphframe.neighbours.motion import LargestMotion

__all__ = ["LargestMotion", "NeighbourLists", "put_in_order"]
