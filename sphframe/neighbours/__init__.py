"""Neighbours: neighbour search by a cell grid, and Verlet lists that know how long they remain valid."""

from sphframe.neighbours.lists import NeighbourLists
from sphframe.neighbours.motion import LargestMotion
from sphframe.neighbours.sight import Sight, share_points

__all__ = ["LargestMotion", "NeighbourLists", "Sight", "share_points"]
